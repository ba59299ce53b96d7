#pragma once

#include "base/mapped.h"
#include "base/parallel.h"
#include "fem/materials/material.h"

#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace feldspar::fem
{
/// The material points of one rank, worked on by all its cores. Vectors run over the points in the order of add().
template <int dim>
class MaterialPoints
{
public:
  using Strains = std::vector<StrainVector<dim>>;
  using Responses = std::vector<MaterialResponse<dim>>;

  void add(std::unique_ptr<MaterialPoint<dim>> point)
  {
    points.push_back(std::move(point));
    times.push_back(0.0);
  }

  std::size_t size() const { return points.size(); }
  const MaterialPoint<dim>& operator[](const std::size_t i) const { return *points[i]; }
  /// The processor time of each point since it was added, whatever else runs there [s].
  const std::vector<double>& seconds() const { return times; }

  /// gives_up: asked before each point, by any thread; where it says so, GivenUp is thrown.
  Responses trial(const Strains& strains, const std::function<bool()>& gives_up = {}) const
  {
    Responses responses(points.size());
    for_each([&](const std::size_t i) {
      leave_if(gives_up);
      responses[i] = points[i]->trial(strains[i]);
    });
    return responses;
  }

  /// Returns the number of events of all points. gives_up: as of trial().
  std::size_t relax(const Strains& strains, const std::function<bool()>& gives_up = {})
  {
    std::atomic<std::size_t> n_events = 0;
    for_each([&](const std::size_t i) {
      leave_if(gives_up);
      n_events += points[i]->relax(strains[i]);
    });
    return n_events;
  }

  void accept(const Strains& strains)
  {
    for_each([&](const std::size_t i) { points[i]->accept(strains[i]); });
  }

  void reject()
  {
    for_each([&](const std::size_t i) { points[i]->reject(); });
  }

  /// The state of each point, as it gave it.
  std::vector<std::string> stored() const
  {
    return mapped<std::string>(points, [&](const auto& point) { return point->stored(); });
  }

  void restore(const std::vector<std::string>& stored)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i]->restore(stored.at(i));
  }

private:
  /// Points differ in cost by orders of magnitude: ranges are split down to one point where threads are idle.
  template <typename Work>
  void for_each(const Work& work) const
  {
    oneapi::tbb::parallel_for(std::size_t(0), points.size(), [&](const std::size_t i) {
      const double begin = processor_time();
      work(i);
      times[i] += processor_time() - begin;
    });
  }

  /// The processor time of this thread [s].
  static double processor_time()
  {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
  }

  std::vector<std::unique_ptr<MaterialPoint<dim>>> points;
  mutable std::vector<double> times; ///< each written by the thread that works on the point
};
} // namespace feldspar::fem
