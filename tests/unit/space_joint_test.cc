// The flat joint in three dimensions: its disk of elements, and how its faces move.

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/laws/flat_joint.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
using std::numbers::pi;

TEST(FaceElements, AreWholeInAreaAndLumpedInBendingAndTwist)
{
  // Share of the continuum disk's ½π (twist) and ¼π (bending): Σ A_e r_e², which for four sectors or more is the same
  // about every axis; 0.608, 0.781, 0.914, 0.960 are those of an independent program.
  struct Case
  {
    unsigned int n_rings, n_sectors;
    double ratio;
  };
  for (const auto& [n_rings, n_sectors, ratio] : {Case{1, 3, 0.608}, {2, 4, 0.781}, {2, 8, 0.914}, {3, 12, 0.960}})
    {
      double area = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, x = 0.0;
      for (const auto& element : face_elements<3>(n_rings, n_sectors))
        {
          area += element.area;
          x += element.area * element.offset[0];
          xx += element.area * element.offset[0] * element.offset[0];
          yy += element.area * element.offset[1] * element.offset[1];
          xy += element.area * element.offset[0] * element.offset[1];
          EXPECT_EQ(element.second_moment, 0.0);
        }
      EXPECT_NEAR(area, pi, 1e-14);
      EXPECT_NEAR(x, 0.0, 1e-14);
      EXPECT_NEAR(xy, 0.0, 1e-14);
      EXPECT_NEAR(xx, yy, 1e-14);
      EXPECT_NEAR((xx + yy) / (0.5 * pi), ratio, 5e-4); // as many digits as the source gives
    }
}

TEST(FaceElements, OfTheLineFillItsSecondMoment)
{
  // Σ (ρ_i² A_i + own) = ⅔, the second moment of a line of length 2, whatever N.
  for (const unsigned int n : {1u, 3u, 4u, 7u})
    {
      double sum = 0.0;
      for (const auto& element : face_elements<2>(n))
        sum += element.offset[0] * element.offset[0] * element.area + element.second_moment;
      EXPECT_NEAR(sum, 2.0 / 3.0, 1e-14);
    }
}

/// Two grains in contact, jointed, along a direction that is no axis.
Specimen<3> pair_of_grains(const double radius_1, const double radius_2, const FlatJointParameters& wanted)
{
  const Vector<3> direction = Vector<3>(2.0, -1.0, 2.0) / 3.0;
  const Vector<3> second = Vector<3>::Constant(0.5) + (radius_1 + radius_2) * direction;
  auto specimen = placed_specimen<3>({radius_1, radius_2}, {{{0.5, second[0]}, {0.5, second[1]}, {0.5, second[2]}}});
  install_joints(specimen, wanted);
  return specimen;
}

/// Unbreakable unless said.
FlatJointParameters verification_joint()
{
  FlatJointParameters wanted;
  wanted.modulus = 2.32e12 * 2.0 * 6.25e-3;
  wanted.stiffness_ratio = 2.32 / 1.0087;
  wanted.radius_multiplier = 0.8;
  wanted.n_rings = 2;
  wanted.n_sectors = 8;
  wanted.bond_tensile_strength = wanted.bond_cohesion = 1e30;
  wanted.bond_tensile_strength_deviation = wanted.bond_cohesion_deviation = 0.0;
  wanted.installation_gap_ratio = 1e-6;
  return wanted;
}

struct Axes
{
  Vector<3> n, t_1, t_2;
};

Axes axes(const Joints<3>& joints)
{
  const Vector<3> n = at<3>(joints.normal, 0);
  const Vector<3> t = at<3>(joints.tangent, 0);
  return {n, t, n.cross(t)};
}

