// Smooth joints: one against closed forms, pairs, planes through specimens, mineral grains; files and resumed tests.

#include "base/input_error.h"
#include "dem/dynamics/dynamics.h"
#include "dem/dynamics/sweeps/smooth_sweep.h"
#include "dem/flaws/apply.h"
#include "dem/flaws/mineral_grains.h"
#include "dem/flaws/smooth_planes.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/fragments.h"
#include "dem/specimen/specimen_file.h"
#include "dem/specimen/specimen_part.h"
#include "laboratory/compression.h"
#include "results/evaluation.h"
#include "tests/temporary_folder.h"
#include "tests/unit/same_bits.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/taken_up.h"
#include "tests/unit/whole_tests.h"
#include "tests/words.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

namespace feldspar
{
namespace
{
using tests::has;

constexpr double degree = std::numbers::pi / 180.0;

SmoothJointParameters test_plane()
{
  SmoothJointParameters wanted;
  wanted.normal_stiffness = 50e12;
  wanted.shear_stiffness = 20e12;
  wanted.friction = 0.6;
  wanted.dilation_angle = 10.0 * degree;
  wanted.tensile_strength = 4e6;
  wanted.cohesion = 9e6;
  wanted.friction_angle = 35.0 * degree;
  return wanted;
}

/// Leads one along a path of opening and slip, in steps; sums what was put in by the trapezoid of its stresses.
struct Driven
{
  smooth_joint::Face face;
  smooth_joint::State<2> state;
  double work = 0.0, released = 0.0, slipped = 0.0; ///< [J/m²]
  int n_tension = 0, n_shear = 0;

