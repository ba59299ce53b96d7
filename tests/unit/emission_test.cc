#include "dem/genesis/genesis.h"
#include "dem/lab/cracks.h"
#include "dem/lab/emission.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "results/emission.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/taken_up.h"
#include "tests/unit/whole_tests.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace feldspar::tests
{
namespace
{
constexpr double radius = 1e-3;
constexpr double spacing = 2.0 * radius;
constexpr int n_across = 31;

/// Equal discs on a triangular lattice, jointed to their six neighbours, under a uniform strain from outside. Bonds do not
/// break.
Specimen<2> strained_lattice(const Tensor<2>& strain, const double stiffness_ratio)
{
  Components<2> positions;
  for (int row = 0; row < n_across; ++row)
    for (int column = 0; column < n_across; ++column)
      {
        positions[0].push_back(spacing * (column + 0.5 * (row % 2)));
        positions[1].push_back(spacing * std::sqrt(0.75) * row);
      }
  auto body = placed_specimen<2>(std::vector<double>(positions[0].size(), radius), positions);
  body.report.mean_radius = radius;
  body.bulk_density = 3000.0;
  FlatJointParameters flat_joint;
  flat_joint.stiffness_ratio = stiffness_ratio;
  flat_joint.bond_tensile_strength = flat_joint.bond_cohesion = 1e30;
  flat_joint.bond_friction_angle = 0.0;
  install_joints(body, flat_joint);
  auto& joints = body.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const Vector<2> normal = at<2>(joints.normal, j);
      const Vector<2> stretch = strain * normal * spacing;
      joints.opening[j] = normal.dot(stretch);
      joints.rest_distance[j] -= joints.opening[j];
      joints.slip[0][j] = stretch.dot(Vector<2>(-normal[1], normal[0]));
    }
  return body;
}

bool is_held(const std::uint32_t grain)
{
  const int row = int(grain) / n_across, column = int(grain) % n_across;
  return std::min({row, column, n_across - 1 - row, n_across - 1 - column}) < 2;
}

/// The events after the body, whose outermost grains are held, was strained by a thousandth more than it is, which breaks the
/// bonds that are wanted weak, and has come to rest.
template <typename IsWeak>
std::vector<EmissionEvent> events_of(Specimen<2>& body, const Tensor<2>& strain, const IsWeak& is_weak,
                                     const std::size_t n_breaks)
{
  auto& joints = body.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (is_weak(j))
      for (unsigned int i = 0; i < joints.n_segments; ++i)
        {
          if (joints.opening[j] > 0.0)
            joints.tensile_strength[joints.segment(i, j)] = 1.00001 * joints.normal_stiffness[j] * joints.opening[j];
          else
            joints.cohesion[joints.segment(i, j)] = 1.00001 * joints.shear_stiffness[j] * std::abs(joints.slip[0][j]);
        }
  EmissionParameters wanted;
  wanted.event_radius = 10.0; // the crack as a whole
  wanted.event_duration = 100.0;
  wanted.thickness = 1.0;
  EmissionWatch<2> watch(body, wanted);
  Dynamics<2> dynamics(body, {0.7, 0.8}, ZeroForce::as_placed);
  std::vector<std::uint32_t> held;
  for (std::uint32_t i = 0; i < body.grains.size(); ++i)
    if (is_held(i))
      held.push_back(i);
  dynamics.add_grip(held, Vector<2>::Zero());
  dynamics.step();
  for (std::uint32_t i = 0; i < body.grains.size(); ++i)
    if (!is_held(i))
      dynamics.push(i, 1e-3 / dynamics.time_step() * strain * at<2>(body.grains.position, i));
  std::vector<Crack> cracks;
  for (int n = 0; n < 2000; ++n)
    {
      const auto breaks = dynamics.step();
      const auto of_step = cracks_of(dynamics, breaks, 0.0);
      for (const CrackBetween& one : of_step)
        cracks.push_back(one.crack);
      watch.follow(dynamics, of_step, cracks);
    }
  EXPECT_EQ(cracks.size(), n_breaks);
  body = dynamics.specimen();
  return watch.catalogue(cracks, 0.0);
}

Tensor<2> moment_of(const EmissionEvent& event)
{
  Tensor<2> moment;
  moment << event.moment[0], event.moment[1], event.moment[1], event.moment[3];
  return moment;
}

TEST(Emission, OfARowOfBondsPulledApartIsThatOfAnOpeningCrack)
{
  // Central springs of stiffness k on a triangular lattice make an elastic medium with λ = μ = √3 k/4, so that an opening
  // crack with normal y has M_yy : M_xx = λ + 2μ : λ = 3 : 1.
  constexpr double pull = 1e-6;
  const Tensor<2> strain = Vector<2>(0.0, pull).asDiagonal();
  Specimen<2> body = strained_lattice(strain, 1e9);
  const double middle = 0.5 * n_across * spacing;
  const double height = spacing * std::sqrt(0.75) * (n_across / 2 + 0.5);
  std::size_t n_bonds = 0;
  const auto crosses = [&](const std::size_t j) {
    const Vector<2> one = at<2>(body.grains.position, body.joints.grain_1[j]);
    const Vector<2> two = at<2>(body.grains.position, body.joints.grain_2[j]);
    const bool weak =
      (one[1] < height) != (two[1] < height) && std::abs(0.5 * (one[0] + two[0]) - middle) < 3.6 * spacing;
    n_bonds += weak;
    return weak;
  };

  // The same springs at rest, by one linear system: a bond that is gone no longer pulls by what it did.
  const double stiffness = body.joints.normal_stiffness[0] * body.joints.face_area(0);
  const auto n = Eigen::Index(2 * body.grains.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n);
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    {
      const auto one = Eigen::Index(2 * body.joints.grain_1[j]), two = Eigen::Index(2 * body.joints.grain_2[j]);
      const Vector<2> normal = at<2>(body.joints.normal, j);
      if (crosses(j))
        {
          const Vector<2> lost = stiffness * body.joints.opening[j] * normal;
          load.segment<2>(one) -= lost;
          load.segment<2>(two) += lost;
          continue;
        }
      const Tensor<2> block = stiffness * normal * normal.transpose();
      matrix.block<2, 2>(one, one) += block;
      matrix.block<2, 2>(two, two) += block;
      matrix.block<2, 2>(one, two) -= block;
      matrix.block<2, 2>(two, one) -= block;
    }
  for (std::uint32_t i = 0; i < body.grains.size(); ++i)
    if (is_held(i))
      for (Eigen::Index row = 2 * i; row < 2 * i + 2; ++row)
        {
          matrix.row(row).setZero();
          matrix(row, row) = 1.0;
          load[row] = 0.0;
        }
  const Eigen::VectorXd moved = matrix.partialPivLu().solve(load);
  Tensor<2> expected = Tensor<2>::Zero();
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    if (crosses(j))
      {
        const Vector<2> normal = at<2>(body.joints.normal, j);
        const Vector<2> apart =
          moved.segment<2>(2 * body.joints.grain_2[j]) - moved.segment<2>(2 * body.joints.grain_1[j]);
        expected += stiffness * (body.joints.opening[j] + normal.dot(apart)) * spacing * normal * normal.transpose();
      }
  EXPECT_NEAR(expected(0, 0) / expected(1, 1), 1.0 / 3.0, 0.01 / 3.0);

  n_bonds = 0;
  const Specimen<2> before = body;
  const auto events = events_of(body, strain, crosses, 4 * 14);
  EXPECT_EQ(n_bonds, 14u);
  ASSERT_EQ(events.size(), 1u);
  const Tensor<2> moment = moment_of(events[0]);
  // Waves do not carry it beyond its rest under this damping; shear springs, 1e-9 as stiff, and residual motion are left.
  EXPECT_LT((moment - expected).norm(), 1e-4 * expected.norm());

  // The sum over the contacts around the grains of the crack (Hazzard and Young) misses most of it.
  std::vector<bool> inside(body.grains.size(), false);
  for (std::size_t j = 0; j < before.joints.size(); ++j)
    if (crosses(j))
      inside[before.joints.grain_1[j]] = inside[before.joints.grain_2[j]] = true;
  const auto around = [&](const Specimen<2>& state) {
    Tensor<2> sum = Tensor<2>::Zero();
    for (std::size_t j = 0; j < state.joints.size(); ++j)
      if (inside[state.joints.grain_1[j]] != inside[state.joints.grain_2[j]])
        {
          const Vector<2> one = at<2>(state.grains.position, state.joints.grain_1[j]);
          const Vector<2> two = at<2>(state.grains.position, state.joints.grain_2[j]);
          const Vector<2> on_two = at<2>(state.joints.force, j);
          sum += (inside[state.joints.grain_1[j]] ? 1.0 : -1.0) * on_two * (0.5 * (one + two)).transpose();
        }
    return sum;
  };
  Specimen<2> loaded = before;
  sweep_joints(loaded.joints, loaded.grains, 0.0);
  const Tensor<2> sum = around(body) - around(loaded);
  EXPECT_NEAR(sum(1, 1) / moment(1, 1), 0.13, 0.01);
  EXPECT_NEAR(sum(0, 0) / moment(0, 0), 0.22, 0.01);
}

TEST(Emission, OfASlidingBondIsADoubleCouple)
{
  Tensor<2> strain;
  strain << 0.0, 1e-6, 1e-6, 0.0;
  Specimen<2> body = strained_lattice(strain, 1.25);
  const auto one = std::uint32_t(n_across * (n_across / 2) + n_across / 2); // and the next to its right
  const auto events = events_of(
    body, strain,
    [&](const std::size_t j) { return body.joints.grain_1[j] == one && body.joints.grain_2[j] == one + 1; }, 4);
  ASSERT_EQ(events.size(), 1u);
  const Tensor<2> moment = moment_of(events[0]);
  EXPECT_EQ(events[0].n_shear, 4u);
  EXPECT_GT(moment(0, 1), 0.0);
  EXPECT_NEAR(moment(0, 0), 0.0, 0.1 * moment(0, 1));
  EXPECT_NEAR(moment(1, 1), 0.0, 0.1 * moment(0, 1));
}

TestOutcome pressed(const EmissionParameters& emission)
{
  TestParameters wanted = quick_compression();
  wanted.stop_strain = 8e-3;
  wanted.of<EmissionParameters>() = emission;
  return outcome_of<2>({uniaxial_compression}, small_specimen(), wanted);
}

template <int dim>
void expect_dipole_of_one_bond()
{
  // Two grains that are drawn apart: a bond with the stress k_n g would carry k_n g A, which it does not once it has broken.
  Components<dim> positions;
  for (auto& component : positions)
    component = {0.5, 0.5};
  positions[0][1] += spacing;
  auto body = placed_specimen<dim>({radius, radius}, positions);
  body.report.mean_radius = radius;
  body.bulk_density = 3000.0;
  FlatJointParameters flat_joint;
  flat_joint.bond_tensile_strength_deviation = flat_joint.bond_cohesion_deviation = 0.0;
  install_joints(body, flat_joint);
  EmissionWatch<dim> watch(body, {1.0, 1.0, 1.0});
  Dynamics<dim> dynamics(body, {0.7, 0.8}, ZeroForce::as_placed);
  dynamics.add_grip({0}, Vector<dim>::Zero());
  dynamics.add_grip({1}, 0.1 * Vector<dim>::Unit(0));
  std::vector<Crack> cracks;
  double last = 0.0; // opening at the last step of the event
  double break_time = 0.0;
  bool has_ended = false;
  const double shear_speed = std::sqrt(body.particle_contact.modulus / 2.5 / body.bulk_density);
  for (int n = 0; n < 2000; ++n)
    {
      const auto breaks = dynamics.step();
      const auto of_step = cracks_of(dynamics, breaks, 0.0);
      for (const CrackBetween& one : of_step)
        cracks.push_back(one.crack);
      watch.follow(dynamics, of_step, cracks);
      if (!breaks.empty())
        break_time = dynamics.time();
      // The breaks lie around the middle of the face, whose half length is added to the radius of an event of one.
      const double farthest = dim == 2 ? 0.75 * radius : radius / std::sqrt(2.0);
      if (!cracks.empty() && !has_ended) // it is measured when it has just ended, too
        {
          last = dynamics.specimen().joints.opening[0];
          has_ended = dynamics.time() - break_time > (spacing + farthest) / shear_speed;
        }
    }
  const auto events = watch.catalogue(cracks, 0.0);
  ASSERT_EQ(events.size(), 1u);
  const double expected = body.joints.normal_stiffness[0] * body.joints.face_area(0) * last * (spacing + last);
  EXPECT_NEAR(events[0].moment[0], expected, 1e-2 * expected);
  for (std::size_t k = 1; k < 6; ++k)
    EXPECT_NEAR(events[0].moment[k], 0.0, 1e-9 * expected);
}

TEST(Emission, OfOneBondPulledApartIsADipole)
{
  expect_dipole_of_one_bond<2>();
  expect_dipole_of_one_bond<3>();
}

TEST(Emission, OfAPressedParallelBondHasAllThatItCarried)
{
  // The bond is pressed and sheared to its break, and goes as a whole: f = k_n A U_n n + k_s A U_s t on grain 2.
  auto body = placed_specimen<2>({radius, radius}, {{{0.5, 0.5 + spacing}, {0.5, 0.5}}});
  body.report.mean_radius = radius;
  body.bulk_density = 3000.0;
  ParallelBondParameters bond;
  bond.bond_cohesion = 10e6;
  bond.bond_cohesion_deviation = 0.0;
  install_joints(body, bond);
  EmissionWatch<2> watch(body, {1.0, 1e-9, 1.0}); // ends, and is measured, in the step after the break
  Dynamics<2> dynamics(body, {0.7, 0.8}, ZeroForce::as_placed);
  dynamics.add_grip({0}, Vector<2>::Zero());
  dynamics.add_grip({1}, {-0.02, 0.1});
  std::vector<Crack> cracks;
  double across = 0.0, along = 0.0;
  int step_of_break = -2;
  for (int n = 0; n < 2000; ++n)
    {
      const auto breaks = dynamics.step();
      const auto& joints = dynamics.specimen().joints;
      if (n == step_of_break + 1)
        {
          across = joints.normal_stiffness[0] * joints.face_area(0) * joints.opening[0];
          along = joints.shear_stiffness[0] * joints.face_area(0) * joints.slip[0][0];
        }
      const auto of_step = cracks_of(dynamics, breaks, 0.0);
      if (!breaks.empty())
        {
          step_of_break = n;
          cracks.push_back(of_step.front().crack);
        }
      watch.follow(dynamics, of_step, cracks);
    }
  const auto events = watch.catalogue(cracks, 0.0);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].n_shear, 1u);
  EXPECT_LT(across, 0.0);
  const double tolerance = 1e-2 * std::abs(along) * spacing; // the branch has turned by strains
  EXPECT_NEAR(events[0].moment[0], across * spacing, tolerance);
  EXPECT_NEAR(events[0].moment[1], 0.5 * along * spacing, tolerance);
}

