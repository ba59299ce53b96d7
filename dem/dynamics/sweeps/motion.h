#pragma once

#include "base/page_allocator.h"
#include "base/vector.h"
#include "dem/storage/grains.h"

#include <cstddef>
#include <vector>

namespace feldspar
{
/// Data common to all bodies in a step of their motion.
template <int dim>
struct MotionStep
{
  double previous_dt;  ///< [s]
  double dt;           ///< [s]
  double damping;      ///< α of local damping
  Vector<dim> gravity; ///< [m/s²]
};

/// 1/m [1/kg] and 1/I [1/(kg m²)] of each body. They do not change while bodies move.
struct InverseInertia
{
  LargeVector<double> mass, moment;

  InverseInertia() = default;
  template <int dim>
  explicit InverseInertia(const Grains<dim>& bodies)
  {
    for (const double m : bodies.mass)
      mass.push_back(1.0 / m);
    for (const double i : bodies.moment_of_inertia)
      moment.push_back(1.0 / i);
  }
};

/// Moves these grains or groups over a step by their forces and couples: kicks their velocities and spins
/// over half of the step before and half of this one, and carries their centres; docs/theory.md §2.1. `freedom`: 0 for a
/// body that a grip holds, 1 for a free one; `damping_work`: grows by what damping dissipates at each [J]. Returns the
/// longest way that one has gone [m].
template <int dim>
double move_bodies(Grains<dim>& bodies, const GrainRange& moved, const InverseInertia& inverse,
                   const MotionStep<dim>& step, const LargeVector<double>& freedom, LargeVector<double>& damping_work);
} // namespace feldspar
