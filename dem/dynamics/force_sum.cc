#include "dem/dynamics/force_sum.h"

#include "base/parallel.h"
#include "base/simd_transpose.h"

#include <array>
#include <type_traits>

namespace feldspar
{
namespace
{
using simd::Four;

/// Force and couple on a grain.
template <int dim>
struct Load
{
  std::array<double, dim> force;
  std::array<double, n_rotations<dim>> couple;
};

/// What answers give a grain that are its joints' first grain, or their second. Answers are records that are added four
/// numbers at a time; JointTables::answer has their order.
struct LoadInPlane
{
  Four one{}, two{};

  void add_as_one(const double* const answer) { one += simd::load_four(answer); }
  void add_as_two(const double* const answer) { two += simd::load_four(answer); }
  Load<2> sum() const { return {{two[0] - one[0], two[1] - one[1]}, {one[2] + two[3]}}; }
};

struct LoadInSpace
{
  Four force_one{}, force_two{}, couple_one{}, couple_two{};

  void add_as_one(const double* const answer)
  {
    force_one += simd::load_four(answer);
    couple_one += simd::load_four(answer + JointTables<3>::first_couple_1);
  }
  void add_as_two(const double* const answer)
  {
    force_two += simd::load_four(answer);
    couple_two += simd::load_four(answer + JointTables<3>::first_couple_2 - 1); // the last four
  }
  Load<3> sum() const
  {
    return {{force_two[0] - force_one[0], force_two[1] - force_one[1], force_two[2] - force_one[2]},
            {couple_one[0] + couple_two[1], couple_one[1] + couple_two[2], couple_one[2] + couple_two[3]}};
  }
};

template <int dim>
Load<dim> load_from_joints(const Joints<dim>& joints, const IncidenceBySide& joints_of, const std::size_t grain)
{
  constexpr std::size_t size = JointTables<dim>::n_answer_rows, ahead = 32;
  const double* const answers = joints.answer.at(0, 0);
  std::conditional_t<dim == 2, LoadInPlane, LoadInSpace> load;
  const auto middle = joints_of.first_as_one[grain], end = joints_of.first[grain + 1];
  for (auto e = joints_of.first[grain]; e < middle; ++e)
    {
      // Answers of joints with grains of lower numbers lie far back: asked for some grains ahead.
      if (e + ahead < joints_of.entries.size())
        {
          const double* const later = answers + size * (joints_of.entries[e + ahead] / 2);
          __builtin_prefetch(later);
          __builtin_prefetch(later + size - 1);
        }
      load.add_as_two(answers + size * (joints_of.entries[e] / 2));
    }
  for (auto e = middle; e < end; ++e)
    load.add_as_one(answers + size * (joints_of.entries[e] / 2));
  return load.sum();
}
} // namespace

template <int dim>
void sum_forces(Specimen<dim>& body, const std::size_t n_own, const IncidenceBySide& joints_of,
                const Touches<dim>& touches)
{
  auto& grains = body.grains;
  const auto& joints = body.joints;
  const Incidence& touches_of = touches.incidence();
  for_each_block(n_own, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      {
        auto [force, couple] = load_from_joints(joints, joints_of, i);
        for (auto e = touches_of.first[i]; e < touches_of.first[i + 1]; ++e)
          {
            const std::uint32_t entry = touches_of.entries[e];
            if (!touches.is_touching(entry / 2))
              continue;
            const Touch<dim>& touch = touches.list()[entry / 2];
            const double direction = entry % 2 ? 1.0 : -1.0;
            for (int c = 0; c < dim; ++c)
              force[c] += direction * touch.force[c];
            for (int c = 0; c < n_rotations<dim>; ++c)
              couple[c] += (entry % 2 ? touch.couple_2 : touch.couple_1)[c];
          }
        for (int c = 0; c < dim; ++c)
          grains.force[c][i] = force[c];
        for (int c = 0; c < n_rotations<dim>; ++c)
          grains.couple[c][i] = couple[c];
      }
  });
}

template void sum_forces<2>(Specimen<2>&, std::size_t, const IncidenceBySide&, const Touches<2>&);
template void sum_forces<3>(Specimen<3>&, std::size_t, const IncidenceBySide&, const Touches<3>&);
} // namespace feldspar
