#pragma once

#include "base/parallel.h"
#include "dem/dynamics/joint_sweep.h"
#include "dem/laws/joint_law.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

/// The sweep over all joints, written over the law: made for each law of the list in joint_sweep.cc.
namespace feldspar
{
namespace joint_sweep
{
inline constexpr std::size_t packs_ahead = 2;

/// Asks for the same row of a pack some way on. One row at a time, so that asking runs beside computing: a processor that
/// is asked for a whole pack at once computes nothing until it has come.
template <typename Real>
void ask_ahead(const PackedRow& row, const double* const here)
{
  if constexpr (simd::width < Real >> 1)
    __builtin_prefetch(here + packs_ahead * row.pack_size());
}

/// Where: a joint, or a segment and a joint.
template <typename Real, typename... Where>
Real take(const PackedRow& row, const Where... where)
{
  const double* const from = row.pack(where...);
  ask_ahead<Real>(row, from);
  return simd::load<Real>(from);
}

/// The segments of one joint, or of a pack of neighbouring ones, in the tables of all joints.
template <typename Law, int dim, typename Real>
struct StoredSegments
{
  using State = typename Law::template State<Real>;

  Joints<dim>& joints;
  const std::size_t first;
  std::vector<Break>& breaks;

  Bond<Real> bond(const unsigned int i) const
  {
    return {take<Real>(joints.tensile_strength, i, first), take<Real>(joints.cohesion, i, first),
            joints.friction_slope};
  }

  State state(const unsigned int i) const
  {
    State state;
    for (int c = 0; c < dim - 1; ++c)
      state.shear_stress[c] = take<Real>(joints.shear_stress[c], i, first);
    state.bonded = take<Real>(joints.bonded, i, first) > 0.5;
    if constexpr (Law::n_more > 0)
      for (std::size_t k = 0; k < Law::n_more; ++k)
        state.more[k] = take<Real>(joints.more(k), i, first);
    return state;
  }

