#pragma once

#include "base/parallel.h"
#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/laws/joint_law.h"
#include "dem/storage/simd_transpose.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

// Packs handed to functions go by way of memory, which takes half as long again as the work: the sweep is made of one piece.
// Under the address sanitizer, which checks every access, that piece takes minutes to compile.
#ifdef __SANITIZE_ADDRESS__
#define FELDSPAR_OF_ONE_PIECE
#else
#define FELDSPAR_OF_ONE_PIECE gnu::flatten
#endif

/// The sweep over all joints, written over the law: made for each law of the list in joint_sweep.cc.
namespace feldspar
{
namespace joint_sweep
{
inline constexpr std::size_t packs_ahead = 2;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// The rows of a joint, or of a pack of neighbouring ones, in a table; distances between them are known at compile time.
/// One row at a time is asked for some packs ahead, so that asking runs beside computing: a processor that is asked for a
/// whole pack at once computes nothing until it has come.
template <typename Real, std::size_t n_rows>
struct RowsOfPack
{
  double* first;

  double* row(const std::size_t r) const { return first + r * pack_width; }
  Real take(const std::size_t r) const
  {
    if constexpr (simd::width < Real >> 1)
      __builtin_prefetch(row(r) + packs_ahead * n_rows * pack_width);
    return simd::load<Real>(row(r));
  }
  void put(const std::size_t r, const Real& value) const { simd::store(value, row(r)); }

  template <std::size_t n>
  std::array<Real, n> take_all(const std::size_t r) const
  {
    std::array<Real, n> values;
    for (std::size_t c = 0; c < n; ++c)
      values[c] = take(r + c);
    return values;
  }
  template <std::size_t n>
  void put_all(const std::size_t r, const std::array<Real, n>& values) const
  {
    for (std::size_t c = 0; c < n; ++c)
      put(r + c, values[c]);
  }
};

/// State of a face at the beginning of a step.
template <int dim, typename Real>
struct FaceBefore
{
  std::array<Real, n_rotations<dim>> rotation;
  std::array<Real, dim - 1> slip;
  decltype(Real() < Real()) is_whole; ///< all its bonds hold, and its law responds for it as for one
};

/// The segments of one joint, or of a pack of neighbouring ones, in the tables of all joints.
template <typename Law, int dim, typename Real>
struct StoredSegments
{
  using State = typename Law::template State<Real>;
  using Mask = decltype(Real() < Real());

  Joints<dim>& joints;
  const std::size_t first;
  const Face<Real>& face;
  const FaceBefore<dim, Real>& before;
  std::vector<Break>& breaks;
  Mask some_changed{false}; ///< broke, or has stored now what the motion of its face does not tell
  Mask some_bear{false};    ///< are bonded, or have a shear stress

  static constexpr std::size_t n_rows = JointTables<dim>::n_segment_rows;

  double* state_row(const unsigned int i, const std::size_t row) const
  {
    return joints.segment_state.at(0, first) + (i * n_rows + row) * pack_width;
  }

  /// Strengths of nothing where all segments are broken: laws use them only where bonded, and reading them costs memory.
  Bond<Real> bond(const unsigned int i) const
  {
    if (!simd::any(simd::load<Real>(state_row(i, dim - 1)) > 0.5))
      return {Real(0.0), Real(0.0), joints.friction_slope};
    const double* const strength = joints.tensile_strength.pack(i, first);
    return {simd::load<Real>(strength), simd::load<Real>(strength + pack_width), joints.friction_slope};
  }

