#pragma once

#include "dem/laws/joint_law.h"
#include "dem/storage/joints.h"

#include <array>
#include <cstddef>

/// The state of one joint between steps, written over the law: segments, energies, and whether it still has a face.
namespace feldspar
{
/// The state of a segment as the tables have it.
template <int dim, JointLaw<dim> Law>
typename Law::template State<double> stored_state(const Joints<dim>& joints, const unsigned int i, const std::size_t j)
{
  const std::size_t segment = joints.segment(i, j);
  typename Law::template State<double> state;
  for (int c = 0; c < dim - 1; ++c)
    state.shear_stress[c] = joints.shear_stress[c][segment];
  state.bonded = joints.bonded[segment] > 0.5;
  if constexpr (Law::n_more > 0)
    for (std::size_t k = 0; k < Law::n_more; ++k)
      state.more[k] = *joints.more_state.at(i * Law::n_more + k, j);
  return state;
}

/// Returns whether a face responds as one: all its bonds hold, and none has stored more than the motion of the face
/// tells.
template <int dim, JointLaw<dim> Law>
bool is_whole(const Law&, const Joints<dim>& joints, const std::size_t j)
{
  if (!joints.holds_wholly(j))
    return false;
  if constexpr (RespondsAsOne<Law, dim, double>)
    for (unsigned int i = 0; i < joints.n_segments; ++i)
      if (Law::remembers(stored_state<dim, Law>(joints, i, j)))
        return false;
  return true;
}

/// Returns whether a face carries nothing, and will carry nothing as long as it is open.
template <int dim, JointLaw<dim> Law>
bool stands_open_without_bonds(const Law&, const Joints<dim>& joints, const std::size_t j)
{
  if constexpr (RespondsAsOne<Law, dim, double>)
    {
      std::array<double, n_rotations<dim>> rotation;
      for (int c = 0; c < n_rotations<dim>; ++c)
        rotation[c] = joints.rotation[c][j];
      if (joints.holds(j) || !Law::surely_open(joints.face(j), joints.whole, joints.opening[j], rotation))
        return false;
      for (unsigned int i = 0; i < joints.n_segments; ++i)
        for (int c = 0; c < dim - 1; ++c)
          if (joints.shear_stress[c][joints.segment(i, j)] != 0.0)
            return false;
      return true;
    }
  return false;
}

/// The state of a segment, known from the motion of its face, which responds as one.
template <int dim, typename Law>
typename Law::template State<double> whole_state(const Joints<dim>& joints, const unsigned int i, const std::size_t j)
{
  std::array<double, n_rotations<dim>> rotation;
  for (int c = 0; c < n_rotations<dim>; ++c)
    rotation[c] = joints.rotation[c][j];
  std::array<double, dim - 1> slip;
  for (int c = 0; c < dim - 1; ++c)
    slip[c] = joints.slip[c][j];
  return Law::whole_state(joints.face(j), joints.elements[i], rotation, slip);
}

/// The state of a segment, stored or known from the motion of its face.
template <int dim, typename Law>
typename Law::template State<double> segment_state(const Law& law, const Joints<dim>& joints, const unsigned int i,
                                                   const std::size_t j)
{
  if constexpr (RespondsAsOne<Law, dim, double>)
    if (is_whole(law, joints, j))
      return whole_state<dim, Law>(joints, i, j);
  return stored_state<dim, Law>(joints, i, j);
}

/// joint_energy() with the law known. A face that responds as one, linearly, stores half of what its response over the whole way
/// would take.
template <int dim, JointLaw<dim> Law>
double joint_energy(const Law& law, const Joints<dim>& joints, const std::size_t j)
{
  const double opening = joints.opening[j];
  std::array<double, n_rotations<dim>> rotation;
  for (int c = 0; c < n_rotations<dim>; ++c)
    rotation[c] = joints.rotation[c][j];
  if constexpr (RespondsAsOne<Law, dim, double>)
    if (is_whole(law, joints, j))
      {
        std::array<double, dim - 1> slip;
        for (int c = 0; c < dim - 1; ++c)
          slip[c] = joints.slip[c][j];
        const auto against = Law::whole_response(joints.face(j), joints.whole, opening, rotation, slip);
        double work = -against.normal_force * opening;
        for (int c = 0; c < dim - 1; ++c)
          work -= against.shear_force[c] * slip[c];
        for (int c = 0; c < n_rotations<dim>; ++c)
          work -= against.moment[c] * rotation[c];
        return 0.5 * work;
      }
  return law.stored_energy(joints.face(j), joints.elements, opening, rotation,
                           [&](const unsigned int i) { return stored_state<dim, Law>(joints, i, j); });
}

/// dissipated_by_bonds() with the law known.
template <int dim, JointLaw<dim> Law>
double dissipated_by_bonds(const Law& law, const Joints<dim>& joints, const std::size_t j)
{
  double sum = 0.0;
  if constexpr (DissipatesBeforeBreaks<Law, dim>)
    for (unsigned int i = 0; i < joints.n_segments; ++i)
      sum += Law::dissipated_so_far(segment_state<dim>(law, joints, i, j));
  return sum;
}

/// has_face() with the law known.
template <int dim, JointLaw<dim> Law>
bool has_face(const Law&, const Joints<dim>& joints, const std::size_t j)
{
  if (joints.holds(j))
    return true;
  if constexpr (!Law::face_outlives_bonds)
    return false;
  const double reach = 2.0 * joints.half_length[j];
  if constexpr (!Law::face_can_slide_off)
    return joints.opening[j] <= reach;
  std::array<double, dim - 1> slip;
  for (int c = 0; c < dim - 1; ++c)
    slip[c] = joints.slip[c][j];
  return simd::magnitude(slip) <= reach && joints.opening[j] <= reach;
}
} // namespace feldspar
