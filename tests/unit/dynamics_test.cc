#include "dem/dynamics/dynamics.h"
#include "tests/unit/small_specimen.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
const DynamicsParameters undamped{0.0, 0.8};

TEST(Dynamics, FreeFallIsExactAtWholeSteps)
{
  // Velocities at half steps make x(n) = -½ g t² to round-off. Starting with a whole kick instead of half of one would
  // give -½ g t (t + Δt), off by one part in n.
  Dynamics<2> dynamics(placed_specimen({1e-3}, {{{0.5}, {0.5}}}), undamped, ZeroForce::at_touch);
  dynamics.set_gravity({0.0, -9.81});
  const int n_steps = 1000;
  for (int n = 0; n < n_steps; ++n)
    dynamics.step();
  const double fallen = 0.5 * 9.81 * dynamics.time() * dynamics.time();
  EXPECT_NEAR(dynamics.specimen().grains.position[1][0], 0.5 - fallen, 1e-12 * fallen + 1e-15);
  // Energy of the grain: kinetic ½ m v² with v = g t, equal to the work of gravity.
  const auto energies = dynamics.energies();
  const double mass = dynamics.specimen().grains.mass[0];
  // The way is the difference of two positions near 0.5 m, each good to 1e-16 m.
  EXPECT_NEAR(energies.boundary_work, mass * 9.81 * fallen, mass * 9.81 * 1e-15);
  EXPECT_NEAR(energies.kinetic, energies.boundary_work, 1e-5 * energies.boundary_work);
}

TEST(Dynamics, TwoGrainsBounceApartAsTheyCame)
{
  // Linear contact without damping: half a period π√(m/2k) of the oscillator of reduced mass m/2, then the velocities
  // are exchanged. Discrete time leaves a small part of (ωΔt)²; forces evaluated half a step late (an explicit Euler
  // scheme) would add energy of order ωΔt, here several percent.
  const double radius = 1e-3;
  const double speed = 0.01;
  auto specimen = placed_specimen({radius, radius}, {{{0.5, 0.5 + 2.0005 * radius}, {0.5, 0.5}}});
  specimen.grains.velocity[0] = {speed, -speed};
  Dynamics<2> dynamics(std::move(specimen), {0.0, 0.05}, ZeroForce::at_touch);
  double in_touch = 0.0;
  bool touched = false;
  for (;;)
    {
      dynamics.step();
      const bool touching = dynamics.faceless_coordination_number() > 0.0;
      if (touching)
        in_touch += dynamics.time_step();
      touched = touched || touching;
      if (touched && !touching)
        break;
    }
  const auto& grains = dynamics.specimen().grains;
  EXPECT_NEAR(grains.velocity[0][0], -speed, 1e-3 * speed);
  EXPECT_NEAR(grains.velocity[0][1], speed, 1e-3 * speed);
  const double stiffness = dynamics.specimen().particle_contact.modulus; // E/(2R)·2R·t
  const double half_period = std::numbers::pi * std::sqrt(0.5 * grains.mass[0] / stiffness);
  EXPECT_NEAR(in_touch, half_period, 2.0 * dynamics.time_step()); // its ends fall between steps
}

struct Drift
{
  double energy;           ///< largest change of the total over the kinetic energy at the start
  double momentum;         ///< largest change over the sum of |m v|
  double angular_momentum; ///< in space, over that sum times half of the body's width
};

/// A free, unbreakable, undamped assembly with these velocities and spins, for a fixed time.
template <int dim, typename Velocity, typename Spin>
Drift drift(Specimen<dim> specimen, const Velocity& velocity_of, const Spin& spin_of, const double until,
            const double time_step_safety)
{
  specimen.particle_contact.friction = 0.0;
  double kinetic = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const Vector<dim> velocity = velocity_of(double(i));
      const Rotation<dim> spin = spin_of(double(i));
      set<dim>(specimen.grains.velocity, i, velocity);
      set<n_rotations<dim>>(specimen.grains.spin, i, spin);
      const double mass = specimen.grains.mass[i];
      kinetic += 0.5 * mass * velocity.squaredNorm() + 0.5 * specimen.grains.moment_of_inertia[i] * spin.squaredNorm();
      scale += mass * velocity.norm();
    }
  Dynamics<dim> dynamics(std::move(specimen), {0.0, time_step_safety}, ZeroForce::as_placed);
  const auto& grains = dynamics.specimen().grains;
  // Momentum lives at half steps, as velocity does; internal forces cannot change it.
  const auto momentum = [&] {
    Vector<dim> sum = Vector<dim>::Zero();
    for (std::size_t i = 0; i < grains.size(); ++i)
      sum += grains.mass[i] * at<dim>(grains.velocity, i);
    return sum;
  };
  // At half steps, with the positions of the middle of the step.
  const auto angular_momentum = [&]([[maybe_unused]] const double back) {
    Vector<3> sum = Vector<3>::Zero();
    if constexpr (dim == 3)
      for (std::size_t i = 0; i < grains.size(); ++i)
        {
          const Vector<3> v = at<3>(grains.velocity, i);
          sum += grains.mass[i] * (at<3>(grains.position, i) - back * v).cross(v) +
                 grains.moment_of_inertia[i] * at<3>(grains.spin, i);
        }
    return sum;
  };
  const Vector<dim> momentum_before = momentum();
  const Vector<3> angular_before = angular_momentum(0.0);
  Drift worst{0.0, 0.0, 0.0};
  while (dynamics.time() < until)
    {
      dynamics.step();
      worst.energy = std::max(worst.energy, std::abs(dynamics.energies().unaccounted()) / kinetic);
    }
  worst.momentum = (momentum() - momentum_before).norm() / scale;
  worst.angular_momentum = (angular_momentum(0.5 * dynamics.time_step()) - angular_before).norm() / (scale * 4e-3);
  return worst;
}

