// The measures of a body in motion: energies, unbalanced forces, contacts (stresses: contact_stress.cc). Nothing here
// changes it.

#include "base/parallel.h"
#include "base/simd.h"
#include "dem/dynamics/dynamics.h"
#include "dem/dynamics/sweeps/smooth_sweep.h"

#include <oneapi/tbb/combinable.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace feldspar
{
/// Kinetic energy of a free body at the last half step [J].
template <int dim>
double Dynamics<dim>::kinetic_energy(const std::uint32_t i) const
{
  const auto& grains = bodies();
  return grips.holds(i) ? 0.0
                        : 0.5 * grains.mass[i] * squared_norm<dim>(grains.velocity, i) +
                            0.5 * grains.moment_of_inertia[i] * squared_norm<n_rotations<dim>>(grains.spin, i);
}

template <int dim>
Energies Dynamics<dim>::energies() const
{
  const auto& grains = bodies();
  const auto& joints = body.joints;
  const GrainRange own_grains = moved();
  EnergySums sums;
  Energies sum;
  if (steps == 0 && !started)
    {
      for (std::uint32_t i = own_grains.first; i < own_grains.end; ++i)
        sums.kinetic.add(kinetic_energy(i));
      sum.kinetic = sum.kinetic_at_start = part.totals({sums.kinetic})[0];
      return sum;
    }
  sum.boundary_work = ledger.boundary_work;
  sum.kinetic_at_start = ledger.kinetic_at_start;
  if (part.is_first())
    {
      sums.released.add(ledger.released);
      sums.strain.add(-ledger.strain_at_start);
    }
  sums.slip.add(ledger.slip_of_lost_contacts);

  oneapi::tbb::combinable<EnergySums> of_threads; // exact sums have no order
  for_each_block(joints.size(), [&](std::size_t, const std::size_t from, const std::size_t to) {
    EnergySums& own = of_threads.local();
    for (std::size_t j = from; j < to; ++j)
      if (part.counts(joints.grain_1[j]))
        {
          own.slip.add(joints.slip_energy[j]);
          own.strain.add(joint_energy(joints, j));
          own.released.add(dissipated_by_bonds(joints, j));
        }
  });
  touches.add_energies(sums, part);
  wall_set.add_energies(sums, body);
  add_smooth_energies(body, part.grains(), sums.strain, sums.slip);

  // ½ m v(n-½)·v(n+½), and half of the coming step's damping: the values at the current time.
  const double kick = 0.5 * (previous_dt + dt);
  for_each_block(own_grains.size(), [&](std::size_t, const std::size_t from, const std::size_t to) {
    EnergySums& own = of_threads.local();
    for (std::size_t i = own_grains.first + from; i < own_grains.first + to; ++i)
      {
        double kinetic = 0.0, damping = ledger.damping_work[i];
        const auto centre = [&](const double force, const double inertia, const double velocity) {
          const double damping_force = -parameters.damping * std::abs(force) * simd::sign(velocity);
          kinetic += 0.5 * inertia * velocity * (velocity + kick * (force + damping_force) / inertia);
          damping -= 0.5 * damping_force * previous_dt * velocity;
        };
        for (int c = 0; c < dim && !grips.holds(i); ++c)
          centre(grains.force[c][i] + grains.mass[i] * gravity[c], grains.mass[i], grains.velocity[c][i]);
        for (int c = 0; c < n_rotations<dim> && !grips.holds(i); ++c)
          centre(grains.couple[c][i], grains.moment_of_inertia[i], grains.spin[c][i]);
        own.kinetic.add(kinetic);
        own.damping.add(damping);
      }
  });
  of_threads.combine_each([&](const EnergySums& own) { sums.add(own); });
  const std::vector<double> totals = part.totals({sums.kinetic, sums.strain, sums.slip, sums.released, sums.damping});
  sum.kinetic = totals[0];
  sum.strain = totals[1];
  sum.slip = totals[2];
  sum.released = totals[3];
  sum.damping = totals[4];
  return sum;
}

/// Square of the force of contacts, walls and gravity on a body [N²].
template <int dim>
double Dynamics<dim>::squared_unbalanced_force(const std::size_t i) const
{
  double sum = 0.0;
  for (int c = 0; c < dim; ++c)
    {
      const double force = bodies().force[c][i] + bodies().mass[i] * gravity[c];
      sum += force * force;
    }
  return sum;
}

template <int dim>
double Dynamics<dim>::unbalanced_force_ratio() const
{
  ExactSum unbalanced, n_free;
  for (std::size_t i = moved().first; i < moved().end; ++i)
    if (!grips.holds(i))
      {
        unbalanced.add(std::sqrt(squared_unbalanced_force(i)));
        n_free.add(1.0);
      }
  const std::vector<double> totals = part.totals({unbalanced, n_free});
  const double carried = mean_contact_force();
  return carried > 0.0 && totals[1] > 0.0 ? totals[0] / totals[1] / carried : 0.0;
}

template <int dim>
double Dynamics<dim>::largest_unbalanced_force_ratio() const
{
  double largest = 0.0;
  for (std::size_t i = moved().first; i < moved().end; ++i)
    largest = std::max(largest, squared_unbalanced_force(i));
  const double carried = mean_contact_force();
  return carried > 0.0 ? std::sqrt(part.largest({largest})[0]) / carried : 0.0;
}

template <int dim>
double Dynamics<dim>::sum_of_forces(const int axis) const
{
  const auto& forces = body.grains.force[axis];
  const auto [first, end] = part.grains();
  const std::vector<double> all = part.gathered(std::vector<double>(forces.begin() + first, forces.begin() + end));
  return std::accumulate(all.begin(), all.end(), 0.0);
}

template <int dim>
double Dynamics<dim>::faceless_coordination_number() const
{
  std::size_t n = 0;
  touches.for_each_touch([&](const Touch<dim>& touch) { n += touch.touching ? 1 : 0; });
  return 2.0 * double(n) / double(images.n_own());
}

template double Dynamics<2>::kinetic_energy(std::uint32_t) const;
template Energies Dynamics<2>::energies() const;
template double Dynamics<2>::unbalanced_force_ratio() const;
template double Dynamics<2>::largest_unbalanced_force_ratio() const;
template double Dynamics<2>::sum_of_forces(int) const;
template double Dynamics<2>::faceless_coordination_number() const;
template double Dynamics<3>::kinetic_energy(std::uint32_t) const;
template Energies Dynamics<3>::energies() const;
template double Dynamics<3>::unbalanced_force_ratio() const;
template double Dynamics<3>::largest_unbalanced_force_ratio() const;
template double Dynamics<3>::sum_of_forces(int) const;
template double Dynamics<3>::faceless_coordination_number() const;
} // namespace feldspar
