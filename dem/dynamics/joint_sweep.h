#pragma once

#include "dem/storage/joints.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// A segment that broke in a sweep.
struct Break
{
  std::uint32_t joint;
  std::uint32_t segment;
  bool in_tension;        ///< else in shear
  double released_energy; ///< [J]
};

/// Carries every joint over one step of dt [s]: reads the grains' positions (at its end) and spins (at its middle),
/// updates the segments and leaves forces and couples in the joints. Breaks come in the order of joint and segment,
/// whatever the number of threads.
template <int dim>
std::vector<Break> sweep_joints(Joints<dim>& joints, const Grains<dim>& grains, double dt);

/// Whether a joint has a face still. It loses it when nothing holds and both sides have slid or opened past each other, or
/// at once by a law whose faces go with their bonds.
template <int dim>
bool has_face(const Joints<dim>& joints, std::size_t joint);

/// Stored in the segments of a joint [J].
template <int dim>
double joint_energy(const Joints<dim>& joints, std::size_t joint);
} // namespace feldspar