TEST(Emission, OfATestHasEveryBreakAndItsEnergyOnce)
{
  const TestOutcome outcome = pressed({});
  const auto& cracks = outcome.record.cracks;
  const auto& events = outcome.record.events;
  ASSERT_GT(cracks.size(), 100u);
  ASSERT_GT(events.size(), 20u);
  EXPECT_LT(events.size(), cracks.size());
  std::vector<std::uint64_t> n_breaks(events.size(), 0);
  double released = 0.0;
  for (const Crack& crack : cracks)
    {
      ASSERT_GE(crack.event, 1u);
      ASSERT_LE(crack.event, events.size());
      ++n_breaks[crack.event - 1];
      released += crack.released_energy;
    }
  double in_events = 0.0;
  for (std::size_t k = 0; k < events.size(); ++k)
    {
      EXPECT_EQ(events[k].number, k + 1);
      EXPECT_EQ(events[k].n_breaks(), n_breaks[k]);
      EXPECT_GE(events[k].time, events[k > 0 ? k - 1 : 0].time);
      in_events += events[k].released_energy;
    }
  // A plane body is 1 m thick where it is computed, and as thick as it is wide, 12 mm, in its catalogue.
  EXPECT_NEAR(in_events, 0.012 * released, 1e-12 * released);

  const TestOutcome thin = pressed({1.0, 2.0, 0.006});
  ASSERT_EQ(thin.record.events.size(), events.size());
  for (std::size_t k = 0; k < events.size(); ++k)
    {
      EXPECT_DOUBLE_EQ(thin.record.events[k].released_energy, 0.5 * events[k].released_energy);
      EXPECT_DOUBLE_EQ(thin.record.events[k].moment[3], 0.5 * events[k].moment[3]);
    }
  // Each break is an event of its own if nothing is near it in time.
  const TestOutcome apart = pressed({1e-9, 1e-9, {}});
  EXPECT_EQ(apart.record.events.size(), cracks.size());
}

