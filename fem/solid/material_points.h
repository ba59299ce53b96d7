#pragma once

#include "base/mapped.h"
#include "base/parallel.h"
#include "fem/materials/material.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

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
    return oneapi::tbb::parallel_reduce(
      range(), std::size_t(0),
      [&](const Range& part, std::size_t n_events) {
        for (std::size_t i = part.begin(); i != part.end(); ++i)
          {
            leave_if(gives_up);
            timed(i, [&] { n_events += points[i]->relax(strains[i]); });
          }
        return n_events;
      },
      std::plus<>());
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
  using Range = oneapi::tbb::blocked_range<std::size_t>;

  /// Points differ in cost by orders of magnitude: ranges are split down to one point where threads are idle.
  Range range() const { return {0, points.size()}; }

  template <typename Work>
  void for_each(const Work& work) const
  {
    oneapi::tbb::parallel_for(range(), [&](const Range& part) {
      for (std::size_t i = part.begin(); i != part.end(); ++i)
        timed(i, [&] { work(i); });
    });
  }

  template <typename Work>
  void timed(const std::size_t i, const Work& work) const
  {
    const double begin = processor_time();
    work();
    times[i] += processor_time() - begin;
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
