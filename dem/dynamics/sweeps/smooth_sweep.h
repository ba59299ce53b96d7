#pragma once

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/specimen/specimen.h"
#include "dem/storage/exact_sum.h"

#include <vector>

/// The sweep over the smooth joints of a specimen; docs/theory.md §1.9.
namespace feldspar
{
/// Carries every smooth joint over one step of dt [s], as sweep_joints() does the others: reads the grains' positions (at
/// its end) and spins (at its middle), leaves forces and couples in the joints. Breaks count their joints from the number
/// of the other joints on.
template <int dim>
std::vector<Break> sweep_smooth_joints(Specimen<dim>& body, double dt);

/// Adds their forces and couples to those of the grains.
template <int dim>
void add_smooth_forces(Specimen<dim>& body);

/// Adds what those store and have dissipated whose first grain is one of these.
template <int dim>
void add_smooth_energies(const Specimen<dim>& body, const GrainRange& these, ExactSum& strain, ExactSum& slip);

/// A smooth joint that has come to its end.
struct EndedSmoothJoint
{
  GrainPair ends;
  double energy = 0.0; ///< that it dissipated and stored [J]
};

/// Drops those without a bond, pressed by nothing, whose sides are farther apart than the grains are wide, or whose grains
/// have lost each other: they are in contact as any grains again.
template <int dim>
std::vector<EndedSmoothJoint> remove_ended_smooth_joints(Specimen<dim>& body);
} // namespace feldspar