TEST(Emission, IsTakenUpAgainToTheSameBits)
{
  TestParameters wanted = quick_compression();
  wanted.stop_strain = 8e-3;
  auto [whole, resumed] =
    whole_and_taken_up([&] { return LabTest<2>({uniaxial_compression}, small_specimen(), wanted, {}); });
  const auto expected = whole.finish(false).record.events, events = resumed.finish(false).record.events;
  ASSERT_GT(expected.size(), 20u);
  ASSERT_EQ(events.size(), expected.size());
  for (std::size_t k = 0; k < events.size(); ++k)
    {
      EXPECT_EQ(events[k].moment, expected[k].moment);
      EXPECT_EQ(events[k].time, expected[k].time);
      EXPECT_EQ(events[k].extent, expected[k].extent);
    }
}

TEST(Emission, MechanismsAreThoseOfTheirTensors)
{
  // An opening crack with λ = μ: 3 : 1 : 1. M_0 = √(11/2); isotropic 5/3, CLVD 2/3 (3 + 1 − 2) = 4/3 of 3 (Vavryčuk 2015).
  EmissionEvent event;
  event.moment = {1.0, 0.0, 0.0, 3.0, 0.0, 1.0};
  SourceMechanism source = mechanism(event, 3);
  EXPECT_DOUBLE_EQ(source.scalar_moment, std::sqrt(5.5));
  EXPECT_DOUBLE_EQ(source.magnitude, std::log10(std::sqrt(5.5)) / 1.5 - 6.07);
  EXPECT_NEAR(source.isotropic, 5.0 / 9.0, 1e-15);
  EXPECT_NEAR(source.clvd, 4.0 / 9.0, 1e-15);
  EXPECT_NEAR(source.double_couple, 0.0, 1e-15);
  EXPECT_EQ(source.kind, "tensile");          // 5/(5 + 8/3) = 65 %
  HudsonPlace place = hudson_place(event, 3); // −⅔ (3 + 1 − 2)/3, ⅓·5/3
  EXPECT_NEAR(place.u, -4.0 / 9.0, 1e-15);
  EXPECT_NEAR(place.v, 5.0 / 9.0, 1e-15);

  event.moment = {0.0, 0.0, 2.0, 0.0, 0.0, 0.0}; // a slip in xz
  source = mechanism(event, 3);
  EXPECT_DOUBLE_EQ(source.scalar_moment, 2.0);
  EXPECT_NEAR(source.double_couple, 1.0, 1e-15);
  EXPECT_EQ(source.kind, "shear");
  place = hudson_place(event, 3);
  EXPECT_NEAR(std::hypot(place.u, place.v), 0.0, 1e-15);

  // In the plane the third eigenvalue, 2, is the mean of the others.
  event.moment = {-1.0, 0.0, 0.0, -3.0, 0.0, 0.0};
  source = mechanism(event, 2);
  EXPECT_DOUBLE_EQ(source.scalar_moment, std::sqrt(5.0));
  EXPECT_NEAR(source.clvd, 0.0, 1e-15);
  EXPECT_NEAR(source.isotropic, -2.0 / 3.0, 1e-15);
  EXPECT_EQ(source.kind, "implosive");
  place = hudson_place(event, 2);
  EXPECT_NEAR(place.u, 0.0, 1e-15);
  EXPECT_NEAR(place.v, -2.0 / 3.0, 1e-15);

  EXPECT_EQ(mechanism({}, 2).kind, "");
  EXPECT_TRUE(std::isnan(mechanism({}, 2).magnitude));
}

