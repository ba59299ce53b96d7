// Joints with broken bonds are gathered in storage: each keeps what it is, and a run the same bits.

#include "dem/dynamics/dynamics.h"
#include "dem/dynamics/sweeps/joint_groups.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

namespace feldspar
{
namespace
{
constexpr std::size_t pack = 8;

void break_segments(Joints<2>& joints, const std::size_t j, const unsigned int n, JointGroups<2>& groups)
{
  std::vector<Break> breaks;
  for (unsigned int i = 0; i < n; ++i)
    {
      joints.bonded[joints.segment(i, j)] = 0.0;
      breaks.push_back({std::uint32_t(j), i, true, 0.0});
    }
  groups.note(breaks, joints);
}

std::size_t n_packs_with_broken_bonds(const Joints<2>& joints)
{
  std::size_t n = 0;
  for (std::size_t begin = 0; begin < joints.size(); begin += pack)
    {
      bool some_broken = false;
      for (std::size_t j = begin; j < std::min(begin + pack, joints.size()); ++j)
        some_broken = some_broken || !joints.holds_wholly(j);
      n += some_broken;
    }
  return n;
}

/// What a joint is and remembers, by its number.
std::vector<std::vector<double>> told_by_number(Joints<2>& joints)
{
  std::vector<std::vector<double>> told(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      auto& numbers = told[joints.number[j]];
      numbers = {double(joints.grain_1[j]), double(joints.grain_2[j])};
      joints.visit_per_joint([&](const std::string&, const auto& values) { numbers.push_back(values[j]); });
      joints.visit_per_segment([&](const std::string&, const auto& values) {
        for (unsigned int i = 0; i < joints.n_segments; ++i)
          numbers.push_back(values[joints.segment(i, j)]);
      });
    }
  return told;
}

TEST(JointGroups, GatherWhatIsBrokenAndChangeNoJoint)
{
  auto joints = granite_box(0.03, 0.03).joints;
  ASSERT_GT(joints.size(), 512u); // two windows and a piece of a third
  JointGroups<2> groups(joints);
  EXPECT_FALSE(groups.gather(joints)); // all is whole
  std::size_t n_broken = 0;
  for (std::size_t j = 0; j < joints.size(); j += 7, ++n_broken)
    break_segments(joints, j, n_broken % 2 == 0 ? 4 : 1, groups);
  const auto before = told_by_number(joints);
  EXPECT_GT(n_packs_with_broken_bonds(joints), joints.size() / pack * 9 / 10);

  ASSERT_TRUE(groups.gather(joints));
  EXPECT_EQ(told_by_number(joints), before);
  // In each window of 256 the last ones: packs full of them, and one that is mixed.
  EXPECT_LE(n_packs_with_broken_bonds(joints), n_broken / pack + 2 * (joints.size() / 256 + 1));
  EXPECT_FALSE(groups.gather(joints)); // nothing has broken since
}

TEST(JointGroups, ArePutAnewOnlyWhereItSparesEnough)
{
  // Of some 650 joints three that are broken take three of eighty packs the long way: one would do.
  auto joints = granite_box(0.03, 0.03).joints;
  JointGroups<2> groups(joints);
  for (const std::size_t j : {std::size_t(0), std::size_t(100), std::size_t(400)})
    break_segments(joints, j, 1, groups);
  EXPECT_FALSE(groups.gather(joints));
}

TEST(JointGroups, LeaveARunItsBitsWhereverItsJointsLie)
{
  // Torn until much of it is broken, with its joints in the order of their numbers and in another.
  using Event = std::tuple<std::uint64_t, std::uint32_t, std::uint32_t, bool, double>;
  const auto run = [](const bool in_other_order) {
    auto specimen = small_specimen(2);
    for (std::size_t i = 0; i < specimen.grains.size(); ++i)
      {
        const double away = specimen.grains.position[1][i] - 0.5 * specimen.size[1];
        set<2>(specimen.grains.velocity, i, Vector<2>(std::sin(3.1 * double(i)), 500.0 * away));
      }
    if (in_other_order)
      {
        std::vector<std::size_t> taken(specimen.joints.size());
        std::iota(taken.begin(), taken.end(), 0);
        std::reverse(taken.begin(), taken.end());
        specimen.joints.reorder(0, taken);
      }
    Dynamics<2> dynamics(std::move(specimen), {0.0, 0.8}, ZeroForce::as_placed);
    const auto& numbers = dynamics.specimen().joints.number;
    std::vector<Event> events;
    std::vector<std::uint32_t> order = numbers;
    std::size_t n_gatherings = 0;
    while (dynamics.time() < 3e-4)
      {
        for (const Break& event : dynamics.step())
          events.emplace_back(dynamics.n_steps(), numbers[event.joint], event.segment, event.in_tension,
                              event.released_energy);
        n_gatherings += numbers.size() == order.size() && numbers != order;
        order = numbers;
      }
    EXPECT_GT(n_gatherings, 1u);
    return std::tuple(events, dynamics.specimen().grains.position, dynamics.specimen().grains.spin);
  };
  const auto one = run(false);
  EXPECT_GT(std::get<0>(one).size(), 200u);
  EXPECT_EQ(one, run(true));
}
} // namespace
} // namespace feldspar