TEST(SpaceJoint, GivesTheForcesOfTheTwoGrainVerification)
{
  // R = 6.25 mm, λ = 0.8, k_n = 2.32e12 Pa/m, k_s = 1.0087e12 Pa/m, 2 × 8 elements. Figures of an independent program:
  // 1.822e5 N; 181.0 and 416.3 N m, which hold the lumped share of the continuum disk to three digits, 0.914. That share
  // is 0.9145: ring centroids at 1/3 and 7/9 of R̄, both times the chord c = sin(π/8)/(π/8), areas 1 : 3, so that
  // Σ A r² = π(1/36 + 49/108)c² of the continuum's ½π.
  const double radius = 6.25e-3;
  for (const char what : {'o', 't', 'b', 'c'})
    {
      auto specimen = pair_of_grains(radius, radius, verification_joint());
      auto& grains = specimen.grains;
      auto& joints = specimen.joints;
      ASSERT_EQ(joints.size(), 1u);
      const Axes a = axes(joints);
      if (what == 'o')
        set<3>(grains.position, 1, at<3>(grains.position, 1) + 1e-3 * a.n);
      else
        {
          const Vector<3> axis = what == 't' ? Vector<3>(0.5 * a.n) : what == 'b' ? a.t_1 : a.t_2;
          set<3>(grains.spin, 0, -0.2 * axis);
          set<3>(grains.spin, 1, 0.2 * axis);
        }
      EXPECT_TRUE(sweep_joints(joints, grains, 1.0).empty());
      const Vector<3> force = at<3>(joints.force, 0);
      const Vector<3> couple = at<3>(joints.couple_2, 0);
      if (what == 'o')
        {
          EXPECT_NEAR(-force.dot(a.n), 1.822e5, 0.5e2);
          EXPECT_NEAR(-force.dot(a.n), 2.32e12 * pi * 25e-6 * 1e-3, 1e-3);
          EXPECT_NEAR(couple.norm(), 0.0, 1e-9);
        }
      else
        {
          const Vector<3> axis = what == 't' ? a.n : what == 'b' ? a.t_1 : a.t_2;
          const double chord = std::sin(pi / 8.0) / (pi / 8.0);
          const double polar = pi * (1.0 / 36.0 + 49.0 / 108.0) * chord * chord * std::pow(5e-3, 4);
          const double expected = what == 't' ? 1.0087e12 * polar * 0.2 : 2.32e12 * 0.5 * polar * 0.4;
          EXPECT_NEAR(-couple.dot(axis), expected, 1e-10 * expected);
          EXPECT_NEAR(expected, what == 't' ? 181.0 : 416.3, 1e-3 * expected);
          EXPECT_NEAR((couple - couple.dot(axis) * axis).norm(), 0.0, 1e-9);
          EXPECT_NEAR(force.norm(), 0.0, 1e-6);
          EXPECT_NEAR((couple + at<3>(joints.couple_1, 0)).norm(), 0.0, 1e-9);
        }
    }
}

TEST(SpaceJoint, ShearActsAtTheContactAndKeepsTheMomentumOfThePair)
{
  // Grain 2 moved across by u: F_s = -k_s πR̄² u; both grains get the couple -a_i n × F_s, R1 ≠ R2.
  auto specimen = pair_of_grains(3e-3, 1e-3, verification_joint());
  auto& joints = specimen.joints;
  const Axes a = axes(joints);
  const double u = 1e-8;
  set<3>(specimen.grains.position, 1, at<3>(specimen.grains.position, 1) + u * a.t_2);
  sweep_joints(joints, specimen.grains, 1.0);
  const Vector<3> force = at<3>(joints.force, 0);
  const double expected = -joints.shear_stiffness[0] * joints.face_area(0) * u;
  EXPECT_NEAR(force.dot(a.t_2), expected, 1e-6 * std::abs(expected)); // the arc is u to (u/d)²; positions to 1e-16
  EXPECT_NEAR((at<3>(joints.couple_1, 0) + 3e-3 * a.n.cross(force)).norm(), 0.0, 1e-5 * 3e-3 * std::abs(expected));
  EXPECT_NEAR((at<3>(joints.couple_2, 0) + 1e-3 * a.n.cross(force)).norm(), 0.0, 1e-5 * 3e-3 * std::abs(expected));
  const Vector<3> branch = at<3>(specimen.grains.position, 1) - at<3>(specimen.grains.position, 0);
  const Vector<3> momentum = at<3>(joints.couple_1, 0) + at<3>(joints.couple_2, 0) + branch.cross(force);
  EXPECT_NEAR(momentum.norm(), 0.0, 1e-12 * branch.norm() * force.norm());
}

