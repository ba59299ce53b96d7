#include "benchmarks/plain_laboratory.h"
#include "dem/dynamics/sweeps/joint_sweep.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
/// Drives all grains along smooth paths that stretch, shear and turn the specimen until much of it is broken.
void prescribe(Grains<2>& grains, const Components<2>& start, const int step, const double dt)
{
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const double t = step * dt;
      grains.position[0][i] = start[0][i] + 1e-6 * std::sin(3.0 * t + double(i));
      grains.position[1][i] = start[1][i] + 1e-6 * std::cos(2.0 * t + 1.7 * double(i)) - 1e-6;
      grains.spin[0][i] = 1e-2 * std::sin(5.0 * t + 0.3 * double(i));
    }
}

TEST(JointSweep, AgreesWithPlainCodeThroughBreakageSlidingAndReopening)
{
  Specimen<2> specimen = small_specimen();
  plain::Body body(specimen, plain::Loading::none, 0.0, 0.0);
  const Components<2> start = specimen.grains.position;
  const double dt = 0.02;
  std::size_t n_broken = 0;
  for (int step = 1; step <= 300; ++step)
    {
      prescribe(specimen.grains, start, step, dt);
      for (std::size_t i = 0; i < body.grains.size(); ++i)
        {
          body.grains[i].x = specimen.grains.position[0][i];
          body.grains[i].y = specimen.grains.position[1][i];
          body.grains[i].spin = specimen.grains.spin[0][i];
        }
      n_broken += sweep_joints(specimen.joints, specimen.grains, dt).size();
      body.sweep(dt);
    }
  EXPECT_EQ(n_broken, body.cracks.size());
  EXPECT_GT(n_broken, specimen.joints.size()); // of four segments a joint, more than a quarter
  EXPECT_LT(n_broken, 4 * specimen.joints.size());
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    for (unsigned int s = 0; s < 4; ++s)
      {
        const std::size_t k = specimen.joints.segment(s, j);
        EXPECT_EQ(specimen.joints.bonded[k] > 0.5, body.segments[plain::n_segments * j + s].bonded);
        // 300 steps of round-off of different order on stresses of up to 1e9 Pa.
        EXPECT_NEAR(shear_stress(specimen.joints, s, j)[0], body.shear_stress(j, s), 1.0);
      }
}

TEST(JointSweep, ARigidTurnOfAStressedJointChangesNothing)
{
  // Opened, sheared and bent, some segments broken; then carried round by one turn in 1000 steps. A law in velocities
  // would drift by about (2π/1000)²/24 a step, 1e-3 in all.
  Specimen<2> specimen = placed_specimen({1e-3, 0.7e-3}, {{{0.5, 0.5017}, {0.5, 0.5}}});
  FlatJointParameters wanted;
  wanted.installation_gap_ratio = 1.0;
  install_joints(specimen, wanted);
  auto& joints = specimen.joints;
  auto& grains = specimen.grains;
  grains.position[0][1] -= 1e-6;
  grains.position[1][1] += 2e-6;
  grains.spin[0] = {1e-3, -4e-3};
  const auto broken = sweep_joints(joints, grains, 1.0);
  ASSERT_GT(broken.size(), 0u);
  ASSERT_LT(broken.size(), 4u);

  const Joints<2> before = joints;
  const double opening = joints.opening[0];
  const Vector<2> force_before = at<2>(joints.force, 0);
  const double couple_before = joints.couple_2[0][0];
  const Vector<2> first = at<2>(grains.position, 0);
  const Vector<2> branch = at<2>(grains.position, 1) - first;
  const int n_steps = 1000;
  for (int step = 1; step <= n_steps; ++step)
    {
      const double angle = 2.0 * std::numbers::pi * step / n_steps;
      grains.position[0][1] = first[0] + std::cos(angle) * branch[0] - std::sin(angle) * branch[1];
      grains.position[1][1] = first[1] + std::sin(angle) * branch[0] + std::cos(angle) * branch[1];
      grains.spin[0] = {2.0 * std::numbers::pi / n_steps, 2.0 * std::numbers::pi / n_steps};
      EXPECT_TRUE(sweep_joints(joints, grains, 1.0).empty());
    }
  for (std::size_t k = 0; k < before.shear_stress[0].size(); ++k)
    EXPECT_NEAR(shear_stress(joints, unsigned(k), 0)[0], shear_stress(before, unsigned(k), 0)[0], 1e-10 * 1e9);
  EXPECT_NEAR(joints.opening[0], opening, 1e-10 * 1e-6);
  EXPECT_NEAR((at<2>(joints.force, 0) - force_before).norm(), 0.0, 1e-10 * force_before.norm());
  EXPECT_NEAR(joints.couple_2[0][0], couple_before, 1e-10 * std::abs(couple_before));
}
} // namespace
} // namespace feldspar
