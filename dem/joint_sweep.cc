#include "dem/joint_sweep.h"

#include "dem/joint_update.h"
#include "dem/parallel.h"

#include <algorithm>
#include <string>

namespace feldspar
{
namespace
{
using flat_joint::Bond;
using flat_joint::SegmentState;
using flat_joint::SegmentUpdate;

/// The segments of one joint, or of a pack of neighbouring ones, in the arrays of all joints.
template <int dim, typename Real>
struct StoredSegments
{
  Joints<dim>& joints;
  const std::size_t first;
  std::vector<Break>& breaks;

  Bond<Real> bond(const unsigned int i) const
  {
    const std::size_t k = joints.segment(i, first);
    return {simd::load<Real>(&joints.tensile_strength[k]), simd::load<Real>(&joints.cohesion[k]),
            joints.friction_slope};
  }

  SegmentState<dim, Real> state(const unsigned int i) const
  {
    const std::size_t k = joints.segment(i, first);
    SegmentState<dim, Real> state;
    for (int c = 0; c < dim - 1; ++c)
      state.shear_stress[c] = simd::load<Real>(&joints.shear_stress[c][k]);
    state.bonded = simd::load<Real>(&joints.bonded[k]) > 0.5;
    return state;
  }

  void set(const unsigned int i, const SegmentUpdate<dim, Real>& update)
  {
    const std::size_t k = joints.segment(i, first);
    for (int c = 0; c < dim - 1; ++c)
      simd::store(update.state.shear_stress[c], &joints.shear_stress[c][k]);
    if (simd::any(update.tension_break || update.shear_break))
      for (std::size_t j = 0; j < simd::width<Real>; ++j)
        if (const bool in_tension = simd::lane(update.tension_break, j);
            in_tension || simd::lane(update.shear_break, j))
          {
            joints.bonded[k + j] = 0.0;
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
std::array<Real, n> load(const Components<n>& from, const std::size_t i)
{
  std::array<Real, n> value;
  for (std::size_t c = 0; c < n; ++c)
    value[c] = simd::load<Real>(&from[c][i]);
  return value;
}

template <typename Real, std::size_t n>
void store(const std::array<Real, n>& value, Components<n>& to, const std::size_t i)
{
  for (std::size_t c = 0; c < n; ++c)
    simd::store(value[c], &to[c][i]);
}

/// Joint j, or the pack of joints that begins at j. Flattened: packs handed to functions go by way of memory, which
/// takes half as long again as the work.
template <typename Real, int dim>
[[gnu::flatten]] void update_joint(Joints<dim>& joints, const Grains<dim>& grains, const double dt, const std::size_t j,
                                   std::vector<Break>& breaks)
{
  constexpr std::size_t n_turns = n_rotations<dim>;
  const std::uint32_t* const grain_1 = &joints.grain_1[j];
  const std::uint32_t* const grain_2 = &joints.grain_2[j];
  const Real rest_distance = simd::load<Real>(&joints.rest_distance[j]);
  const Real half_radius_difference = simd::load<Real>(&joints.half_radius_difference[j]);
  const Real opening_before = simd::load<Real>(&joints.opening[j]);

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
  const auto contact =
    contact_motion(before, gather<Real, dim>(grains.position, grain_1), gather<Real, dim>(grains.position, grain_2),
                   half_radius_difference, turn_1, turn_2);
  FaceMotion<dim, Real> motion;
  motion.opening_before = opening_before;
  motion.opening = contact.frame.distance - rest_distance;
  motion.rotation_before = load<Real, n_turns>(joints.rotation, j);
  for (std::size_t c = 0; c < n_turns; ++c)
    motion.rotation[c] = motion.rotation_before[c] + contact.rotation[c];
  motion.slip_increment = contact.slip;

  const Face<Real> face{simd::load<Real>(&joints.normal_stiffness[j]), simd::load<Real>(&joints.shear_stiffness[j]),
                        simd::load<Real>(&joints.half_length[j]), joints.thickness, joints.friction};
  const auto resultants = update_face(face, joints.elements, motion, StoredSegments<dim, Real>{joints, j, breaks});
  const auto answer = contact_force(contact.frame, half_radius_difference, resultants.normal_force,
                                    resultants.shear_force, resultants.moment);

  store<Real, dim>(contact.frame.normal, joints.normal, j);
  if constexpr (dim == 3)
    store<Real, 3>(contact.frame.tangent, joints.tangent, j);
  simd::store(motion.opening, &joints.opening[j]);
  store<Real, n_turns>(motion.rotation, joints.rotation, j);
  for (int c = 0; c < dim - 1; ++c)
    simd::store(simd::load<Real>(&joints.slip[c][j]) + contact.slip[c], &joints.slip[c][j]);
  simd::store(simd::load<Real>(&joints.slip_energy[j]) + resultants.slip_energy, &joints.slip_energy[j]);
  store<Real, dim>(answer.force, joints.force, j);
  store<Real, n_turns>(answer.couple_1, joints.couple_1, j);
  store<Real, n_turns>(answer.couple_2, joints.couple_2, j);
}

/// Where each array that a sweep walks through begins: some twenty for the joint and five for each segment. They are more
/// than a processor follows by itself, so the sweep asks for what it will need, a few packs ahead.
template <int dim>
class Ahead
{
public:
  explicit Ahead(Joints<dim>& joints)
    : n_joints(joints.size())
  {
    if (n_joints == 0)
      return;
    const auto follow = [&](const std::string&, std::vector<double>& values) {
      for (std::size_t row = 0; row + n_joints <= values.size(); row += n_joints)
        arrays.push_back(&values[row]);
    };
    joints.visit_per_joint(follow);
    joints.visit_per_segment(follow);
    for (auto& component : joints.force)
      follow("", component);
    for (auto* components : {&joints.couple_1, &joints.couple_2})
      for (auto& component : *components)
        follow("", component);
    // What stays in the caches is near anyway.
    constexpr std::size_t largest_near = 8u << 20;
    if (arrays.size() * n_joints * sizeof(double) < largest_near)
      arrays.clear();
  }

  void ask(const std::size_t joint) const
  {
    constexpr std::size_t distance = 4 * simd::width<simd::Pack>;
    if (joint + distance < n_joints)
      for (const double* const array : arrays)
        __builtin_prefetch(array + joint + distance);
  }

private:
  std::size_t n_joints;
  std::vector<const double*> arrays;
};
} // namespace

template <int dim>
std::vector<Break> sweep_joints(Joints<dim>& joints, const Grains<dim>& grains, const double dt)
{
  std::vector<std::vector<Break>> breaks(n_blocks(joints.size()));
  const Ahead<dim> ahead(joints);
  for_each_block(joints.size(), [&](const std::size_t block, const std::size_t begin, const std::size_t end) {
    std::size_t j = begin;
    for (; j + simd::width<simd::Pack> <= end; j += simd::width<simd::Pack>)
      {
        ahead.ask(j);
        update_joint<simd::Pack>(joints, grains, dt, j, breaks[block]);
      }
    for (; j < end; ++j)
      update_joint<double>(joints, grains, dt, j, breaks[block]);
  });

  std::vector<Break> all;
  for (const auto& of_block : breaks)
    all.insert(all.end(), of_block.begin(), of_block.end());
  std::sort(all.begin(), all.end(), [](const Break& a, const Break& b) {
    return a.joint != b.joint ? a.joint < b.joint : a.segment < b.segment;
  });
  return all;
}

template std::vector<Break> sweep_joints<2>(Joints<2>&, const Grains<2>&, double);
template std::vector<Break> sweep_joints<3>(Joints<3>&, const Grains<3>&, double);
} // namespace feldspar