TEST(Dynamics, AnUndampedAssemblyKeepsMomentumAndEnergy)
{
  // At a tenth of the usual step energy stays within 0.1 %, and its error falls as Δt²: halving the step quarters it,
  // within the scatter of where in an oscillation the worst falls.
  const auto with = [](const double time_step_safety) {
    return drift<2>(
      small_specimen(3, 1e6),
      [](const double x) { return Vector<2>(2.0 * std::sin(12.9 * x), 2.0 * std::sin(78.2 * x)); },
      [](double) { return Rotation<2>::Zero(); }, 3e-6, time_step_safety);
  };
  const auto coarse = with(0.08);
  EXPECT_LT(coarse.momentum, 1e-13);
  EXPECT_LT(coarse.energy, 1e-3);
  EXPECT_NEAR(coarse.energy / with(0.04).energy, 4.0, 0.8);
  RecordProperty("energy_error", std::to_string(coarse.energy));
}

TEST(SpaceDynamics, AnUndampedAssemblyKeepsMomentumAngularMomentumAndEnergy)
{
  // Energy to Δt², as in the plane. Angular momentum would drift by the whole shear force times a_i if the couples
  // missed it; what is left comes from contact points that move within a step.
  const auto with = [](const double time_step_safety) {
    return drift<3>(
      small_cylinder(2, 1e6),
      [](const double x) { return Vector<3>(std::sin(12.9 * x), std::sin(78.2 * x), std::sin(37.7 * x)); },
      [](const double x) {
        return Vector<3>(1e3 * std::sin(3.1 * x), 1e3 * std::sin(5.3 * x), 1e3 * std::sin(9.7 * x));
      },
      2e-6, time_step_safety);
  };
  const auto coarse = with(0.08);
  EXPECT_LT(coarse.momentum, 1e-13);
  EXPECT_LT(coarse.angular_momentum, 1e-6);
  EXPECT_LT(coarse.energy, 1e-3);
  EXPECT_NEAR(coarse.energy / with(0.04).energy, 4.0, 1.0);
  RecordProperty("energy_error", std::to_string(coarse.energy));
  RecordProperty("angular_momentum_error", std::to_string(coarse.angular_momentum));
}

/// 20 × 20 mm leaves too few joints to be handed out, so the sweep is given a large lattice of grains of 1 mm.
template <int dim>
void expect_the_same_for_any_number_of_threads(const Components<dim>& positions, const int n_steps)
{
  std::vector<double> radii;
  for (std::size_t i = 0; i < positions[0].size(); ++i)
    radii.push_back(1e-3 * (1.0 - 0.05 * std::abs(std::sin(double(i)))));
  const auto run = [&](const std::size_t n_threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, n_threads);
    auto specimen = placed_specimen<dim>(radii, positions);
    FlatJointParameters wanted;
    wanted.installation_gap_ratio = 0.2;
    install_joints(specimen, wanted);
    EXPECT_GT(specimen.joints.size(), 20000u);
    for (std::size_t i = 0; i < specimen.grains.size(); ++i)
      specimen.grains.velocity[0][i] = 30.0 * std::sin(0.1 * double(i));
    Dynamics<dim> dynamics(std::move(specimen), {0.7, 0.8}, ZeroForce::as_placed);
    std::size_t n_broken = 0;
    for (int n = 0; n < n_steps; ++n)
      n_broken += dynamics.step().size();
    EXPECT_GT(n_broken, 100u);
    return std::pair(dynamics.specimen().grains.position, dynamics.energies().damping);
  };
  EXPECT_EQ(run(1), run(4));
}

