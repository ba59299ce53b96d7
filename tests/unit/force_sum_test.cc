#include "dem/dynamics/force_sum.h"

#include "base/parallel.h"
#include "base/random.h"
#include "dem/dynamics/sweeps/joint_sweep.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>
#include <vector>

namespace feldspar
{
namespace
{
/// Discs or spheres on a lattice that is pressed together and repeats itself; they turn, so that friction acts.
template <int dim>
void expect_touches_by_their_numbers(const std::size_t n_across)
{
  constexpr double radius = 1e-3, spacing = 1.98 * radius, skin = 0.1 * radius, friction = 0.5;
  const auto n_own = std::size_t(std::lround(std::pow(double(n_across), dim)));
  Random random(1, RandomStream::positions);
  Components<dim> positions;
  for (std::size_t i = 0; i < n_own; ++i)
    for (std::size_t c = 0, rest = i; c < dim; ++c, rest /= n_across)
      positions[c].push_back((double(rest % n_across) + 0.5) * spacing + random.uniform(-0.03, 0.03) * radius);
  auto body = placed_specimen<dim>(std::vector<double>(n_own, radius), positions);
  body.shape = BodyShape::periodic;
  body.size.setConstant(double(n_across) * spacing);

  Images<dim> images(body);
  images.add_within(skin, body.grains);
  for (auto& spins : body.grains.spin)
    for (std::size_t i = 0; i < n_own; ++i)
      spins[i] = random.uniform(-1.0, 1.0);
  images.move(0.0, body.grains);
  const Incidence no_joints = incidence(
    n_own, 0, [](std::size_t) { return GrainPair(); }, [](const std::uint32_t grain) { return grain; });
  Touches<dim> touches;
  EnergyLedger ledger(n_own);
  touches.search(body, images, BodyShare<dim>(n_own), no_joints, skin, ZeroForce::at_touch, ledger, [] {});
  body.particle_contact.friction = friction;
  touches.update(body, 0.0, 0.0);
  touches.update(body, 1e-3, 0.0);
  sum_remaining_forces(body, SumOrder(no_joints, 0, {0, std::uint32_t(n_own)}), touches);

  Components<dim> force;
  Components<n_rotations<dim>> couple;
  for (auto& values : force)
    values.assign(n_own, 0.0);
  for (auto& values : couple)
    values.assign(n_own, 0.0);
  std::size_t n_across_the_side = 0;
  for (std::size_t k = 0; k < touches.size(); ++k)
    {
      if (!touches.is_touching(k))
        continue;
      const Touch<dim>& touch = touches.touch(k);
      const std::uint32_t second = images.owner(touch.grain_2);
      n_across_the_side += second != touch.grain_2;
      for (int c = 0; c < dim; ++c)
        {
          force[c][touch.grain_1] -= touch.on_grains.force[c];
          force[c][second] += touch.on_grains.force[c];
        }
      for (int c = 0; c < n_rotations<dim>; ++c)
        {
          couple[c][touch.grain_1] += touch.on_grains.couple_1[c];
          couple[c][second] += touch.on_grains.couple_2[c];
        }
    }
  // A few of them would be gone through contact by contact however large the body is.
  EXPECT_GT(8 * touches.touching().size(), n_own);
  EXPECT_GT(n_across_the_side, 10u);
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < n_own; ++i)
      ASSERT_EQ(body.grains.force[c][i], force[c][i]) << "grain " << i;
  double largest_couple = 0.0;
  for (int c = 0; c < n_rotations<dim>; ++c)
    for (std::size_t i = 0; i < n_own; ++i)
      {
        ASSERT_EQ(body.grains.couple[c][i], couple[c][i]) << "grain " << i;
        largest_couple = std::max(largest_couple, std::abs(couple[c][i]));
      }
  EXPECT_GT(largest_couple, 0.0);
}

// Small bodies are gone through contact by contact, large ones grain by grain: each grain gets the same sum, to the
// last bit.
TEST(ForceSum, OfTouchesGoesByTheirNumbersInSmallBodiesAndInLarge)
{
  ASSERT_TRUE(stays_on_this_thread(400) && stays_on_this_thread(343));
  expect_touches_by_their_numbers<2>(20);
  expect_touches_by_their_numbers<3>(7);
  ASSERT_FALSE(stays_on_this_thread(10000));
  expect_touches_by_their_numbers<2>(100);
  expect_touches_by_their_numbers<3>(22);
}

/// Jointed discs or spheres on a lattice, some of which turn.
template <int dim>
Specimen<dim> jointed_lattice(const std::size_t n_across)
{
  constexpr double radius = 1e-3;
  const auto n = std::size_t(std::lround(std::pow(double(n_across), dim)));
  Random random(1, RandomStream::positions);
  Components<dim> positions;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0, rest = i; c < dim; ++c, rest /= n_across)
      positions[c].push_back((double(rest % n_across) + random.uniform(-0.01, 0.01)) * 2.0 * radius);
  for (auto& component : positions)
    component.push_back(-10.0 * radius); // a grain without joints
  auto body = placed_specimen<dim>(std::vector<double>(n + 1, radius), positions);
  FlatJointParameters flat_joint;
  flat_joint.coordination_number = 2.0 * double(dim) * (1.0 - 1.0 / double(n_across)); // the next neighbours
  install_joints(body, flat_joint);
  for (auto& spins : body.grains.spin)
    for (double& spin : spins)
      spin = random.uniform(-1.0, 1.0);
  return body;
}

