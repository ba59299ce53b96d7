// Genesis and explicit dynamics in three dimensions.

#include "dem/dynamics/dynamics.h"
#include "dem/specimen/specimen_file.h"
#include "tests/temporary_folder.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>

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

struct Drift
{
  double energy, momentum, angular_momentum;
};

/// A free, unbreakable, undamped assembly with random velocities and spins.
Drift drift(const double time_step_safety)
{
  auto specimen = small_cylinder(2, 1e6);
  specimen.particle_contact.friction = 0.0;
  double kinetic = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const auto x = double(i);
      set<3>(specimen.grains.velocity, i, Vector<3>(std::sin(12.9 * x), std::sin(78.2 * x), std::sin(37.7 * x)));
      set<3>(specimen.grains.spin, i,
             Vector<3>(1e3 * std::sin(3.1 * x), 1e3 * std::sin(5.3 * x), 1e3 * std::sin(9.7 * x)));
      const double mass = specimen.grains.mass[i];
      kinetic += 0.5 * mass * at<3>(specimen.grains.velocity, i).squaredNorm() +
                 0.5 * specimen.grains.moment_of_inertia[i] * at<3>(specimen.grains.spin, i).squaredNorm();
      scale += mass * at<3>(specimen.grains.velocity, i).norm();
    }
  Dynamics<3> dynamics(std::move(specimen), {0.0, time_step_safety}, ZeroForce::as_placed);
  const auto& grains = dynamics.specimen().grains;
  const auto momentum = [&] {
    Vector<3> sum = Vector<3>::Zero();
    for (std::size_t i = 0; i < grains.size(); ++i)
      sum += grains.mass[i] * at<3>(grains.velocity, i);
    return sum;
  };
  // At half steps, with the positions of the middle of the step.
  const auto angular_momentum = [&](const double back) {
    Vector<3> sum = Vector<3>::Zero();
    for (std::size_t i = 0; i < grains.size(); ++i)
      {
        const Vector<3> v = at<3>(grains.velocity, i);
        sum += grains.mass[i] * (at<3>(grains.position, i) - back * v).cross(v) +
               grains.moment_of_inertia[i] * at<3>(grains.spin, i);
      }
    return sum;
  };
  const Vector<3> momentum_before = momentum();
  const Vector<3> angular_before = angular_momentum(0.0);
  Drift worst{0.0, 0.0, 0.0};
  while (dynamics.time() < 2e-6)
    {
      dynamics.step();
      const auto energies = dynamics.energies();
      worst.energy = std::max(worst.energy, std::abs(energies.unaccounted()) / kinetic);
    }
  worst.momentum = (momentum() - momentum_before).norm() / scale;
  worst.angular_momentum = (angular_momentum(0.5 * dynamics.time_step()) - angular_before).norm() / (scale * 4e-3);
  return worst;
}

TEST(SpaceDynamics, AnUndampedAssemblyKeepsMomentumAngularMomentumAndEnergy)
{
  // Energy to Δt², as in the plane. Angular momentum would drift by the whole shear force times a_i if the couples
  // missed it; what is left comes from contact points that move within a step.
  const auto coarse = drift(0.08);
  const auto fine = drift(0.04);
  EXPECT_LT(coarse.momentum, 1e-13);
  EXPECT_LT(coarse.angular_momentum, 1e-6);
  EXPECT_LT(coarse.energy, 1e-3);
  EXPECT_NEAR(coarse.energy / fine.energy, 4.0, 1.0);
  RecordProperty("energy_error", std::to_string(coarse.energy));
  RecordProperty("angular_momentum_error", std::to_string(coarse.angular_momentum));
}

TEST(SpaceDynamics, EnergiesBalanceThroughBreakageAndSliding)
{
  auto specimen = small_cylinder(3);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const auto x = double(i);
      set<3>(specimen.grains.velocity, i,
             Vector<3>(6.0 * std::sin(3.1 * x), 6.0 * std::cos(7.7 * x), 6.0 * std::sin(5.9 * x)));
    }
  Dynamics<3> dynamics(std::move(specimen), {0.2, 0.08}, ZeroForce::as_placed);
  std::size_t n_broken = 0;
  while (dynamics.time() < 1e-5)
    n_broken += dynamics.step().size();
  EXPECT_GT(n_broken, 200u);
  const auto energies = dynamics.energies();
  EXPECT_GT(energies.slip, 0.0);
  EXPECT_GT(energies.released, 0.0);
  // A break drops its force within one step: half that step's work, about one part in a thousand here.
  EXPECT_LT(energies.imbalance(), 0.01);
}

TEST(SpaceDynamics, IsTheSameForAnyNumberOfThreads)
{
  const double radius = 1e-3;
  Components<3> positions;
  std::vector<double> radii;
  for (int layer = 0; layer < 16; ++layer)
    for (int row = 0; row < 30; ++row)
      for (int column = 0; column < 30; ++column)
        {
          radii.push_back(radius * (1.0 - 0.05 * std::abs(std::sin(double(radii.size())))));
          positions[0].push_back(radius * (1.0 + 2.0 * column));
          positions[1].push_back(radius * (1.0 + 2.0 * row));
          positions[2].push_back(radius * (1.0 + 2.0 * layer));
        }
  const auto run = [&](const std::size_t n_threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, n_threads);
    auto specimen = placed_specimen<3>(radii, positions);
    FlatJointParameters wanted;
    wanted.installation_gap_ratio = 0.2;
    install_joints(specimen, wanted);
    EXPECT_GT(specimen.joints.size(), 20000u);
    for (std::size_t i = 0; i < specimen.grains.size(); ++i)
      specimen.grains.velocity[0][i] = 30.0 * std::sin(0.1 * double(i));
    Dynamics<3> dynamics(std::move(specimen), {0.7, 0.8}, ZeroForce::as_placed);
    std::size_t n_broken = 0;
    for (int n = 0; n < 40; ++n)
      n_broken += dynamics.step().size();
    EXPECT_GT(n_broken, 100u);
    return std::pair(dynamics.specimen().grains.position, dynamics.energies().damping);
  };
  const auto alone = run(1);
  const auto together = run(4);
  EXPECT_EQ(alone.first, together.first);
  EXPECT_EQ(alone.second, together.second);
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