TEST(Dynamics, IsTheSameForAnyNumberOfThreads)
{
  Components<2> positions;
  for (int row = 0; row < 120; ++row)
    for (int column = 0; column < 120; ++column)
      {
        positions[0].push_back(1e-3 * (1.0 + 2.0 * column + (row % 2)));
        positions[1].push_back(1e-3 * (1.0 + std::sqrt(3.0) * row));
      }
  expect_the_same_for_any_number_of_threads<2>(positions, 60);
}

TEST(SpaceDynamics, IsTheSameForAnyNumberOfThreads)
{
  Components<3> positions;
  for (int layer = 0; layer < 16; ++layer)
    for (int row = 0; row < 30; ++row)
      for (int column = 0; column < 30; ++column)
        {
          positions[0].push_back(1e-3 * (1.0 + 2.0 * column));
          positions[1].push_back(1e-3 * (1.0 + 2.0 * row));
          positions[2].push_back(1e-3 * (1.0 + 2.0 * layer));
        }
  expect_the_same_for_any_number_of_threads<3>(positions, 40);
}

TEST(Dynamics, ADiscThrownOnARoughWallEndsRolling)
{
  // Friction slows the centre and turns the disc until v = ωR; with I = ½mR² that is at ⅔ of the first velocity,
  // whatever the friction. Gravity of 1e6 m/s² shortens the wait.
  const double radius = 1e-3;
  const double speed = 1.0;
  auto specimen = placed_specimen({radius}, {{{0.5}, {radius}}});
  specimen.grains.velocity[0] = {speed};
  const double weight = specimen.grains.mass[0] * 1e6;
  // Placed where the wall carries the weight, so that it does not bounce.
  specimen.grains.position[1][0] -= weight / (2.0 * specimen.particle_contact.modulus * specimen.thickness);
  Dynamics<2> dynamics(std::move(specimen), {0.0, 0.2}, ZeroForce::at_touch);
  dynamics.add_wall({1, 1.0, 0.0, 0.0, 0.3});
  dynamics.set_gravity({0.0, -1e6});
  // Slides for v/(3 μ g). Rolling, the contact rocks on what shear it kept: mean over many such oscillations.
  while (dynamics.time() < 2.0 * speed / (3.0 * 0.3 * 1e6))
    dynamics.step();
  const auto& grains = dynamics.specimen().grains;
  double velocity = 0.0;
  double surface_speed = 0.0;
  constexpr int n_steps = 20000;
  for (int n = 0; n < n_steps; ++n)
    {
      dynamics.step();
      velocity += grains.velocity[0][0] / n_steps;
      surface_speed -= grains.spin[0][0] * radius / n_steps;
    }
  EXPECT_NEAR(velocity, 2.0 / 3.0 * speed, 0.01 * speed);
  EXPECT_NEAR(surface_speed, 2.0 / 3.0 * speed, 0.01 * speed);
  // A third of the kinetic energy went into friction.
  const auto energies = dynamics.energies();
  EXPECT_NEAR(energies.slip, grains.mass[0] * speed * speed / 6.0, 0.02 * grains.mass[0] * speed * speed / 6.0);
}

TEST(Dynamics, FrictionOfEachWallOpposesTheSlidingAndTurnsTheGrainAsStaticsSays)
{
  // A disc pressed on a wall by N and sliding along it: the wall's friction is μN against the motion, at an arm from the
  // centre to the contact point. Lower, upper, left and right wall, both ways.
  const double radius = 1e-3;
  const double friction = 0.3;
  for (const int axis : {0, 1})
    for (const double side : {1.0, -1.0})
      for (const double way : {1.0, -1.0})
        {
          SCOPED_TRACE(testing::Message() << "axis " << axis << ", side " << side << ", way " << way);
          const int along = 1 - axis;
          auto specimen = placed_specimen({radius}, {{{0.5}, {0.5}}});
          specimen.grains.velocity[std::size_t(along)] = {way};
          // The wall presses with 2 E t per overlap.
          const double overlap = 1e-6 * radius;
          const double pressed = 2.0 * specimen.particle_contact.modulus * specimen.thickness * overlap;
          Dynamics<2> dynamics(std::move(specimen), undamped, ZeroForce::at_touch);
          dynamics.add_wall({axis, side, 0.5 - side * (radius - overlap), 0.0, friction});
          dynamics.set_gravity(-side * pressed / dynamics.specimen().grains.mass[0] * Vector<2>::Unit(axis));
          for (int n = 0; n < 5; ++n)
            dynamics.step();
          const auto& grains = dynamics.specimen().grains;
          const Vector<2> force = at<2>(grains.force, 0);
          // Positions near 0.5 m are good to 1e-16 m, the overlap of 1e-9 m so to 1e-7.
          EXPECT_NEAR(force[axis], side * pressed, 1e-6 * pressed);
          EXPECT_NEAR(force[along], -way * friction * pressed, 1e-6 * pressed);
          const Vector<2> arm = -side * (radius - overlap) * Vector<2>::Unit(axis);
          EXPECT_NEAR(grains.couple[0][0], arm[0] * force[1] - arm[1] * force[0], 1e-9 * pressed * radius);
        }
}