TEST(Emission, BValuesAreThoseOfTheDistributionThatIsDrawn)
{
  // Magnitudes above −8 with b = 1.2 by inversion; 4 000 of them have a standard error of b/√n = 0.019.
  Random random(1, RandomStream::positions);
  std::vector<double> magnitudes;
  for (int k = 0; k < 4000; ++k)
    magnitudes.push_back(-8.0 - std::log10(random.uniform(1e-9, 1.0)) / 1.2);
  const auto frequency = magnitude_frequency(magnitudes);
  ASSERT_TRUE(frequency);
  EXPECT_EQ(frequency->completeness, -8.0);
  EXPECT_EQ(frequency->n, 4000u);
  EXPECT_NEAR(frequency->b, 1.2, 3.0 * 0.019);
  EXPECT_NEAR(frequency->error, 1.2 / std::sqrt(4000.0), 0.002);
  EXPECT_NEAR(frequency->b_positive, 1.2, 3.0 * 1.2 / std::sqrt(2000.0)); // half of the steps rise
  magnitudes.resize(29);
  EXPECT_FALSE(magnitude_frequency(magnitudes));
}

// A laboratory's amplitudes come in whole decibels, 0.05 of a magnitude. Without half a step b would be 1.2/(1 − 1.2 · 0.025 ln 10)
// = 1.29, seven standard errors too high, and b-positive as much too low.
TEST(Emission, BValuesOfWholeDecibelsAreThoseOfTheDistribution)
{
  constexpr double step = 0.05;
  Random random(1, RandomStream::positions);
  EmissionCatalogue catalogue;
  for (int k = 0; k < 10000; ++k)
    {
      const double amplitude = std::round((2.0 - 0.5 * step - std::log10(random.uniform(1e-9, 1.0)) / 1.2) / step);
      catalogue.events.push_back({.stress = double(k), .magnitude = amplitude / 20.0});
    }
  EXPECT_NEAR(catalogue.step(), step, 1e-9);
  const auto magnitudes = catalogue.magnitudes_to_peak();
  const auto frequency = magnitude_frequency(magnitudes, catalogue.step());
  ASSERT_TRUE(frequency);
  EXPECT_NEAR(frequency->completeness, 2.0 - 0.5 * step, 1e-9);
  EXPECT_EQ(frequency->n, 10000u);
  EXPECT_NEAR(frequency->b, 1.2, 3.0 * 0.012);
  EXPECT_NEAR(frequency->b_positive, 1.2, 3.0 * 1.2 / std::sqrt(5000.0));

  catalogue.events[7000].stress = 20000.0; // the peak
  EXPECT_EQ(catalogue.magnitudes_to_peak().size(), 7001u);
  catalogue.events.front().stress = std::numeric_limits<double>::quiet_NaN(); // no column of a stress
  EXPECT_EQ(catalogue.magnitudes_to_peak().size(), 10000u);
}
} // namespace
} // namespace feldspar::tests
