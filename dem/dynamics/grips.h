#pragma once

#include "base/vector.h"
#include "dem/storage/grains.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace feldspar
{
/// Sets of grains that move as one, without turning.
template <int dim>
class Grips
{
public:
  explicit Grips(const std::size_t n_grains)
    : free(n_grains, 1.0)
  {
  }

  /// Sets its grains off; the number identifies the grip.
  std::size_t add(std::vector<std::uint32_t> members, const Vector<dim>& velocity, Grains<dim>& grains)
  {
    for (const auto i : members)
      {
        free[i] = 0.0;
        set<dim>(grains.velocity, i, velocity);
      }
    grips.push_back({std::move(members), velocity});
    return grips.size() - 1;
  }

  std::size_t size() const { return grips.size(); }
  bool holds(const std::size_t grain) const { return free[grain] == 0.0; }
  /// 0 for a grain that belongs to a grip, 1 for a free one: a factor for what moves it; [n_grains].
  const LargeVector<double>& freedom() const { return free; }
  const Vector<dim>& velocity(const std::size_t grip) const { return grips[grip].velocity; }

  const std::vector<std::uint32_t>& members(const std::size_t grip) const { return grips[grip].members; }
  /// Sum of the forces on a grip's grains [N].
  Vector<dim> force(const std::size_t grip, const Grains<dim>& grains) const
  {
    Vector<dim> sum = Vector<dim>::Zero();
    for (const auto i : grips[grip].members)
      sum += at<dim>(grains.force, i);
    return sum;
  }

private:
  struct Grip
  {
    std::vector<std::uint32_t> members;
    Vector<dim> velocity;
  };

  std::vector<Grip> grips;
  LargeVector<double> free;
};
} // namespace feldspar
