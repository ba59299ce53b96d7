// Genesis and explicit dynamics in three dimensions.

#include "dem/dynamics/dynamics.h"
#include "dem/specimen/specimen_file.h"
#include "tests/temporary_folder.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
TEST(SpaceGenesis, FillsBoxAndCylinderToTheStressAndStaysInside)
{
  for (const BodyShape shape : {BodyShape::box, BodyShape::cylinder})
    {
      const auto specimen = small_cylinder(1, 1.0, shape);
      const auto& report = specimen.report;
      EXPECT_NEAR(report.packing_stress, 1e-4 * 80e9, 0.01 * 1e-4 * 80e9);
      EXPECT_GT(report.n_joints, 2 * report.n_grains);
      const double volume = 8e-3 * 8e-3 * 12e-3 * (specimen.is_round() ? 0.25 * std::numbers::pi : 1.0);
      EXPECT_NEAR(specimen.volume(), volume, 1e-12 * volume);
      double mass = 0.0;
      for (const double m : specimen.grains.mass)
        mass += m;
      EXPECT_NEAR(mass, 2700.0 * volume, 1e-9 * 2700.0 * volume);
      // Within the walls, but for overlaps of the order of the packing's, P_m/E* of the radius and some.
      for (std::size_t i = 0; i < specimen.grains.size(); ++i)
        {
          const Vector<3> x = at<3>(specimen.grains.position, i);
          const double r = 0.99 * specimen.grains.radius[i];
          EXPECT_TRUE(!specimen.is_round() || specimen.distance_from_axis(x) < 4e-3 - r);
          EXPECT_TRUE((x.array() > r).all() && (x.array() < specimen.size.array() - r).all());
        }
      for (std::size_t j = 0; j < report.n_joints; ++j)
        EXPECT_NEAR(at<3>(specimen.joints.tangent, j).dot(at<3>(specimen.joints.normal, j)), 0.0, 1e-15);
    }
}

TEST(SpaceGenesis, AFileKeepsTheSpecimen)
{
  const auto specimen = small_cylinder();
  const tests::TemporaryFolder folder;
  write_specimen(specimen, folder.path() / "specimen.h5");
  const auto read = read_specimen<3>(folder.path() / "specimen.h5");
  EXPECT_TRUE(read.is_round());
  EXPECT_EQ(read.grains.position, specimen.grains.position);
  EXPECT_EQ(read.joints.tangent, specimen.joints.tangent);
  EXPECT_EQ(read.joints.elements.size(), 8u);
  EXPECT_EQ(read.joints.elements[5].offset, specimen.joints.elements[5].offset);
}

TEST(SpaceDynamics, ASphereThrownOnARoughWallEndsRolling)
{
  // I = ⅖mR²: rolling at 5/7 of the first velocity, whatever the friction; 2/7 of the energy went into friction. Along
  // a direction in the plane of the wall that is no axis.
  const double radius = 1e-3;
  const double speed = 1.0;
  for (const int axis : {0, 1, 2})
    {
      auto specimen = placed_specimen<3>({radius}, {{{0.5}, {0.5}, {0.5}}});
      const int one = (axis + 1) % 3;
      const int two = (axis + 2) % 3;
      specimen.grains.velocity[one] = {0.6 * speed};
      specimen.grains.velocity[two] = {-0.8 * speed};
      const double weight = specimen.grains.mass[0] * 1e6;
      specimen.grains.position[axis] = {radius -
                                        weight / (std::numbers::pi * radius * specimen.particle_contact.modulus)};
      Dynamics<3> dynamics(std::move(specimen), {0.0, 0.2}, ZeroForce::at_touch);
      dynamics.add_wall({axis, 1.0, 0.0, 0.0, 0.3});
      dynamics.set_gravity(-1e6 * Vector<3>::Unit(axis));
      while (dynamics.time() < 2.0 * speed / (3.0 * 0.3 * 1e6))
        dynamics.step();
      const auto& grains = dynamics.specimen().grains;
      Vector<3> velocity = Vector<3>::Zero();
      constexpr int n_steps = 20000;
      for (int n = 0; n < n_steps; ++n)
        {
          dynamics.step();
          velocity += at<3>(grains.velocity, 0) / n_steps;
        }
      EXPECT_NEAR(velocity[one], 5.0 / 7.0 * 0.6 * speed, 0.01 * speed);
      EXPECT_NEAR(velocity[two], -5.0 / 7.0 * 0.8 * speed, 0.01 * speed);
      const double lost = grains.mass[0] * speed * speed / 7.0;
      EXPECT_NEAR(dynamics.energies().slip, lost, 0.02 * lost);
    }
}

TEST(SpaceDynamics, ARoundWallHoldsAGrainAndItsWorkIsCounted)
{
  // A sphere in a shrinking cylinder: pushed towards the axis by overlap times πER; its work ends as strain and motion.
  auto specimen = placed_specimen<3>({1e-3}, {{{0.5 + 3e-3}, {0.5 - 4e-3}, {0.5}}});
  Dynamics<3> dynamics(std::move(specimen), {0.0, 0.05}, ZeroForce::at_touch);
  Wall wall = {.side = -1.0, .position = 6e-3, .round = true};
  wall.velocity = -0.1;
  const auto number = dynamics.add_wall(wall);
  while (dynamics.wall_force(number) == 0.0)
    dynamics.step();
  for (int n = 0; n < 10; ++n)
    dynamics.step();
  const auto& grains = dynamics.specimen().grains;
  const double distance = std::hypot(grains.position[0][0] - 0.5, grains.position[1][0] - 0.5);
  const double overlap = distance + 1e-3 - dynamics.walls()[number].position;
  EXPECT_NEAR(dynamics.wall_force(number), std::numbers::pi * 80e9 * 1e-3 * overlap,
              1e-6 * dynamics.wall_force(number));
  EXPECT_NEAR(grains.force[0][0], -0.6 * dynamics.wall_force(number), 1e-9 * dynamics.wall_force(number));
  EXPECT_NEAR(grains.force[1][0], 0.8 * dynamics.wall_force(number), 1e-9 * dynamics.wall_force(number));
  EXPECT_LT(dynamics.energies().imbalance(), 1e-3);
}
} // namespace
} // namespace feldspar