  void lead(const double opening, const double slip, const int n = 1000)
  {
    for (int k = 0; k < n; ++k)
      {
        const double sigma = smooth_joint::normal_stress(face, state);
        const auto update = smooth_joint::update<2>(face, state, opening / n, {slip / n});
        work += 0.5 * (sigma + smooth_joint::normal_stress(face, update.state)) * opening / n;
        work -= 0.5 * (state.shear_stress[0] + update.state.shear_stress[0]) * slip / n;
        released += update.released_energy;
        slipped += update.slip_energy;
        n_tension += update.tension_break;
        n_shear += update.shear_break;
        state = update.state;
      }
  }
};

Driven driven(const SmoothJointParameters& wanted, const bool bonded)
{
  return {smooth_joint::face(wanted), {0.0, {0.0}, bonded}};
}

TEST(SmoothJoint, PulledBearsItsTensileStrengthThenNothing)
{
  const auto wanted = test_plane();
  Driven joint = driven(wanted, true);
  const double critical = wanted.tensile_strength / wanted.normal_stiffness;
  joint.lead(0.999 * critical, 0.0);
  EXPECT_NEAR(smooth_joint::normal_stress(joint.face, joint.state), 0.999 * wanted.tensile_strength, 1.0);
  joint.lead(0.002 * critical, 0.0);
  EXPECT_EQ(joint.n_tension, 1);
  EXPECT_EQ(smooth_joint::normal_stress(joint.face, joint.state), 0.0);
  EXPECT_NEAR(joint.released, 0.5 * wanted.tensile_strength * critical, 1e-4 * joint.released);
  // Closed again it presses from where it lay, and carries no tension any more.
  joint.lead(-2.0 * critical, 0.0);
  EXPECT_NEAR(smooth_joint::normal_stress(joint.face, joint.state), -0.999 * wanted.tensile_strength, 1e-9 * 4e6);
  joint.lead(2.0 * critical, 0.0);
  EXPECT_EQ(smooth_joint::normal_stress(joint.face, joint.state), 0.0);
  EXPECT_EQ(joint.n_tension, 1);
}

TEST(SmoothJoint, ShearedUnderPressureBearsCoulombsStrengthThenSlidesAndDilates)
{
  const auto wanted = test_plane();
  Driven joint = driven(wanted, true);
  const double pressure = 12e6;
  joint.lead(-pressure / wanted.normal_stiffness, 0.0);
  const double strength = wanted.cohesion + pressure * std::tan(*wanted.friction_angle);
  joint.lead(0.0, 0.9999 * strength / wanted.shear_stiffness, 100000);
  EXPECT_EQ(joint.n_shear, 0);
  EXPECT_NEAR(joint.state.shear_stress[0], -0.9999 * strength, 1e-6 * strength);
  joint.lead(0.0, 0.0002 * strength / wanted.shear_stiffness, 2);
  EXPECT_EQ(joint.n_shear, 1);
  EXPECT_NEAR(joint.state.shear_stress[0], -wanted.friction * pressure, 1e-3 * strength);
  // The fall from the strength to friction lets go what was stored between them; one step of slip adds its work.
  const double fallen = strength * strength - std::pow(wanted.friction * pressure, 2);
  EXPECT_NEAR(joint.released, 0.5 * fallen / wanted.shear_stiffness, 2e-3 * joint.released);

  // Held at its height, sliding by s raises the pressure by k_n s tan ψ: |τ| = μ (p + k_n s tan ψ), u = s + |Δτ|/k_s.
  const double before = joint.state.shear_stress[0];
  const double slip = 2e-6;
  joint.lead(0.0, slip);
  const double stiffening = wanted.friction * wanted.normal_stiffness * std::tan(wanted.dilation_angle);
  const double s = slip / (1.0 + stiffening / wanted.shear_stiffness);
  EXPECT_NEAR(-joint.state.shear_stress[0], -before + stiffening * s, 1e-9 * strength);
  EXPECT_NEAR(-smooth_joint::normal_stress(joint.face, joint.state),
              pressure + wanted.normal_stiffness * std::tan(wanted.dilation_angle) * s, 1e-3 * pressure);

  // Work put in is stored, released or dissipated by slip.
  joint.lead(1e-5, 3e-6);
  EXPECT_EQ(smooth_joint::normal_stress(joint.face, joint.state), 0.0);
  EXPECT_EQ(joint.state.shear_stress[0], 0.0);
  const double stored = smooth_joint::stored_energy(joint.face, joint.state);
  // Only the step in which it opens is not of one piece: its trapezoid is off by half of k_n g_old g_new.
  EXPECT_NEAR(joint.work, stored + joint.released + joint.slipped, 1e-3 * joint.work);
  EXPECT_GT(joint.slipped, 0.0);
}

TEST(SmoothJoint, AtConstantPressureItOpensByTheTangentOfItsDilation)
{
  const auto wanted = test_plane();
  Driven joint = driven(wanted, false);
  const double pressure = 5e6;
  joint.lead(-pressure / wanted.normal_stiffness, 0.0);
  double opened = 0.0;
  double slid = 0.0;
  for (int k = 0; k < 4000; ++k)
    {
      // Lets the sides open by what would bring the pressure back.
      const double rise = -smooth_joint::normal_stress(joint.face, joint.state) - pressure;
      joint.lead(rise / wanted.normal_stiffness, 1e-9, 1);
      opened += rise / wanted.normal_stiffness;
      slid += 1e-9;
    }
  const double elastic = wanted.friction * pressure / wanted.shear_stiffness;
  EXPECT_NEAR(opened / (slid - elastic), std::tan(wanted.dilation_angle), 1e-3);
}

TEST(SmoothJoint, ASteeperDilationThanItsFrictionIsRefused)
{
  SmoothJointParameters wanted = test_plane();
  wanted.dilation_angle = 30.9 * degree; // atan 0.6 = 30.96°
  EXPECT_EQ(objection(wanted), "");
  wanted.dilation_angle = 31.1 * degree;
  EXPECT_TRUE(has(objection(wanted), "at most the angle of friction"));
}

template <typename>
using SmoothPair = testing::Test;
TYPED_TEST_SUITE(SmoothPair, Dimensions);

/// Two unequal grains in contact, and a plane across them that does not lie square to their branch.
template <int dim>
Specimen<dim> pair_on_a_plane(const SmoothJointParameters& wanted, const bool bonded)
{
  const double radius_1 = 1e-3;
  const double radius_2 = 0.7e-3;
  Components<dim> positions;
  for (int c = 0; c < dim; ++c)
    positions[c] = {0.5, c == 0 ? 0.5 + radius_1 + radius_2 : 0.5};
  Specimen<dim> specimen = placed_specimen<dim>({radius_1, radius_2}, positions);
  FlatJointParameters flat_joint;
  flat_joint.installation_gap_ratio = 1e-6;
  install_joints(specimen, flat_joint);
  Vector<dim> normal = Vector<dim>::Zero();
  normal[0] = -0.8; // turned to the side of grain 2 by itself
  normal[dim - 1] = -0.6;
  put_smooth_joints<dim>(specimen, {{0, normal, 1e-6}}, wanted, bonded);
  return specimen;
}

TYPED_TEST(SmoothPair, ActsAlongItsPlaneAndGivesNoMomentToThePair)
{
  constexpr int dim = TypeParam::value;
  auto specimen = pair_on_a_plane<dim>(test_plane(), true);
  ASSERT_EQ(specimen.smooth_joints.size(), 1u);
  EXPECT_EQ(specimen.joints.size(), 0u);
  auto& joint = specimen.smooth_joints.front();
  EXPECT_DOUBLE_EQ(joint.normal[0], 0.8);
  // Grain 2 goes by 10 nm along its branch, which is 8 nm across the plane and 6 nm along it.
  specimen.grains.position[0][1] += 1e-8;
  EXPECT_TRUE(sweep_smooth_joints(specimen, 0.0).empty());
  EXPECT_NEAR(joint.opening, 8e-9, 1e-14);
  const Vector<dim> force = Eigen::Map<const Vector<dim>>(joint.force.data());
  const Vector<dim> normal = Eigen::Map<const Vector<dim>>(joint.normal.data());
  EXPECT_NEAR(force.dot(normal), -50e12 * 8e-9 * 1e-6, 1e-6); // -k_n U_n A: pulled back
  const Vector<dim> along = force - force.dot(normal) * normal;
  EXPECT_NEAR(along.norm(), 20e12 * 6e-9 * 1e-6, 1e-6); // k_s U_s A
  EXPECT_LT(force[0], 0.0);
  // Forces at one point, x_1 + s d, and no moment: the couples on both grains and that of the two forces cancel.
  specimen.grains.spin[0][0] = 1e-6;
  sweep_smooth_joints(specimen, 1.0);
  const Vector<dim> branch = Eigen::Map<const Vector<dim>>(joint.branch.data());
  const Vector<dim> f = Eigen::Map<const Vector<dim>>(joint.force.data());
  if constexpr (dim == 2)
    {
      EXPECT_NEAR(joint.couple_1[0] + joint.couple_2[0] + branch[0] * f[1] - branch[1] * f[0], 0.0,
                  1e-12 * f.norm() * branch.norm());
      EXPECT_NEAR(joint.couple_1[0] / joint.couple_2[0], 1.0 / 0.7, 1e-3); // arms as the radii
    }
  else
    {
      const Vector<3> couples(joint.couple_1[0] + joint.couple_2[0], joint.couple_1[1] + joint.couple_2[1],
                              joint.couple_1[2] + joint.couple_2[2]);
      EXPECT_LT((couples + branch.cross(f)).norm(), 1e-12 * f.norm() * branch.norm());
    }
}

TYPED_TEST(SmoothPair, ARigidTurnStressesNothing)
{
  constexpr int dim = TypeParam::value;
  auto specimen = pair_on_a_plane<dim>(test_plane(), true);
  auto& grains = specimen.grains;
  auto& joint = specimen.smooth_joints.front();
  const Vector<dim> middle = 0.5 * (at<dim>(grains.position, 0) + at<dim>(grains.position, 1));
  const double turn = 1e-5;
  grains.spin.back().assign(2, turn); // about the last axis
  for (int k = 0; k < 20000; ++k)
    {
      for (std::size_t i = 0; i < 2; ++i)
        {
          const Vector<dim> arm = at<dim>(grains.position, i) - middle;
          grains.position[0][i] = middle[0] + std::cos(turn) * arm[0] - std::sin(turn) * arm[1];
          grains.position[1][i] = middle[1] + std::sin(turn) * arm[0] + std::cos(turn) * arm[1];
        }
      ASSERT_TRUE(sweep_smooth_joints(specimen, 1.0).empty());
    }
  // The pair has turned by 11.5°; the third order of each step is left: 20000 × 1e-15 / 12 of 1.7 mm.
  EXPECT_LT(std::abs(smooth_joint::normal_stress(joint.face, joint.state)), 1e-3 * joint.face.bond.tensile_strength);
  EXPECT_LT(std::abs(joint.state.shear_stress[0]), 1e-3 * joint.face.bond.cohesion);
}

TYPED_TEST(SmoothPair, SwingsWithoutLossAndPassesOverWithoutTouching)
{
  constexpr int dim = TypeParam::value;
  SmoothJointParameters wanted = test_plane();
  wanted.friction = wanted.dilation_angle = 0.0;
  auto specimen = pair_on_a_plane<dim>(wanted, true);
  Dynamics<dim> dynamics(specimen, {0.0, 0.8}, ZeroForce::as_placed);
  Vector<dim> push = Vector<dim>::Zero();
  push[0] = 1e-3;
  push[1] = 5e-4;
  dynamics.push(1, push);
  const double put_in = dynamics.energies().kinetic;
  for (int k = 0; k < 2000; ++k)
    dynamics.step();
  const Energies energies = dynamics.energies();
  EXPECT_LT(std::abs(energies.unaccounted()), 0.01 * put_in);
  EXPECT_EQ(energies.slip, 0.0);

  // Without a bond or friction grain 2 goes along the plane past grain 1: discs would hook at once, as the plane leads
  // towards grain 1 at 37°.
  Dynamics<dim> sliding(pair_on_a_plane<dim>(wanted, false), {0.0, 0.8}, ZeroForce::as_placed);
  Vector<dim> along = Vector<dim>::Zero();
  along[0] = -0.6;
  along[dim - 1] = 0.8;
  sliding.push(1, 0.1 * along);
  for (int k = 0; k < 40000 && sliding.time() < 1e-2; ++k)
    sliding.step();
  const auto& moved = sliding.specimen();
  EXPECT_NEAR(at<dim>(moved.grains.velocity, 1).dot(along), 0.1, 1e-9);
  EXPECT_EQ(sliding.faceless_coordination_number(), 0.0);
}

TYPED_TEST(SmoothPair, ThatRollsOpenTouchesFromWhereItsGrainsStand)
{
  constexpr int dim = TypeParam::value;
  SmoothJointParameters wanted = test_plane();
  wanted.friction = wanted.dilation_angle = 0.0;
  auto specimen = pair_on_a_plane<dim>(wanted, false);
  // Both spin so that the sides roll apart by some 0.6 × 1000 rad/s × 1.6 mm each second, while grain 2 comes nearer by
  // 0.1 m/s. The joint ends when the sides are a sum of radii apart, after some 2 ms; the grains overlap by 0.2 mm then.
  // A contact that began at the sum of radii would store ½ k (0.2 mm)² at once, a million times the energy of the
  // motion.
  specimen.grains.spin.at(dim == 2 ? 0 : 1).assign(2, dim == 2 ? -1000.0 : 1000.0);
  Dynamics<dim> dynamics(specimen, {0.0, 0.05}, ZeroForce::as_placed);
  dynamics.push(1, -0.1 * Vector<dim>::Unit(0));
  const double put_in = dynamics.energies().kinetic;
  double nearest = 1.0;
  while (dynamics.time() < 6e-3)
    {
      dynamics.step();
      nearest =
        std::min(nearest, dynamics.specimen().grains.position[0][1] - dynamics.specimen().grains.position[0][0]);
    }
  EXPECT_TRUE(dynamics.specimen().smooth_joints.empty());
  EXPECT_LT(nearest, 1.6e-3);
  EXPECT_GT(nearest, 1.3e-3) << "they bounce soon after the joint has ended";
  // The bounce is elastic: a hundredth for the steps in which it begins and ends between two times, of some forty.
  EXPECT_NEAR(dynamics.energies().kinetic, put_in, 0.01 * put_in);
  EXPECT_LT(std::abs(dynamics.energies().unaccounted()), 0.01 * put_in);
  const double apart = dynamics.specimen().grains.velocity[0][1] - dynamics.specimen().grains.velocity[0][0];
  EXPECT_NEAR(apart, 0.1, 0.001);
}

TYPED_TEST(SmoothPair, EndsWhereItsGrainsHaveLostEachOtherUnlessAlongAFlaw)
{
  constexpr int dim = TypeParam::value;
  for (const bool along_flaw : {false, true})
    {
      auto specimen = pair_on_a_plane<dim>(test_plane(), false);
      if (along_flaw)
        specimen.kept_apart = {{0, 1}};
      Dynamics<dim> dynamics(specimen, {0.0, 0.8}, ZeroForce::as_placed);
      dynamics.push(1, 0.1 * Vector<dim>::Unit(0));
      // Apart by the smaller radius after 7 ms; the sides are open by 0.8 of it, less than the sum of radii.
      while (dynamics.time() < 6.9e-3)
        dynamics.step();
      EXPECT_EQ(dynamics.specimen().smooth_joints.size(), 1u);
      while (dynamics.time() < 9e-3) // contacts are searched for after a way of some tenths of a radius
        dynamics.step();
      EXPECT_EQ(dynamics.specimen().smooth_joints.size(), along_flaw ? 1u : 0u);
    }
}

/// A plane through a specimen of flat joints that hold, its halves like blocks.
Specimen<2> halves(const SmoothSides& sides, const double width, const double height, const double angle)
{
  auto specimen = granite_box(width, height, strengthened(FlatJointParameters(), 100.0));
  const Vector<2> half = 0.5 * width * Vector<2>(1.0, std::tan(angle));
  const Vector<2> middle = 0.5 * specimen.size;
  put_in_flaws(specimen, {ClosedFlaw{{middle - half, middle + half}, sides}});
  return specimen;
}

TEST(SmoothPlane, SlidesInTheShearBoxByCoulombsLawAndDilatesByItsAngle)
{
  SmoothSides sides;
  sides.friction = 0.6;
  sides.dilation_angle = 8.0 * degree;
  const Specimen<2> specimen = halves(sides, 0.020, 0.012, 0.0);
  double area = 0.0;
  for (const auto& joint : specimen.smooth_joints)
    area += joint.area;
  EXPECT_NEAR(area, 0.020, 1e-12) << "the faces share the plane";
  TestParameters wanted;
  wanted.of<ShearParameters>().strain_rate = 0.2;
  wanted.stop_strain = 0.001;
  for (const double normal_stress : {2e6, 8e6})
    {
      const TestOutcome outcome = tests::outcome_of<2>({direct_shear, normal_stress}, specimen, wanted);
      ASSERT_EQ(outcome.record.failure, "");
      EXPECT_NEAR(tests::highest_stress(outcome.record), 0.6 * normal_stress, 0.01 * 0.6 * normal_stress);
      EXPECT_TRUE(outcome.record.cracks.empty());
      // Means of the upper half over those of the lower, from the first row in which all of the plane slides.
      const auto apart = [&](const int c, const Snapshot& snapshot) {
        std::array<double, 2> sum{}, n{};
        for (std::size_t i = 0; i < specimen.grains.size(); ++i)
          {
            const std::size_t upper = specimen.grains.position[1][i] > 0.006;
            sum[upper] += snapshot.position[c][i];
            n[upper] += 1.0;
          }
        return sum[1] / n[1] - sum[0] / n[0];
      };
      const auto& shots = outcome.appearance.snapshots;
      const Snapshot& first = shots[shots.size() / 3];
      const double slid = apart(0, shots.back()) - apart(0, first);
      const double opened = apart(1, shots.back()) - apart(1, first);
      EXPECT_GT(slid, 5e-6);
      EXPECT_NEAR(opened / slid, std::tan(8.0 * degree), 0.05 * std::tan(8.0 * degree));
      // The same read off the curve; means of grains are off by what the halves turn.
      const Figure dilation = evaluate(outcome.record).dilation_angle;
      ASSERT_TRUE(dilation.value) << dilation.reason;
      EXPECT_NEAR(*dilation.value, 8.0 * degree, 0.02 * 8.0 * degree);
    }
}

struct PlaneInStiffRock
{
  SmoothSides sides;
  Specimen<2> specimen;
  TestParameters wanted;
};

/// A plane that dilates by 8 deg in the shear box, in rock of 0.2 GPa/mm around it.
PlaneInStiffRock plane_in_stiff_rock()
{
  SmoothSides sides;
  sides.friction = 0.6;
  sides.dilation_angle = 8.0 * degree;
  sides.normal_stiffness = 50e12;
  TestParameters wanted;
  wanted.of<ShearParameters>().strain_rate = 0.2;
  wanted.stop_strain = 0.001;
  wanted.of<ShearParameters>().normal_stiffness = 0.2e12;
  return {sides, halves(sides, 0.020, 0.012, 0.0), wanted};
}

TEST(SmoothPlane, IsPressedBackAsItDilatesByTheStiffnessOfTheRockAround)
{
  const auto [sides, specimen, wanted] = plane_in_stiff_rock();
  constexpr double normal_stress = 2e6;
  const TestOutcome outcome = tests::outcome_of<2>({direct_shear, normal_stress}, specimen, wanted);
  ASSERT_EQ(outcome.record.failure, "");
  const auto& curve = outcome.record.curve;
  const std::size_t first = curve.size() / 3; // all of the plane slides
  for (std::size_t k = first; k < curve.size(); ++k)
    EXPECT_NEAR(direct_shear.kind.stress(curve[k]) / -curve[k].lateral_stress, 0.6, 0.01 * 0.6) << k;

  // The way of the platens is what the plane opens less what halves and plane are pressed together:
  // dσ_n = K (tan ψ du - dσ_n c). Halves of such grains have a modulus of 60 to 70 GPa: 3 % of the 4 % that K c is.
  const double compliance = 0.012 / 65e9 + 1.0 / *sides.normal_stiffness;
  const double growth = *wanted.of<ShearParameters>().normal_stiffness * std::tan(8.0 * degree) /
                        (1.0 + *wanted.of<ShearParameters>().normal_stiffness * compliance);
  const double slid = 0.020 * (direct_shear.kind.strain(curve.back()) - direct_shear.kind.strain(curve[first]));
  EXPECT_GT(-curve.back().lateral_stress, 1.2 * normal_stress);
  EXPECT_NEAR((curve[first].lateral_stress - curve.back().lateral_stress) / slid, growth, 0.02 * growth);

  const TestResults results = evaluate(outcome.record);
  ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
  EXPECT_NEAR(*results.peak_stress.value / *results.normal_stress_at_peak.value, 0.6, 0.01 * 0.6);
  ASSERT_TRUE(results.dilation_angle.value) << results.dilation_angle.reason;
  EXPECT_NEAR(*results.dilation_angle.value, 8.0 * degree, 0.06 * 8.0 * degree) << "less by K c";
  EXPECT_EQ(results.servo_error.reason, "the normal stress follows the opening");
}

TEST(SmoothPlane, InStiffRockTakenUpGoesOnToTheSameBits)
{
  PlaneInStiffRock plane = plane_in_stiff_rock();
  plane.wanted.stop_strain = 0.0005;
  const auto [whole, taken_up] = tests::whole_and_taken_up([&] {
    return LabTest<2>({direct_shear, 2e6}, plane.specimen, plane.wanted, {});
  });
  ASSERT_GT(whole.curve().size(), 15u);
  EXPECT_TRUE(std::ranges::equal(whole.curve(), taken_up.curve(), [](const CurveSample& a, const CurveSample& b) {
    return a.axial_stress == b.axial_stress && a.lateral_stress == b.lateral_stress;
  }));
}

TEST(SmoothPlane, BetweenRigidHalvesBearsItsCohesionThenSlides)
{
  SmoothSides sides;
  sides.friction = 0.5;
  sides.cohesion = 3e6;
  sides.tensile_strength = 3e6;
  sides.friction_angle = 35.0 * degree;
  const Specimen<2> specimen = halves(sides, 0.020, 0.012, 0.0);
  Dynamics<2> dynamics(specimen, {}, ZeroForce::as_placed);
  std::array<std::vector<std::uint32_t>, 2> members;
  for (std::uint32_t i = 0; i < specimen.grains.size(); ++i)
    members[specimen.grains.position[1][i] > 0.006].push_back(i);
  dynamics.add_grip(members[0], Vector<2>::Zero());
  const std::size_t upper = dynamics.add_grip(members[1], Vector<2>(0.01, -0.001));
  // Stress of the plane on the upper half: what presses it up, and what holds it back.
  double pressure = 0.0, shear = 0.0, strength = 0.0, borne = 0.0;
  std::size_t n_broken = 0;
  while (dynamics.time() < 3e-4)
    {
      const std::size_t n = dynamics.step().size();
      if (n > 0 && n_broken == 0)
        {
          strength = 3e6 + pressure * std::tan(35.0 * degree); // by the pressure a step before
          borne = shear;
        }
      n_broken += n;
      pressure = dynamics.grip_force(upper)[1] / 0.020;
      shear = -dynamics.grip_force(upper)[0] / 0.020;
    }
  // Rigid halves stress all of the plane alike: it carries c + σ tan φ, whatever the grains along it, then μ σ. It goes
  // in two hundred steps to its strength.
  EXPECT_EQ(n_broken, specimen.smooth_joints.size());
  EXPECT_NEAR(borne, strength, 0.01 * strength);
  EXPECT_NEAR(shear, 0.5 * pressure, 0.01 * shear);
}

TEST(SmoothPlane, OfAnInclinedSpecimenFailsWhereJaegerSays)
{
  // σ_1 = 2 c / ((1 - tan φ cot β) sin 2β): 2 MPa and 30° at β = 55° give 7.15 MPa.
  SmoothSides sides;
  sides.friction = std::tan(30.0 * degree);
  sides.cohesion = 2e6;
  sides.tensile_strength = 2e6;
  sides.normal_stiffness = sides.shear_stiffness = 0.05e12;
  const double beta = 55.0 * degree;
  const Specimen<2> specimen = halves(sides, 0.012, 0.024, beta);
  TestParameters wanted;
  wanted.of<CompressionParameters>().strain_rate = 0.25;
  wanted.stop_strain = 0.006;
  wanted.of<CompressionParameters>().sampling_strain = 1e-5;
  const auto results = evaluate(tests::outcome_of<2>({uniaxial_compression}, specimen, wanted).record);
  ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
  EXPECT_EQ(results.dilation_angle.reason, "the test shears no plane");
  const double jaeger = 2.0 * 2e6 / ((1.0 - std::tan(30.0 * degree) / std::tan(beta)) * std::sin(2.0 * beta));
  EXPECT_NEAR(*results.peak_stress.value, jaeger, 0.05 * jaeger);
}

TEST(SmoothPlane, CountsAndPiecesAndRefusals)
{
  SmoothSides loose;
  const Specimen<2> specimen = halves(loose, 0.020, 0.012, 0.0);
  ASSERT_EQ(specimen.flaws.size(), 1u);
  EXPECT_EQ(specimen.flaws[0].n_joints, specimen.smooth_joints.size());
  EXPECT_EQ(specimen.report.n_smooth_joints, specimen.smooth_joints.size());
  EXPECT_EQ(specimen.report.n_joints, specimen.joints.size() + specimen.smooth_joints.size());
  // Unbonded through and through: two pieces, above and below.
  const auto piece = fragments(specimen);
  const auto is_above = [&](const std::size_t i) { return specimen.grains.position[1][i] > 0.006; };
  for (std::size_t i = 0; i < piece.size(); ++i)
    {
      if (piece[i] < 2) // others are grains without a joint
        {
          EXPECT_EQ(piece[i] == piece[0], is_above(i) == is_above(0));
        }
    }
  loose.cohesion = 1e6;
  EXPECT_TRUE(halves(loose, 0.020, 0.012, 0.0).smooth_joints.front().state.bonded);

  Specimen<2> cell = specimen;
  cell.shape = BodyShape::periodic;
  EXPECT_THROW(put_in_flaws(cell, {ClosedFlaw{{{0.001, 0.003}, {0.019, 0.003}}, SmoothSides{}}}), InputError);
  SmoothSides steep;
  steep.friction = 0.1;
  steep.dilation_angle = 20.0 * degree;
  EXPECT_THROW(halves(steep, 0.020, 0.012, 0.0), InputError);
}

/// 20 × 40 mm of flat joints with mineral grains of 5 mm.
Specimen<2> minerals(const std::uint64_t seed = 1)
{
  auto specimen = granite_box(0.020, 0.040, FlatJointParameters(), seed);
  SmoothJointParameters boundary;
  boundary.tensile_strength = 4e6;
  boundary.cohesion = 60e6;
  put_in_mineral_grains(specimen, {0.005}, boundary);
  return specimen;
}

TEST(MineralGrains, AreTheVoronoiCellsAndJoinedByPlanesBetweenThem)
{
  const Specimen<2> specimen = minerals();
  // 20 × 40 mm over π/4 (5 mm)² is 40.7 cells.
  const std::set<std::uint32_t> cells(specimen.groups.begin(), specimen.groups.end());
  EXPECT_EQ(cells.size(), 41u);
  EXPECT_EQ(specimen.groups.size(), specimen.grains.size());
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    EXPECT_EQ(specimen.groups[specimen.joints.grain_1[j]], specimen.groups[specimen.joints.grain_2[j]]);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vector<2>> planes;
  for (const auto& joint : specimen.smooth_joints)
    {
      auto one = specimen.groups[joint.grain_1];
      auto two = specimen.groups[joint.grain_2];
      EXPECT_NE(one, two);
      Vector<2> normal(joint.normal[0], joint.normal[1]);
      EXPECT_GT(normal.dot(Vector<2>(joint.branch[0], joint.branch[1])), 0.0);
      if (one > two)
        {
          std::swap(one, two);
          normal = -normal;
        }
      // One plane between two cells.
      const auto [known, is_new] = planes.emplace(std::pair(one, two), normal);
      EXPECT_LT((known->second - normal).norm(), 1e-12);
    }
  EXPECT_GT(planes.size(), 80u); // cells in the plane have some six neighbours, at the rim fewer
  EXPECT_EQ(minerals(1).groups, specimen.groups);
  EXPECT_NE(minerals(2).groups, specimen.groups);
}

TEST(MineralGrains, ThatAreTooSmallTooLargeOrThereAlreadyAreRefused)
{
  Specimen<2> specimen = small_specimen();
  EXPECT_THROW(put_in_mineral_grains(specimen, {0.0015}, {}), InputError);
  // 1.5 circles of 14.27 mm have the area of 12 × 20 mm; from there on there would be fewer than two.
  EXPECT_TRUE(has(tests::refusal([&] { put_in_mineral_grains(specimen, {0.050}, {}); }),
                  "mean_size = 50 mm: must be at most 14.2 mm in this specimen", "and at least "));
  Specimen<2> of_two = specimen;
  put_in_mineral_grains(of_two, {0.0142}, {});
  put_in_mineral_grains(specimen, {0.005}, {});
  EXPECT_THROW(put_in_mineral_grains(specimen, {0.005}, {}), InputError);
}

TEST(MineralGrains, CrackAtTheirBoundariesAndTheEnergiesBalance)
{
  const auto outcome = tests::balanced_outcome_of<2>({uniaxial_compression}, minerals(), quick_compression());
  const auto results = evaluate(outcome.record);
  ASSERT_TRUE(results.smooth_tension_share_at_peak.value) << results.smooth_tension_share_at_peak.reason;
  std::size_t n = 0;
  for (const Crack& crack : outcome.record.cracks)
    n += crack.on_smooth_joint;
  EXPECT_GT(n, 10u);
  EXPECT_LT(n, outcome.record.cracks.size());
  // A quarter of the joints are boundaries, one crack each where others have four segments. They carry a fifth of what
  // these do: before the specimen yields it is they that open.
  EXPECT_GT(*results.smooth_tension_share_at_peak.value, 0.15);
  EXPECT_TRUE(std::all_of(outcome.record.cracks.begin(), outcome.record.cracks.begin() + 5,
                          [](const Crack& crack) { return crack.on_smooth_joint; }));
  EXPECT_EQ(*results.n_smooth_tension_cracks_at_peak.value,
            std::round(*results.smooth_tension_share_at_peak.value *
                       (*results.n_tension_cracks_at_peak.value + *results.n_shear_cracks_at_peak.value)));
  EXPECT_GT(outcome.appearance.grains_at_end.front().group, 0u);
}

TEST(MineralGrains, ComeBackFromAFileAndATestTakenUpGivesTheSameBits)
{
  const tests::TemporaryFolder folder;
  const auto file = folder.path() / "specimen.h5";
  Specimen<2> specimen = minerals();
  put_in_flaws(specimen, {ClosedFlaw{{{0.005, 0.020}, {0.015, 0.020}}, SmoothSides{}}});
  ASSERT_FALSE(specimen.kept_apart.empty());
  write_specimen(specimen, file);
  const auto back = read_specimen<2>(file);
  EXPECT_EQ(back.groups, specimen.groups);
  EXPECT_EQ(back.kept_apart, specimen.kept_apart);
  ASSERT_EQ(back.smooth_joints.size(), specimen.smooth_joints.size());

  tests::expect_same_bits_when_resumed(specimen, back, quick_compression(), 30, 20);

  const auto is_refused = [&](const std::function<void(SmoothJoint<2>&)>& spoil) {
    Specimen<2> wrong = specimen;
    spoil(wrong.smooth_joints[3]);
    write_specimen(wrong, file);
    return tests::refusal([&] { read_specimen<2>(file); }) != "";
  };
  EXPECT_FALSE(is_refused([](auto&) {}));
  EXPECT_TRUE(is_refused([](auto& joint) { joint.grain_2 = 1000000; }));
  EXPECT_TRUE(is_refused([](auto& joint) { joint.face.dilation_slope = joint.face.friction + 0.1; }));
  EXPECT_TRUE(is_refused([](auto& joint) { joint.normal = {0.0, 0.0}; }));
  EXPECT_TRUE(is_refused([](auto& joint) { joint.area = 0.0; }));
}

TEST(SmoothJoints, ATurnedSpecimenHasItsPlanesTurned)
{
  const Specimen<2> specimen = minerals();
  const Specimen<2> turned = quarter_turned(specimen);
  for (std::size_t k = 0; k < specimen.smooth_joints.size(); ++k)
    {
      const auto& one = specimen.smooth_joints[k];
      const auto& two = turned.smooth_joints[k];
      EXPECT_EQ(two.normal[0], one.normal[1]);
      EXPECT_EQ(two.normal[1], -one.normal[0]);
      const Vector<2> branch = at<2>(turned.grains.position, two.grain_2) - at<2>(turned.grains.position, two.grain_1);
      EXPECT_LT((branch - Vector<2>(two.branch[0], two.branch[1])).norm(), 1e-15);
    }
}
} // namespace
} // namespace feldspar