TEST(Dynamics, AWallThatComesFromFarDoesNotPassThroughAGrain)
{
  // Ten radii away, far beyond what the search of the start keeps in mind, from each of the four sides. An elastic blow
  // by a wall of speed v sends a grain at rest off at 2v; the grain behind it stays at rest.
  const double radius = 1e-3;
  const double speed = 30.0;
  for (const int axis : {0, 1})
    for (const double side : {1.0, -1.0})
      {
        SCOPED_TRACE(axis);
        Dynamics<2> dynamics(placed_specimen({radius, radius, radius}, {{{0.3, 0.5, 0.7}, {0.3, 0.5, 0.7}}}),
                             {0.0, 0.05}, ZeroForce::at_touch);
        const double first = side > 0.0 ? 0.3 : 0.7;
        dynamics.add_wall({axis, side, first - 11.0 * radius * side, speed * side, 0.0});
        while (dynamics.wall(0).position * side < (first + 10.0 * radius * side) * side)
          dynamics.step();
        const auto& velocity = dynamics.specimen().grains.velocity[std::size_t(axis)];
        const std::size_t struck = side > 0.0 ? 0 : 2;
        EXPECT_NEAR(velocity[struck], 2.0 * speed * side, 1e-3 * 2.0 * speed); // (ωΔt)², Δt = 0.05/ω
        EXPECT_EQ(velocity[1], 0.0);
      }
}

TEST(Dynamics, TornFacesGoAndTheGrainsMayTouchAgain)
{
  // Pulled apart by more than the face's length and pushed back: the second contact is the linear law's, at R1 + R2.
  const double radius = 1e-3;
  auto specimen = placed_specimen({radius, radius}, {{{0.5, 0.5 + 2.0 * radius}, {0.5, 0.5}}});
  FlatJointParameters wanted;
  wanted.installation_gap_ratio = 0.1;
  install_joints(specimen, wanted);
  ASSERT_EQ(specimen.joints.size(), 1u);
  specimen.grains.velocity[0] = {-50.0, 50.0};
  Dynamics<2> dynamics(std::move(specimen), undamped, ZeroForce::as_placed);
  std::size_t n_broken = 0;
  while (dynamics.specimen().joints.size() > 0 && dynamics.n_steps() < 100000)
    n_broken += dynamics.step().size();
  EXPECT_EQ(n_broken, 4u);
  const auto& position = dynamics.specimen().grains.position[0];
  EXPECT_GT(position[1] - position[0], 4.0 * radius); // rest distance and face length, 2R each

  dynamics.specimen().grains.velocity[0] = {50.0, -50.0};
  while (dynamics.faceless_coordination_number() == 0.0 && dynamics.n_steps() < 200000)
    dynamics.step();
  EXPECT_NEAR(position[1] - position[0], 2.0 * radius, 100.0 * dynamics.time_step()); // one step of their speed
}

/// A stirred specimen; each energy is integrated on its own.
template <int dim>
void expect_energies_balance(Specimen<dim> specimen, const double speed, const double until)
{
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const auto x = double(i);
      const Vector<3> direction(std::sin(3.1 * x), std::cos(7.7 * x), std::sin(5.9 * x));
      set<dim>(specimen.grains.velocity, i, Vector<dim>(speed * direction.head<dim>()));
    }
  Dynamics<dim> dynamics(std::move(specimen), {0.2, 0.08}, ZeroForce::as_placed);
  std::size_t n_broken = 0;
  while (dynamics.time() < until)
    n_broken += dynamics.step().size();
  EXPECT_GT(n_broken, 200u);
  const auto energies = dynamics.energies();
  EXPECT_GT(energies.slip, 0.0);
  EXPECT_GT(energies.released, 0.0);
  EXPECT_GT(energies.damping, 0.0);
  // A break drops its force within one step: half that step's work, about one part in a thousand here.
  EXPECT_LT(energies.imbalance(), 0.01);
  Energies wrong = energies;
  wrong.slip *= 2.0;
  EXPECT_GT(wrong.imbalance(), 0.01);
}

TEST(Dynamics, EnergiesBalanceThroughBreakageAndSliding) { expect_energies_balance(small_specimen(2), 3.0, 2e-5); }
TEST(SpaceDynamics, EnergiesBalanceThroughBreakageAndSliding) { expect_energies_balance(small_cylinder(3), 6.0, 1e-5); }
} // namespace
} // namespace feldspar
