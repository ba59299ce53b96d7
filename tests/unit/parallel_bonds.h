#pragma once

#include "dem/laws/parallel_bond.h"
#include "tests/unit/small_specimen.h"

#include <numbers>

/// Parallel bonds for tests.
namespace feldspar
{
/// All alike: 50 MPa in tension, 60 MPa and 30° in shear; the bond narrower than the grains and softer than their contact.
inline ParallelBondParameters test_bonds()
{
  ParallelBondParameters wanted;
  wanted.modulus = 40e9;
  wanted.stiffness_ratio = 2.0;
  wanted.radius_multiplier = 0.8;
  wanted.moment_contribution = 0.7;
  wanted.bond_tensile_strength = 50e6;
  wanted.bond_cohesion = 60e6;
  wanted.bond_tensile_strength_deviation = wanted.bond_cohesion_deviation = 0.0;
  wanted.bond_friction_angle = std::numbers::pi / 6.0;
  wanted.installation_gap_ratio = 1e-6;
  return wanted;
}

/// The elements of one face, for the law alone.
template <int dim>
struct OneFace
{
  Bond<double> strength;
  typename ParallelBond<dim>::template Update<double> update{};

  Bond<double> bond(unsigned int) const { return strength; }
  const auto& state(unsigned int) const { return update.state; }
  void set(unsigned int, const typename ParallelBond<dim>::template Update<double>& now) { update = now; }
};

/// One step from rest to a motion of a link, and the forces in the same order.
template <int dim>
FaceMotion<dim, double> step_to(const Motion<dim>& motion)
{
  FaceMotion<dim, double> step{};
  step.opening = motion[0];
  for (int c = 0; c < dim - 1; ++c)
    step.slip_increment[c] = motion[1 + c];
  for (int c = 0; c < n_rotations<dim>; ++c)
    step.rotation[c] = motion[dim + c];
  return step;
}

template <int dim>
Motion<dim> forces_of(const FaceResultants<dim, double>& sum)
{
  Motion<dim> forces;
  forces[0] = -sum.normal_force;
  for (int c = 0; c < dim - 1; ++c)
    forces[1 + c] = -sum.shear_force[c];
  for (int c = 0; c < n_rotations<dim>; ++c)
    forces[dim + c] = -sum.moment[c];
  return forces;
}
} // namespace feldspar
