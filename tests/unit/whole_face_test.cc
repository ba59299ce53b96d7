// A face whose segments are all bonded responses as one spring: the same forces, breaks and energies as segment by segment.

#include "dem/dynamics/sweeps/joint_state_of_law.h"
#include "dem/dynamics/sweeps/joint_sweep_of_law.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace feldspar
{
namespace
{
/// A law without its response as one: segment by segment from the first step on.
template <typename Law>
struct SegmentBySegment : Law
{
  using Law::Law;
  void whole_response() = delete;
};
static_assert(RespondsAsOne<FlatJoint<2>, 2, simd::Pack> && RespondsAsOne<FlatJoint<3>, 3, double>);
static_assert(RespondsAsOne<SofteningFlatJoint<2>, 2, double> && RespondsAsOne<SofteningFlatJoint<3>, 3, simd::Pack>);
static_assert(!RespondsAsOne<SegmentBySegment<FlatJoint<2>>, 2, simd::Pack> &&
              !RespondsAsOne<SegmentBySegment<FlatJoint<3>>, 3, double>);

template <template <int> class L, int n>
struct LawAndDimension
{
  static constexpr int dim = n;
  using Law = L<n>;

  static typename Law::Parameters parameters()
  {
    typename Law::Parameters wanted;
    if constexpr (requires { wanted.softening_opening; })
      wanted.softening_opening = 1e-7;
    return wanted;
  }
  static Law law() { return {parameters(), {}}; }
  static Specimen<dim> specimen()
  {
    if constexpr (dim == 2)
      return small_specimen(1, 6.0, parameters());
    else
      return small_cylinder(1, 6.0, BodyShape::cylinder, parameters());
  }
};

/// Sets the grains on smooth paths that stretch, shear, bend and twist the specimen until much of it is broken.
template <int dim>
void drive(Grains<dim>& grains, const Components<dim>& start, const int step, const double dt)
{
  const double t = step * dt;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      for (int c = 0; c < dim; ++c)
        grains.position[c][i] = start[c][i] + 5e-7 * t * std::sin((2.0 + c) * t + 1.3 * double(i));
      for (int c = 0; c < n_rotations<dim>; ++c)
        grains.spin[c][i] = 1e-3 * t * std::cos((4.0 - c) * t + 0.3 * double(i));
    }
}

template <typename>
using WholeFace = testing::Test;
using LawsThatRespondAsOne =
  testing::Types<LawAndDimension<FlatJoint, 2>, LawAndDimension<FlatJoint, 3>, LawAndDimension<SofteningFlatJoint, 2>,
                 LawAndDimension<SofteningFlatJoint, 3>>;
TYPED_TEST_SUITE(WholeFace, LawsThatRespondAsOne, );

TYPED_TEST(WholeFace, RespondsAndBreaksAsItsSegmentsDo)
{
  constexpr int dim = TypeParam::dim;
  Specimen<dim> specimen = TypeParam::specimen();
  auto& grains = specimen.grains;
  Joints<dim>& as_one = specimen.joints;
  Joints<dim> by_segments = as_one;
  SweepMemory<dim> memory(as_one), memory_by_segments(by_segments);
  const auto law = TypeParam::law();
  const SegmentBySegment<typename TypeParam::Law> segment_by_segment(TypeParam::parameters(), {});
  const Components<dim> start = grains.position;
  const double dt = 0.02;
  std::size_t n_broken = 0, n_whole = 0, n_steps_with_breaks = 0;
  for (int step = 1; step <= 200; ++step)
    {
      drive<dim>(grains, start, step, dt);
      const auto breaks = sweep_joints<dim>(law, as_one, grains, dt, memory);
      const auto expected = sweep_joints<dim>(segment_by_segment, by_segments, grains, dt, memory_by_segments);
      ASSERT_EQ(breaks.size(), expected.size()) << "step " << step;
      for (std::size_t k = 0; k < breaks.size(); ++k)
        {
          EXPECT_EQ(breaks[k].joint, expected[k].joint);
          EXPECT_EQ(breaks[k].segment, expected[k].segment);
          EXPECT_EQ(breaks[k].in_tension, expected[k].in_tension);
          EXPECT_NEAR(breaks[k].released_energy, expected[k].released_energy, 1e-9 * expected[k].released_energy);
        }
      n_broken += breaks.size();
      n_steps_with_breaks += !breaks.empty();
    }
  // Sums of 200 steps in another order: some 1e-13 of the largest force, moment and stress.
  double largest_force = 0.0, largest_couple = 0.0;
  for (std::size_t j = 0; j < as_one.size(); ++j)
    {
      largest_force = std::max(largest_force, at<dim>(by_segments.force, j).norm());
      largest_couple = std::max(largest_couple, at<n_rotations<dim>>(by_segments.couple_1, j).norm());
    }
  for (std::size_t j = 0; j < as_one.size(); ++j)
    {
      n_whole += as_one.holds_wholly(j);
      EXPECT_LT((at<dim>(as_one.force, j) - at<dim>(by_segments.force, j)).norm(), 1e-11 * largest_force);
      for (const auto couple : {&JointTables<dim>::couple_1, &JointTables<dim>::couple_2})
        EXPECT_LT((at<n_rotations<dim>>(as_one.*couple, j) - at<n_rotations<dim>>(by_segments.*couple, j)).norm(),
                  1e-11 * largest_couple);
      const double energy = joint_energy<dim>(segment_by_segment, by_segments, j);
      EXPECT_NEAR(joint_energy(as_one, j), energy, 1e-10 * energy + 1e-15);
      const double dissipated = dissipated_by_bonds<dim>(segment_by_segment, by_segments, j);
      EXPECT_NEAR(dissipated_by_bonds(as_one, j), dissipated, 1e-9 * dissipated + 1e-15);
      EXPECT_NEAR(as_one.slip_energy[j], by_segments.slip_energy[j], 1e-9 * by_segments.slip_energy[j] + 1e-15);
      for (unsigned int i = 0; i < as_one.n_segments; ++i)
        for (int c = 0; c < dim - 1; ++c)
          EXPECT_NEAR(shear_stress(as_one, i, j)[c], by_segments.shear_stress[c][by_segments.segment(i, j)],
                      1e-11 * 1e9);
    }
  // Faces that broke, faces that broke in part and faces that hold were all among them, at many steps.
  EXPECT_GT(n_whole, as_one.size() / 20);
  EXPECT_LT(n_whole, as_one.size() - as_one.size() / 20);
  EXPECT_GT(n_broken, as_one.size() / 2);
  EXPECT_GT(n_steps_with_breaks, 50u);
}

TYPED_TEST(WholeFace, WithoutBondsBearsNothingWhileOpenJustAsItsSegmentsDo)
{
  // Beside it the same joints, which never store that they carry nothing: all broken ones go segment by segment.
  constexpr int dim = TypeParam::dim;
  using Memory = SweepMemory<dim>;
  Specimen<dim> specimen = TypeParam::specimen();
  auto& grains = specimen.grains;
  Joints<dim>& resting = specimen.joints;
  Joints<dim> restless = resting;
  Memory memory(resting), memory_of_restless(restless);
  const Components<dim> start = grains.position;
  const double dt = 0.02;
  const auto rests = [&](const std::size_t j) {
    return *memory.weakest.at(Memory::tensile_strength, j) < 0.0 &&
           *memory.weakest.at(Memory::cohesion, j) == Memory::stands_open;
  };
  std::vector<bool> rested(resting.size(), false);
  std::size_t n_rests = 0, n_closings = 0;
  for (int step = 1; step <= 400; ++step)
    {
      drive<dim>(grains, start, step, dt);
      const auto breaks = sweep_joints(resting, grains, dt, memory);
      EXPECT_EQ(sweep_joints(restless, grains, dt, memory_of_restless).size(), breaks.size());
      for (std::size_t j = 0; j < resting.size(); ++j)
        {
          n_rests += rests(j);
          n_closings += rested[j] && !rests(j);
          rested[j] = rests(j);
          if (*memory_of_restless.weakest.at(Memory::tensile_strength, j) < 0.0)
            *memory_of_restless.weakest.at(Memory::cohesion, j) = Memory::in_pieces;
        }
    }
  for (std::size_t row = 0; row < resting.state.n_rows(); ++row)
    for (std::size_t j = 0; j < resting.size(); ++j)
      ASSERT_EQ(*resting.state.at(row, j), *restless.state.at(row, j)) << "row " << row << ", joint " << j;
  for (std::size_t j = 0; j < resting.size(); ++j)
    for (unsigned int i = 0; i < resting.n_segments; ++i)
      ASSERT_EQ(shear_stress(resting, i, j), shear_stress(restless, i, j)) << "segment " << i << ", joint " << j;
  for (std::size_t row = 0; row < resting.response.n_rows(); ++row)
    for (std::size_t j = 0; j < resting.size(); ++j)
      ASSERT_EQ(*resting.response.at(row, j), *restless.response.at(row, j)) << "row " << row << ", joint " << j;
  EXPECT_GT(n_rests, 1000u);
  EXPECT_GT(n_closings, 20u);
  // A resumed run knows from the joints what the sweep has stored.
  const Memory again(resting);
  for (std::size_t row = 0; row < Memory::n_weakest; ++row)
    for (std::size_t j = 0; j < resting.size(); ++j)
      EXPECT_EQ(*again.weakest.at(row, j), *memory.weakest.at(row, j));
}

TYPED_TEST(WholeFace, HasTheSameBitsWhateverItsNeighboursInAPack)
{
  // Without the first joints all others stand elsewhere in their packs, and some are updated alone.
  constexpr int dim = TypeParam::dim;
  Specimen<dim> specimen = TypeParam::specimen();
  auto& grains = specimen.grains;
  Joints<dim>& all = specimen.joints;
  Joints<dim> others = all;
  constexpr std::size_t n_left_out = 3;
  std::vector<std::size_t> kept;
  for (std::size_t j = n_left_out; j < all.size(); ++j)
    kept.push_back(j);
  others.keep(kept);
  SweepMemory<dim> memory(all), memory_of_others(others);
  const Components<dim> start = grains.position;
  const double dt = 0.02;
  for (int step = 1; step <= 200; ++step)
    {
      drive<dim>(grains, start, step, dt);
      sweep_joints(all, grains, dt, memory);
      sweep_joints(others, grains, dt, memory_of_others);
    }
  std::size_t n_whole = 0;
  for (std::size_t k = 0; k < kept.size(); ++k)
    {
      n_whole += others.holds_wholly(k);
      for (std::size_t row = 0; row < all.response.n_rows(); ++row)
        EXPECT_EQ(*others.response.at(row, k), *all.response.at(row, kept[k]));
      for (std::size_t row = 0; row < all.state.n_rows(); ++row)
        EXPECT_EQ(*others.state.at(row, k), *all.state.at(row, kept[k]));
    }
  EXPECT_GT(n_whole, kept.size() / 20);
  EXPECT_LT(n_whole, kept.size() - kept.size() / 20);
}
} // namespace
} // namespace feldspar