  State state(const unsigned int i) const
  {
    State state;
    for (int c = 0; c < dim - 1; ++c)
      state.shear_stress[c] = simd::load<Real>(state_row(i, c));
    state.bonded = simd::load<Real>(state_row(i, dim - 1)) > 0.5;
    if constexpr (Law::n_more > 0)
      for (std::size_t k = 0; k < Law::n_more; ++k)
        state.more[k] = simd::load<Real>(joints.more(k).pack(i, first));
    if constexpr (RespondsAsOne<Law, dim, Real>)
      {
        const State whole = Law::whole_state(face, joints.elements[i], before.rotation, before.slip);
        for (int c = 0; c < dim - 1; ++c)
          state.shear_stress[c] = simd::select(before.is_whole, whole.shear_stress[c], state.shear_stress[c]);
      }
    return state;
  }

  template <typename Update>
  void set(const unsigned int i, const Update& update)
  {
    for (int c = 0; c < dim - 1; ++c)
      simd::store(update.state.shear_stress[c], state_row(i, c));
    if constexpr (Law::n_more > 0)
      for (std::size_t k = 0; k < Law::n_more; ++k)
        simd::store(update.state.more[k], joints.more(k).pack(i, first));
    const Mask broke = update.tension_break || update.shear_break;
    if constexpr (RespondsAsOne<Law, dim, Real>)
      {
        some_changed = some_changed || broke || Law::remembers(update.state);
        some_bear = some_bear || update.state.bonded;
        for (int c = 0; c < dim - 1; ++c)
          some_bear = some_bear || update.state.shear_stress[c] != 0.0;
      }
    if (!simd::any(broke))
      return;
    for (std::size_t j = 0; j < simd::width<Real>; ++j)
      if (simd::lane(broke, j))
        {
          state_row(i, dim - 1)[j] = 0.0;
          breaks.push_back(
            {std::uint32_t(first + j), i, simd::lane(update.tension_break, j), simd::lane(update.released_energy, j)});
        }
  }
};

/// Adds what a step dissipated; that of most joints is nothing and costs nothing.
template <int dim, typename Real>
void add_slip_energy(Joints<dim>& joints, const std::size_t j, const Real& energy)
{
  if (!simd::any(energy != 0.0))
    return;
  double* const slip_energy = joints.slip_energy.pack(j);
  simd::store(simd::load<Real>(slip_energy) + energy, slip_energy);
}

/// Slip energy is that of `no`, which alone has some.
template <typename Mask, int dim, typename Real>
FaceResultants<dim, Real> select(const Mask& condition, const FaceResultants<dim, Real>& yes,
                                 FaceResultants<dim, Real> no)
{
  no.normal_force = simd::select(condition, yes.normal_force, no.normal_force);
  for (std::size_t c = 0; c < no.shear_force.size(); ++c)
    no.shear_force[c] = simd::select(condition, yes.shear_force[c], no.shear_force[c]);
  for (std::size_t c = 0; c < no.moment.size(); ++c)
    no.moment[c] = simd::select(condition, yes.moment[c], no.moment[c]);
  return no;
}

/// The segments one by one, of a law whose faces never respond as one.
template <typename Real, typename Law, int dim>
FaceResultants<dim, Real> update_each_segment(const Law& law, Joints<dim>& joints, const Face<Real>& face,
                                              const FaceMotion<dim, Real>& motion, const FaceBefore<dim, Real>& before,
                                              const std::size_t j, std::vector<Break>& breaks)
{
  StoredSegments<Law, dim, Real> segments{joints, j, face, before, breaks};
  const FaceResultants<dim, Real> sum = law.update(face, joints.elements, motion, segments);
  add_slip_energy(joints, j, sum.slip_energy);
  return sum;
}

/// The segments one by one; a face whose bonds still hold all responds as one. Few faces come here: a function apart
/// keeps the way of the others short.
template <typename Real, typename Law, int dim>
[[FELDSPAR_OF_ONE_PIECE, gnu::noinline]] FaceResultants<dim, Real> update_segments(
  const Law& law, Joints<dim>& joints, SweepMemory<dim>& memory, const Face<Real>& face,
  const FaceMotion<dim, Real>& motion, const FaceBefore<dim, Real>& before, const FaceResultants<dim, Real>& as_one,
  const std::size_t j, std::vector<Break>& breaks)
{
  using Memory = SweepMemory<dim>;
  StoredSegments<Law, dim, Real> segments{joints, j, face, before, breaks};
  FaceResultants<dim, Real> sum = law.update(face, joints.elements, motion, segments);
  const auto is_whole = before.is_whole && !segments.some_changed;
  sum = select(is_whole, as_one, sum);

  double* const tensile_strength = memory.weakest.at(Memory::tensile_strength, j);
  double* const cohesion = memory.weakest.at(Memory::cohesion, j);
  if (simd::any(before.is_whole && segments.some_changed))
    simd::store(simd::select(segments.some_changed, Real(-infinity), simd::load<Real>(tensile_strength)),
                tensile_strength);
  const auto is_open = Law::surely_open(face, joints.whole, motion.opening, motion.rotation);
  const Real mark = simd::select(!segments.some_bear && is_open, Real(Memory::stands_open), Real(Memory::in_pieces));
  simd::store(simd::select(is_whole, simd::load<Real>(cohesion), mark), cohesion);
  add_slip_energy(joints, j, sum.slip_energy);
  return sum;
}

/// Centres and turns of the grains at one side of the joints.
template <int dim, typename Real>
struct GrainMotion
{
  std::array<Real, dim> centre;
  std::array<Real, n_rotations<dim>> turn;
};

template <int dim, typename Real>
GrainMotion<dim, Real> gather(const SweepMemory<dim>& memory, const std::uint32_t* const grain)
{
  constexpr std::size_t size = SweepMemory<dim>::record_size;
  const auto first = simd::gather_records<Real>(memory.grain_records.data(), size, grain);
  if constexpr (dim == 2)
    return {{first[0], first[1]}, {first[2]}};
  else
    {
      const auto second = simd::gather_records<Real>(memory.grain_records.data() + 4, size, grain);
      return {{first[0], first[1], first[2]}, {second[0], second[1], second[2]}};
    }
}

/// Asks for the responses of a pack some way on, to be written.
template <typename Real, std::size_t n_rows>
void ask_for_responses(double* const here)
{
  constexpr std::size_t n_numbers = n_rows * simd::width<Real>, line = 8;
  if constexpr (simd::width < Real >> 1)
    for (std::size_t k = 0; k < n_numbers; k += line)
      __builtin_prefetch(here + packs_ahead * n_numbers + k, 1);
}

/// Joint by joint, as Joints<dim>::response has them.
template <typename Real>
void store_response(const ContactForce<2, Real>& response, double* const to)
{
  simd::store_records<Real>({response.force[0], response.force[1], response.couple_1[0], response.couple_2[0]}, to, 4);
}

template <typename Real>
void store_response(const ContactForce<3, Real>& response, double* const to)
{
  const auto& [force, couple_1, couple_2] = response;
  simd::store_records<Real>({force[0], force[1], force[2], couple_1[0]}, to, 9);
  simd::store_records<Real>({couple_1[1], couple_1[2], couple_2[0], couple_2[1]}, to + 4, 9);
  for (std::size_t j = 0; j < simd::width<Real>; ++j)
    to[9 * j + 8] = simd::lane(couple_2[2], j);
}

template <int dim, typename Real>
void ask_for_grains(const Joints<dim>& joints, const SweepMemory<dim>& memory, const std::size_t j)
{
  constexpr std::size_t ahead = packs_ahead * simd::width<Real>;
  if constexpr (simd::width < Real >> 1)
    if (j + ahead + simd::width<Real> <= joints.size())
      for (std::size_t k = 0; k < simd::width<Real>; ++k)
        __builtin_prefetch(memory.grain_records.data() + memory.record_size * joints.grain_2[j + ahead + k]);
}

/// Joint j, or the pack of joints that begins at j.
template <typename Real, typename Law, int dim>
[[FELDSPAR_OF_ONE_PIECE]] void update_joint(const Law& law, Joints<dim>& joints, SweepMemory<dim>& memory,
                                            const std::size_t j, std::vector<Break>& breaks)
{
  using Row = typename JointTables<dim>::Row;
  constexpr std::size_t n_turns = n_rotations<dim>, n_shear = dim - 1;
  const RowsOfPack<Real, Row::count> rows{joints.state.at(0, j)};
  const Real rest_distance = rows.take(Row::rest_distance);
  const Real half_radius_difference = rows.take(Row::half_radius_difference);
  FaceMotion<dim, Real> motion;
  motion.opening_before = rows.take(Row::opening);

  ContactFrame<dim, Real> frame_before;
  frame_before.normal = rows.template take_all<dim>(Row::normal);
  frame_before.distance = rest_distance + motion.opening_before;
  if constexpr (dim == 3)
    frame_before.tangent = rows.template take_all<3>(Row::tangent);
  ask_for_grains<dim, Real>(joints, memory, j);
  const auto one = gather<dim, Real>(memory, &joints.grain_1[j]);
  const auto two = gather<dim, Real>(memory, &joints.grain_2[j]);
  const auto contact = Law::motion(frame_before, one.centre, two.centre, half_radius_difference, one.turn, two.turn);
  rows.template put_all<dim>(Row::normal, contact.frame.normal);
  if constexpr (dim == 3)
    rows.template put_all<3>(Row::tangent, contact.frame.tangent);

  FaceBefore<dim, Real> before{rows.template take_all<n_turns>(Row::rotation),
                               rows.template take_all<n_shear>(Row::slip), decltype(Real() < Real())(false)};
  motion.opening = contact.frame.distance - rest_distance;
  motion.rotation_before = before.rotation;
  motion.slip_increment = contact.slip;
  std::array<Real, n_shear> slip;
  for (std::size_t c = 0; c < n_turns; ++c)
    motion.rotation[c] = before.rotation[c] + contact.rotation[c];
  for (std::size_t c = 0; c < n_shear; ++c)
    slip[c] = before.slip[c] + contact.slip[c];
  rows.put(Row::opening, motion.opening);
  rows.template put_all<n_turns>(Row::rotation, motion.rotation);
  rows.template put_all<n_shear>(Row::slip, slip);

  const Face<Real> face{rows.take(Row::normal_stiffness), rows.take(Row::shear_stiffness), rows.take(Row::half_length),
                        joints.thickness, Real(joints.friction)};
  // Whole and open faces have no friction: their sweep does not read it.
  const auto with_friction = [&] {
    Face<Real> its_face = face;
    its_face.friction = joints.friction + rows.take(Row::further_friction);
    return its_face;
  };
  FaceResultants<dim, Real> resultants;
  if constexpr (RespondsAsOne<Law, dim, Real>)
    {
      const RowsOfPack<Real, SweepMemory<dim>::n_weakest> weakest{memory.weakest.at(0, j)};
      const Bond<Real> least{weakest.take(memory.tensile_strength), weakest.take(memory.cohesion),
                             joints.friction_slope};
      resultants = Law::whole_response(face, joints.whole, motion.opening, motion.rotation, slip);
      const auto holds = Law::surely_holds(face, joints.whole, least, motion.opening, motion.rotation, slip);
      if (!simd::all(holds))
        {
          before.is_whole = least.tensile_strength >= 0.0;
          const auto stays_open = !before.is_whole && least.cohesion == SweepMemory<dim>::stands_open &&
                                  Law::surely_open(face, joints.whole, motion.opening, motion.rotation);
          if (simd::all(holds || stays_open))
            resultants = select(stays_open, FaceResultants<dim, Real>{}, resultants);
          else
            {
              // Copies: what a function is handed lies in memory, where these numbers of all other joints need not be.
              const Face<Real> its_face = with_friction();
              const FaceMotion<dim, Real> its_motion = motion;
              const FaceBefore<dim, Real> as_before = before;
              const FaceResultants<dim, Real> as_one = resultants;
              resultants =
                update_segments<Real>(law, joints, memory, its_face, its_motion, as_before, as_one, j, breaks);
            }
        }
    }
  else
    resultants = update_each_segment<Real>(law, joints, with_friction(), motion, before, j, breaks);
  ask_for_responses<Real, JointTables<dim>::n_response_rows>(joints.response.at(0, j));
  store_response(Law::force(contact.frame, half_radius_difference, resultants.normal_force, resultants.shear_force,
                            resultants.moment),
                 joints.response.at(0, j));
}

/// x, y, φ, -, or x, y, z, -, φ_x, φ_y, φ_z, - of grain i, or of the pack of grains that begins at i.
template <typename Real, int dim>
void record_grain(const Grains<dim>& grains, const double dt, const std::size_t i, double* const records)
{
  constexpr std::size_t size = SweepMemory<dim>::record_size;
  const auto centre = [&](const std::size_t c) { return simd::load<Real>(&grains.position[c][i]); };
  const auto turn = [&](const std::size_t c) { return dt * simd::load<Real>(&grains.spin[c][i]); };
  double* const to = records + size * i;
  if constexpr (dim == 2)
    simd::store_records<Real>({centre(0), centre(1), turn(0), Real(0.0)}, to, size);
  else
    {
      simd::store_records<Real>({centre(0), centre(1), centre(2), Real(0.0)}, to, size);
      simd::store_records<Real>({turn(0), turn(1), turn(2), Real(0.0)}, to + 4, size);
    }
}

/// Records of all grains whose motions are known.
template <int dim>
void record_grains(const Grains<dim>& grains, const double dt, SweepMemory<dim>& memory)
{
  constexpr std::size_t width = simd::width<simd::Pack>;
  memory.grain_records.resize(SweepMemory<dim>::record_size * grains.size());
  double* const records = memory.grain_records.data();
  const auto known = memory.known.value_or(GrainRange{0, std::uint32_t(grains.size())});
  for_each_block(known.size(), [&](std::size_t, const std::size_t begin, const std::size_t end) {
    std::size_t i = known.first + begin;
    for (; i + width <= known.first + end; i += width)
      record_grain<simd::Pack>(grains, dt, i, records);
    for (; i < known.first + end; ++i)
      record_grain<double>(grains, dt, i, records);
  });
  for (const std::uint32_t i : memory.copied)
    record_grain<double>(grains, dt, i, records);
}
} // namespace joint_sweep

/// sweep_joints() with the law known.
template <int dim, JointLaw<dim> Law>
std::vector<Break> sweep_joints(const Law& law, Joints<dim>& joints, const Grains<dim>& grains, const double dt,
                                SweepMemory<dim>& memory, const BehindSweep& behind = {})
{
  joint_sweep::record_grains(grains, dt, memory);
  std::vector<std::vector<Break>> breaks(n_blocks(joints.size()));
  const auto sweep = [&](const std::size_t block, const std::size_t begin, const std::size_t end) {
    std::size_t j = begin;
    for (; j + simd::width<simd::Pack> <= end; j += simd::width<simd::Pack>)
      joint_sweep::update_joint<simd::Pack>(law, joints, memory, j, breaks[block]);
    for (; j < end; ++j)
      joint_sweep::update_joint<double>(law, joints, memory, j, breaks[block]);
    behind.work(block);
  };
  for_each_run_of_blocks(joints.size(), behind.blocks_in_a_row, sweep);

  std::vector<Break> all;
  for (const auto& of_block : breaks)
    all.insert(all.end(), of_block.begin(), of_block.end());
  std::sort(all.begin(), all.end(), [&](const Break& a, const Break& b) {
    return a.joint != b.joint ? joints.number[a.joint] < joints.number[b.joint] : a.segment < b.segment;
  });
  return all;
}
} // namespace feldspar

#undef FELDSPAR_OF_ONE_PIECE
