// Joints with broken bonds are put together in storage: each keeps what it is, and a run its bits.

#include "dem/dynamics/dynamics.h"
#include "dem/dynamics/sweeps/joint_groups.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

namespace feldspar
{
namespace
{
constexpr std::size_t pack = 8, window = 256;

template <int dim>
Specimen<dim> body()
{
  if constexpr (dim == 2)
    return granite_box(0.03, 0.03);
  else
    return small_cylinder();
}

template <int dim>
void break_segments(Joints<dim>& joints, const std::size_t j, const unsigned int n)
{
  for (unsigned int i = 0; i < n; ++i)
    joints.bonded[joints.segment(i, j)] = 0.0;
}

template <int dim>
bool regroup(Joints<dim>& joints)
{
  return regroup(joints, SweepMemory<dim>(joints));
}

template <int dim>
std::size_t n_packs_with_broken_bonds(const Joints<dim>& joints)
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

/// All that a joint is, stores and does, by its number.
template <int dim>
std::vector<std::vector<double>> told_by_number(Joints<dim>& joints)
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
      for (std::size_t row = 0; row < joints.response.n_rows(); ++row)
        numbers.push_back(*joints.response.at(row, j));
    }
  return told;
}

template <int dim>
void expect_that_broken_joints_are_put_together()
{
  auto specimen = body<dim>();
  auto& joints = specimen.joints;
  sweep_joints(joints, specimen.grains, 0.0); // so that they have forces
  EXPECT_FALSE(regroup(joints));              // all are whole
  std::size_t n_broken = 0;
  for (std::size_t j = 0; j < joints.size(); j += 7, ++n_broken)
    break_segments(joints, j, n_broken % 2 == 0 ? joints.n_segments : 1);
  const auto before = told_by_number(joints);
  EXPECT_GT(n_packs_with_broken_bonds(joints), joints.size() / pack * 9 / 10);

  ASSERT_TRUE(regroup(joints));
  EXPECT_EQ(told_by_number(joints), before);
  // In each window the last ones: packs full of them, and one that is mixed at either end.
  const std::size_t n_windows = (joints.size() + window - 1) / window;
  EXPECT_LE(n_packs_with_broken_bonds(joints), n_broken / pack + 2 * n_windows);
  for (std::size_t j = 0; j < joints.size(); ++j)
    EXPECT_EQ(joints.number[j] / window, j / window); // none was lost: windows stay where they were
  EXPECT_FALSE(regroup(joints));                      // nothing has broken since
}

TEST(JointGroups, PutBrokenJointsTogetherAndChangeNone)
{
  expect_that_broken_joints_are_put_together<2>();
  expect_that_broken_joints_are_put_together<3>();
}

TEST(JointGroups, ArePutAnewOnlyWhereItSparesEnough)
{
  // Three broken joints of some 650 make a sweep compute three of eighty packs segment by segment: one would do.
  auto joints = granite_box(0.03, 0.03).joints;
  for (const std::size_t j : {std::size_t(0), std::size_t(100), std::size_t(400)})
    break_segments(joints, j, 1);
  EXPECT_FALSE(regroup(joints));
}

TEST(JointGroups, ThatArePutAnewHaveOneOrderHoweverTheyStood)
{
  auto one = granite_box(0.03, 0.03).joints, other = one;
  for (std::size_t j = 0; j < one.size(); j += 5)
    break_segments(one, j, 4);
  ASSERT_TRUE(regroup(one));

  // The other loses half of these bonds and is put anew before it loses the rest.
  for (std::size_t j = 0; j < other.size(); j += 10)
    break_segments(other, j, 4);
  ASSERT_TRUE(regroup(other));
  EXPECT_NE(one.number, other.number);
  for (std::size_t j = 0; j < other.size(); ++j)
    if (other.number[j] % 10 == 5)
      break_segments(other, j, 4);
  ASSERT_TRUE(regroup(other));
  EXPECT_EQ(one.number, other.number);
}

TEST(JointGroups, LeaveARunItsBitsWhereverItsJointsLie)
{
  // Torn until much of it is broken, with its joints in the order of their numbers and in another, on one thread and on two.
  using Event = std::tuple<std::uint64_t, std::uint32_t, std::uint32_t, bool, double>;
  const auto run = [](const bool in_other_order, const std::size_t n_threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, n_threads);
    auto specimen = granite_box(0.045, 0.045);
    for (std::size_t i = 0; i < specimen.grains.size(); ++i)
      {
        const double away = specimen.grains.position[1][i] - 0.5 * specimen.size[1];
        set<2>(specimen.grains.velocity, i, Vector<2>(std::sin(3.1 * double(i)), 300.0 * away));
      }
    if (in_other_order)
      {
        std::vector<std::size_t> order(specimen.joints.size());
        std::iota(order.begin(), order.end(), 0);
        std::reverse(order.begin(), order.end());
        specimen.joints.reorder(order);
      }
    Dynamics<2> dynamics(std::move(specimen), {0.0, 0.8}, ZeroForce::as_placed);
    const auto& numbers = dynamics.specimen().joints.number;
    std::vector<Event> events;
    std::vector<std::uint32_t> order = numbers;
    std::size_t n_before = 0, n_regroupings = 0;
    while (dynamics.time() < 1e-4)
      {
        for (const Break& event : dynamics.step())
          events.emplace_back(dynamics.n_steps(), numbers[event.joint], event.segment, event.in_tension,
                              event.released_energy);
        n_regroupings += numbers.size() == order.size() && numbers != order;
        n_before += n_regroupings == 0 ? 1 : 0;
        order = numbers;
      }
    EXPECT_GT(n_before, 100u); // steps with the joints where they were put
    EXPECT_GT(n_regroupings, 1u);
    return std::tuple(events, dynamics.specimen().grains.position, dynamics.specimen().grains.spin);
  };
  const auto one = run(false, 1);
  EXPECT_GT(std::get<0>(one).size(), 500u);
  EXPECT_EQ(one, run(true, 1));
  EXPECT_EQ(one, run(false, 2));
}
} // namespace
} // namespace feldspar