template <int dim>
void expect_sums_behind_the_sweep(const std::size_t n_across)
{
  auto body = jointed_lattice<dim>(n_across);
  auto& joints = body.joints;
  const std::size_t n = joints.size();
  ASSERT_FALSE(stays_on_this_thread(n));
  const Incidence joints_of = incidence(
    body.grains.size(), n, [&](const std::size_t j) { return GrainPair(joints.grain_1[j], joints.grain_2[j]); },
    [](const std::uint32_t grain) { return grain; });

  auto expected = body;
  sweep_joints(expected.joints, expected.grains, 1e-3);
  for (std::size_t i = 0; i < body.grains.size(); ++i)
    {
      Vector<dim> one = Vector<dim>::Zero(), two = Vector<dim>::Zero();
      Rotation<dim> couple_one = Rotation<dim>::Zero(), couple_two = Rotation<dim>::Zero();
      for (auto e = joints_of.first[i]; e < joints_of.first[i + 1]; ++e)
        {
          const std::uint32_t j = joints_of.entries[e] / 2;
          const bool is_second = joints_of.entries[e] % 2 == 1;
          (is_second ? two : one) += at<dim>(expected.joints.force, j);
          (is_second ? couple_two : couple_one) +=
            at<n_rotations<dim>>(is_second ? expected.joints.couple_2 : expected.joints.couple_1, j);
        }
      set<dim>(expected.grains.force, i, two - one);
      set<n_rotations<dim>>(expected.grains.couple, i, couple_one + couple_two);
    }

  for (const std::size_t n_threads : {1, 2})
    {
      const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, n_threads);
      auto summed = body;
      for (auto& values : summed.grains.force)
        values.assign(values.size(), std::numeric_limits<double>::quiet_NaN());
      for (auto& values : summed.grains.couple)
        values.assign(values.size(), std::numeric_limits<double>::quiet_NaN());
      const SumOrder order(joints_of, n, {0, std::uint32_t(summed.grains.size())});
      // One thread sums all grains that have joints behind these; several leave some whose joints lie in the runs of two of them.
      const std::size_t n_left = summed.grains.size() - order.first_behind.back();
      if (number_of_threads() == 1)
        {
          EXPECT_EQ(n_left, 1u);
        }
      else
        {
          EXPECT_GT(n_left, 1u);
          EXPECT_LT(n_left, summed.grains.size() / 2);
        }
      SweepMemory<dim> memory(summed.joints);
      sweep_joints(summed.joints, summed.grains, 1e-3, memory,
                   {order.blocks_in_a_row, [&](const std::size_t block) { sum_forces_behind(block, summed, order); }});
      sum_remaining_forces(summed, order, Touches<dim>());
      EXPECT_EQ(summed.grains.force, expected.grains.force) << n_threads << " threads";
      EXPECT_EQ(summed.grains.couple, expected.grains.couple) << n_threads << " threads";
    }
}

TEST(ForceSum, BehindTheSweepIsThatAfterItToTheLastBit)
{
  expect_sums_behind_the_sweep<2>(80);
  expect_sums_behind_the_sweep<3>(20);
}
} // namespace
} // namespace feldspar