  template <typename Update>
  void set(const unsigned int i, const Update& update)
  {
    for (int c = 0; c < dim - 1; ++c)
      simd::store(update.state.shear_stress[c], joints.shear_stress[c].pack(i, first));
    if constexpr (Law::n_more > 0)
      for (std::size_t k = 0; k < Law::n_more; ++k)
        simd::store(update.state.more[k], joints.more(k).pack(i, first));
    if (simd::any(update.tension_break || update.shear_break))
      for (std::size_t j = 0; j < simd::width<Real>; ++j)
        if (const bool in_tension = simd::lane(update.tension_break, j);
            in_tension || simd::lane(update.shear_break, j))
          {
            joints.bonded.pack(i, first)[j] = 0.0;
            breaks.push_back({std::uint32_t(first + j), i, in_tension, simd::lane(update.released_energy, j)});
          }
  }
};

template <typename Real, std::size_t n>
std::array<Real, n> gather(const Components<n>& from, const std::uint32_t* index)
{
  std::array<Real, n> value;
  for (std::size_t c = 0; c < n; ++c)
    value[c] = simd::gather<Real>(from[c].data(), index);
  return value;
}

template <typename Real, std::size_t n>
std::array<Real, n> load(const PackedComponents<n>& from, const std::size_t i)
{
  std::array<Real, n> value;
  for (std::size_t c = 0; c < n; ++c)
    value[c] = take<Real>(from[c], i);
  return value;
}

template <typename Real, std::size_t n>
void store(const std::array<Real, n>& value, PackedComponents<n>& to, const std::size_t i)
{
  for (std::size_t c = 0; c < n; ++c)
    simd::store(value[c], to[c].pack(i));
}

/// Joint by joint, as Joints<dim>::answer has them.
template <typename Real, int dim>
void store_answer(const ContactForce<dim, Real>& answer, double* const to)
{
  constexpr std::size_t n_joints = simd::width<Real>, n = JointTables<dim>::n_answer_rows;
  std::array<std::array<double, n_joints>, n> rows;
  for (std::size_t c = 0; c < n_rotations<dim>; ++c)
    {
      simd::store(answer.couple_1[c], rows[c].data());
      simd::store(answer.couple_2[c], rows[JointTables<dim>::first_couple_2 + c].data());
    }
  for (std::size_t c = 0; c < dim; ++c)
    simd::store(answer.force[c], rows[JointTables<dim>::first_force + c].data());
  for (std::size_t j = 0; j < n_joints; ++j)
    for (std::size_t c = 0; c < n; ++c)
      to[j * n + c] = rows[c][j];
  if constexpr (n_joints > 1)
    for (std::size_t c = 0; c < n; ++c)
      __builtin_prefetch(to + (packs_ahead * n + c) * n_joints, 1);
}

/// Joint j, or the pack of joints that begins at j. Flattened: packs handed to functions go by way of memory, which
/// takes half as long again as the work.
template <typename Real, typename Law, int dim>
[[gnu::flatten]] void update_joint(const Law& law, Joints<dim>& joints, const Grains<dim>& grains, const double dt,
                                   const std::size_t j, std::vector<Break>& breaks)
{
  constexpr std::size_t n_turns = n_rotations<dim>;
  const std::uint32_t* const grain_1 = &joints.grain_1[j];
  const std::uint32_t* const grain_2 = &joints.grain_2[j];
  const Real rest_distance = take<Real>(joints.rest_distance, j);
  const Real half_radius_difference = take<Real>(joints.half_radius_difference, j);
  const Real opening_before = take<Real>(joints.opening, j);

  auto turn_1 = gather<Real, n_turns>(grains.spin, grain_1);
  auto turn_2 = gather<Real, n_turns>(grains.spin, grain_2);
  for (std::size_t c = 0; c < n_turns; ++c)
    {
      turn_1[c] *= dt;
      turn_2[c] *= dt;
    }
  ContactFrame<dim, Real> before;
  before.normal = load<Real, dim>(joints.normal, j);
  before.distance = rest_distance + opening_before;
  if constexpr (dim == 3)
    before.tangent = load<Real, 3>(joints.tangent, j);
  const auto contact = Law::motion(before, gather<Real, dim>(grains.position, grain_1),
                                   gather<Real, dim>(grains.position, grain_2), half_radius_difference, turn_1, turn_2);
  FaceMotion<dim, Real> motion;
  motion.opening_before = opening_before;
  motion.opening = contact.frame.distance - rest_distance;
  motion.rotation_before = load<Real, n_turns>(joints.rotation, j);
  for (std::size_t c = 0; c < n_turns; ++c)
    motion.rotation[c] = motion.rotation_before[c] + contact.rotation[c];
  motion.slip_increment = contact.slip;

  const Face<Real> face{take<Real>(joints.normal_stiffness, j), take<Real>(joints.shear_stiffness, j),
                        take<Real>(joints.half_length, j), joints.thickness, joints.friction};
  const auto resultants = law.update(face, joints.elements, motion, StoredSegments<Law, dim, Real>{joints, j, breaks});
  const auto answer = Law::force(contact.frame, half_radius_difference, resultants.normal_force, resultants.shear_force,
                                 resultants.moment);

  store<Real, dim>(contact.frame.normal, joints.normal, j);
  if constexpr (dim == 3)
    store<Real, 3>(contact.frame.tangent, joints.tangent, j);
  simd::store(motion.opening, joints.opening.pack(j));
  store<Real, n_turns>(motion.rotation, joints.rotation, j);
  for (int c = 0; c < dim - 1; ++c)
    simd::store(take<Real>(joints.slip[c], j) + contact.slip[c], joints.slip[c].pack(j));
  simd::store(take<Real>(joints.slip_energy, j) + resultants.slip_energy, joints.slip_energy.pack(j));
  store_answer<Real, dim>(answer, joints.answer.at(0, j));
}
} // namespace joint_sweep

/// sweep_joints() with the law known.
template <int dim, JointLaw<dim> Law>
std::vector<Break> sweep_joints(const Law& law, Joints<dim>& joints, const Grains<dim>& grains, const double dt)
{
  std::vector<std::vector<Break>> breaks(n_blocks(joints.size()));
  for_each_block(joints.size(), [&](const std::size_t block, const std::size_t begin, const std::size_t end) {
    std::size_t j = begin;
    for (; j + simd::width<simd::Pack> <= end; j += simd::width<simd::Pack>)
      joint_sweep::update_joint<simd::Pack>(law, joints, grains, dt, j, breaks[block]);
    for (; j < end; ++j)
      joint_sweep::update_joint<double>(law, joints, grains, dt, j, breaks[block]);
  });

  std::vector<Break> all;
  for (const auto& of_block : breaks)
    all.insert(all.end(), of_block.begin(), of_block.end());
  std::sort(all.begin(), all.end(), [](const Break& a, const Break& b) {
    return a.joint != b.joint ? a.joint < b.joint : a.segment < b.segment;
  });
  return all;
}

/// joint_energy() with the law known.
template <int dim, JointLaw<dim> Law>
double joint_energy(const Law& law, const Joints<dim>& joints, const std::size_t j)
{
  std::array<double, n_rotations<dim>> rotation;
  for (int c = 0; c < n_rotations<dim>; ++c)
    rotation[c] = joints.rotation[c][j];
  const auto state_of = [&](const unsigned int i) {
    const std::size_t segment = joints.segment(i, j);
    typename Law::template State<double> state;
    for (int c = 0; c < dim - 1; ++c)
      state.shear_stress[c] = joints.shear_stress[c][segment];
    state.bonded = joints.bonded[segment] > 0.5;
    if constexpr (Law::n_more > 0)
      for (std::size_t k = 0; k < Law::n_more; ++k)
        state.more[k] = *joints.more_state.at(i * Law::n_more + k, j);
    return state;
  };
  return law.stored_energy(joints.face(j), joints.elements, joints.opening[j], rotation, state_of);
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
  std::array<double, dim - 1> slip;
  for (int c = 0; c < dim - 1; ++c)
    slip[c] = joints.slip[c][j];
  return flat_joint::magnitude(slip) <= reach && joints.opening[j] <= reach;
}
} // namespace feldspar
