#include "dem/dynamics/sweeps/motion.h"

#include "base/parallel.h"
#include "base/simd.h"

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
/// Moves a body, or the pack of bodies that begins at i. Returns the square of the way of each [m²].
template <typename Real, int dim>
[[gnu::flatten]] Real move_one(Grains<dim>& bodies, const InverseInertia& inverse, const std::size_t i,
                               const MotionStep<dim>& step, const LargeVector<double>& freedom,
                               LargeVector<double>& damping_work)
{
  const double kick = 0.5 * (step.previous_dt + step.dt);
  const Real is_free = simd::load<Real>(&freedom[i]);
  const Real mass = simd::load<Real>(&bodies.mass[i]);
  Real dissipated = simd::load<Real>(&damping_work[i]);
  // One velocity or spin; `one_over_inertia` is that of its kind.
  const auto advance = [&](const Real& force, const Real& one_over_inertia, double* const velocity) {
    const Real before = simd::load<Real>(velocity);
    const Real damping_force = -step.damping * simd::absolute(force) * simd::sign(before);
    const Real change = kick * (force + damping_force) * one_over_inertia;
    const Real work = 0.5 * damping_force * (step.previous_dt * before + step.dt * (before + change));
    const Real after = before + is_free * change;
    simd::store(after, velocity);
    dissipated -= is_free * work;
    return after;
  };

  const Real one_over_mass = simd::load<Real>(&inverse.mass[i]);
  Real squared_way = 0.0;
  for (int c = 0; c < dim; ++c)
    {
      const Real force = simd::load<Real>(&bodies.force[c][i]) + mass * step.gravity[c];
      const Real way = step.dt * advance(force, one_over_mass, &bodies.velocity[c][i]);
      double* const position = &bodies.position[c][i];
      simd::store(simd::load<Real>(position) + way, position);
      squared_way += way * way;
    }
  const Real one_over_moment = simd::load<Real>(&inverse.moment[i]);
  for (int c = 0; c < n_rotations<dim>; ++c)
    advance(simd::load<Real>(&bodies.couple[c][i]), one_over_moment, &bodies.spin[c][i]);
  simd::store(dissipated, &damping_work[i]);
  return squared_way;
}
} // namespace

template <int dim>
double move_bodies(Grains<dim>& bodies, const GrainRange& moved, const InverseInertia& inverse,
                   const MotionStep<dim>& step, const LargeVector<double>& freedom, LargeVector<double>& damping_work)
{
  std::vector<double> squared_ways(n_blocks(moved.size()), 0.0);
  for_each_block(moved.size(), [&](const std::size_t block, const std::size_t begin, const std::size_t behind) {
    std::size_t i = moved.first + begin;
    const std::size_t end = moved.first + behind;
    simd::Pack of_packs = 0.0;
    for (; i + simd::width<simd::Pack> <= end; i += simd::width<simd::Pack>)
      of_packs = simd::larger(of_packs, move_one<simd::Pack>(bodies, inverse, i, step, freedom, damping_work));
    double longest = simd::largest_lane(of_packs);
    for (; i < end; ++i)
      longest = simd::larger(longest, move_one<double>(bodies, inverse, i, step, freedom, damping_work));
    squared_ways[block] = longest;
  });
  return squared_ways.empty() ? 0.0 : std::sqrt(*std::max_element(squared_ways.begin(), squared_ways.end()));
}

template double move_bodies<2>(Grains<2>&, const GrainRange&, const InverseInertia&, const MotionStep<2>&,
                               const LargeVector<double>&, LargeVector<double>&);
template double move_bodies<3>(Grains<3>&, const GrainRange&, const InverseInertia&, const MotionStep<3>&,
                               const LargeVector<double>&, LargeVector<double>&);
} // namespace feldspar