TEST(SpaceJoint, ARigidTurnAboutAnyAxisChangesNothing)
{
  // Opened, sheared both ways, bent and twisted, some elements broken; then carried round once in 1000 steps, and once
  // in 50, where the series of small turns give way to the functions themselves.
  FlatJointParameters wanted;
  wanted.installation_gap_ratio = 1e-6;
  wanted.n_rings = 2;
  wanted.n_sectors = 4;
  const std::vector<Vector<3>> turns = {Vector<3>::UnitX(), Vector<3>::UnitY(), Vector<3>::UnitZ(),
                                        Vector<3>(2.0, -1.0, 2.0) / 3.0, Vector<3>(0.6, 0.0, 0.8)};
  for (const Vector<3>& axis : turns)
    for (const int n_steps : {1000, 50})
      {
        auto specimen = pair_of_grains(1e-3, 0.7e-3, wanted);
        auto& joints = specimen.joints;
        auto& grains = specimen.grains;
        set<3>(grains.position, 1, at<3>(grains.position, 1) + Vector<3>(4e-7, -5e-7, -3e-7));
        set<3>(grains.spin, 0, Vector<3>(4e-4, -3e-4, 2e-4));
        set<3>(grains.spin, 1, Vector<3>(-5e-4, 2e-4, 6e-4));
        const auto broken = sweep_joints(joints, grains, 1.0);
        ASSERT_GT(broken.size(), 0u);
        ASSERT_LT(broken.size(), 8u);

        const Axes a = axes(joints);
        const Joints<3> before = joints;
        const double opening = joints.opening[0];
        const Vector<3> force_before = at<3>(joints.force, 0);
        const Vector<3> couple_before = at<3>(joints.couple_2, 0);
        const Vector<3> first = at<3>(grains.position, 0);
        const Vector<3> branch = at<3>(grains.position, 1) - first;
        for (int step = 1; step <= n_steps; ++step)
          {
            const Eigen::AngleAxisd turned(2.0 * pi * step / n_steps, axis);
            set<3>(grains.position, 1, Vector<3>(first + turned * branch));
            for (const std::size_t i : {0u, 1u})
              set<3>(grains.spin, i, Vector<3>(2.0 * pi / n_steps * axis));
            EXPECT_TRUE(sweep_joints(joints, grains, 1.0).empty());
          }
        for (int c = 0; c < 2; ++c)
          for (unsigned int k = 0; k < 8; ++k)
            EXPECT_NEAR(shear_stress(joints, k, 0)[c], shear_stress(before, k, 0)[c], 1e-10 * 1e9);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(joints.rotation[c][0], before.rotation[c][0], 1e-10 * 1e-3);
        EXPECT_NEAR(joints.opening[0], opening, 1e-10 * 1e-6);
        EXPECT_NEAR((axes(joints).t_1 - a.t_1).norm(), 0.0, 1e-10);
        EXPECT_NEAR((at<3>(joints.force, 0) - force_before).norm(), 0.0, 1e-10 * force_before.norm());
        EXPECT_NEAR((at<3>(joints.couple_2, 0) - couple_before).norm(), 0.0, 1e-10 * couple_before.norm());
      }
}

TEST(SpaceJoint, StressTurnsWithTheContactPlane)
{
  // Sheared along t_1; then the pair is turned rigidly by a quarter about its own normal: the force turns with it.
  auto specimen = pair_of_grains(1e-3, 1e-3, verification_joint());
  auto& joints = specimen.joints;
  const Axes a = axes(joints);
  set<3>(specimen.grains.position, 1, at<3>(specimen.grains.position, 1) + 1e-8 * a.t_1);
  sweep_joints(joints, specimen.grains, 1.0);
  const double force = at<3>(joints.force, 0).dot(a.t_1);
  const Vector<3> n = axes(joints).n;
  for (const std::size_t i : {0u, 1u})
    set<3>(specimen.grains.spin, i, Vector<3>(0.5 * pi * n));
  sweep_joints(joints, specimen.grains, 1.0);
  EXPECT_NEAR(at<3>(joints.force, 0).dot(a.t_2), force, 1e-4 * std::abs(force)); // n is off a.n by u/d = 5e-6
  EXPECT_NEAR(at<3>(joints.force, 0).dot(a.t_1), 0.0, 1e-4 * std::abs(force));
}

TEST(SpaceJoint, MovesInThePlaneAsThePlaneDoes)
{
  // With all motion in the plane, slip and rotation are those of the two-dimensional frame: t_1 = t, t_2 = k.
  const std::array<double, 2> one{0.1, -0.2}, two{1.3, 0.4}, one_now{0.15, -0.25}, two_now{1.2, 0.6};
  const double half_difference = 0.3;
  const auto flat_before = contact_frame<2, double>(one, two);
  const auto flat = contact_motion<double>(flat_before, one_now, two_now, half_difference, {0.07}, {-0.11});
  auto before = contact_frame<3, double>({one[0], one[1], 0.0}, {two[0], two[1], 0.0});
  before.tangent = {-before.normal[1], before.normal[0], 0.0};
  const auto space = contact_motion<double>(before, {one_now[0], one_now[1], 0.0}, {two_now[0], two_now[1], 0.0},
                                            half_difference, {0.0, 0.0, 0.07}, {0.0, 0.0, -0.11});
  EXPECT_NEAR(space.slip[0], flat.slip[0], 1e-15);
  EXPECT_NEAR(space.slip[1], 0.0, 1e-15);
  EXPECT_NEAR(space.rotation[2], flat.rotation[0], 1e-15);
  EXPECT_NEAR(space.frame.tangent[0], -space.frame.normal[1], 1e-15);
}

TEST(SpaceJoint, BrokenAndPressedItResistsRotationWhereAPointContactDoesNot)
{
  // All elements broken, pressed by δ and bent by θ: while every centroid stays closed the couple is that of the bonded
  // disk, and once an edge opens that of the elements still closed. A point contact has no response to θ.
  auto wanted = verification_joint();
  wanted.slit_fraction = 1.0;
  const double radius = 6.25e-3;
  const double pressed = 1e-6;
  for (const double bend : {1e-4, 1e-3})
    {
      auto specimen = pair_of_grains(radius, radius, wanted);
      auto& grains = specimen.grains;
      auto& joints = specimen.joints;
      ASSERT_FALSE(joints.holds(0));
      const Axes a = axes(joints);
      set<3>(grains.position, 1, at<3>(grains.position, 1) - pressed * a.n);
      set<3>(grains.spin, 0, Vector<3>(-0.5 * bend * a.t_1));
      set<3>(grains.spin, 1, Vector<3>(0.5 * bend * a.t_1));
      sweep_joints(joints, grains, 1.0);
      double expected = 0.0;
      for (const auto& element : joints.elements)
        {
          const double lever = 5e-3 * element.offset[1];
          expected += 2.32e12 * 25e-6 * element.area * std::min(0.0, -pressed + bend * lever) * lever;
        }
      EXPECT_NEAR(at<3>(joints.couple_2, 0).dot(a.t_1), -expected, 1e-6 * std::abs(expected));
      EXPECT_LT(std::abs(expected), 2.32e12 * 0.914 * 0.25 * pi * std::pow(5e-3, 4) * bend * 1.001);

      const auto motion =
        contact_motion<double>({{a.n[0], a.n[1], a.n[2]}, 2.0 * radius, {a.t_1[0], a.t_1[1], a.t_1[2]}},
                               {grains.position[0][0], grains.position[1][0], grains.position[2][0]},
                               {grains.position[0][1], grains.position[1][1], grains.position[2][1]}, 0.0,
                               {-0.5 * bend * a.t_1[0], -0.5 * bend * a.t_1[1], -0.5 * bend * a.t_1[2]},
                               {0.5 * bend * a.t_1[0], 0.5 * bend * a.t_1[1], 0.5 * bend * a.t_1[2]});
      EXPECT_NEAR(std::hypot(motion.slip[0], motion.slip[1]), 0.0, 1e-15); // so no shear, and no couple
    }
}
} // namespace
} // namespace feldspar
