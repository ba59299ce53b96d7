// Holes, slots, closed flaws and joint sets: what they take out of a specimen, what they leave, and what they are refused for.

#include "dem/flaws/apply.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/bending.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/notch.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/laws/pivoting_plate.h"
#include "dem/specimen/fragments.h"
#include "dem/specimen/specimen_file.h"
#include "dem/specimen/specimen_part.h"
#include "results/evaluation.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>

namespace feldspar
{
namespace
{
using tests::has;

/// 12 × 20 mm, grains of 0.8 mm in the mean radius.
const Specimen<2>& rock()
{
  static const Specimen<2> specimen = small_specimen();
  return specimen;
}

Specimen<2> with(const std::vector<Shape>& shapes)
{
  Specimen<2> specimen = rock();
  put_in_flaws(specimen, shapes);
  return specimen;
}

std::string refusal(const std::vector<Shape>& shapes)
{
  return tests::refusal([&] { with(shapes); });
}

ClosedFlaw line(const double x_1, const double y_1, const double x_2, const double y_2)
{
  return {{{x_1, y_1}, {x_2, y_2}}};
}

/// The centres of a joint's grains.
std::pair<Vector<2>, Vector<2>> ends(const Specimen<2>& specimen, const std::size_t joint)
{
  return {at<2>(specimen.grains.position, specimen.joints.grain_1[joint]),
          at<2>(specimen.grains.position, specimen.joints.grain_2[joint])};
}

TEST(Flaws, AHoleTakesOutTheGrainsInItAndLeavesTheOthersAsTheyWere)
{
  const Vector<2> centre(0.006, 0.010);
  const double radius = 0.0025;
  const Specimen<2> holed = with({EllipseHole{centre, {radius, radius}}});
  std::size_t n_outside = 0;
  std::set<std::pair<double, double>> places;
  for (std::size_t i = 0; i < rock().grains.size(); ++i)
    {
      const Vector<2> x = at<2>(rock().grains.position, i);
      n_outside += (x - centre).norm() >= radius;
      places.emplace(x[0], x[1]);
    }
  ASSERT_EQ(holed.flaws.size(), 1u);
  EXPECT_EQ(holed.flaws[0].n_grains, rock().grains.size() - holed.grains.size());
  // Crumbs may fall out with it: a grain or two in a specimen as small as this.
  EXPECT_LE(holed.grains.size(), n_outside);
  EXPECT_GE(holed.grains.size() + 2, n_outside);
  EXPECT_LT(n_outside, rock().grains.size());
  for (std::size_t i = 0; i < holed.grains.size(); ++i)
    {
      const Vector<2> x = at<2>(holed.grains.position, i);
      EXPECT_GE((x - centre).norm(), radius);
      EXPECT_TRUE(places.contains({x[0], x[1]}));
    }
  // Strengths are those of the same joints as before: in the same order, some left out.
  std::size_t k = 0;
  for (std::size_t j = 0; j < holed.joints.size(); ++j)
    {
      while (k < rock().joints.size() && ends(rock(), k) != ends(holed, j))
        ++k;
      ASSERT_LT(k, rock().joints.size());
      EXPECT_EQ(holed.joints.tensile_strength[holed.joints.segment(1, j)],
                rock().joints.tensile_strength[rock().joints.segment(1, k)]);
      EXPECT_EQ(holed.joints.number[j], j);
    }
  EXPECT_EQ(holed.report.n_grains, holed.grains.size());
  EXPECT_EQ(holed.report.n_joints, holed.joints.size());
}

TEST(Flaws, AnEllipseTurnsWithItsAngle)
{
  // Long across and thin along the axis; turned by 90° the other way round.
  const EllipseHole lying{{0.006, 0.010}, {0.004, 0.0015}, 0.0};
  EllipseHole standing = lying;
  standing.angle = 0.5 * std::numbers::pi;
  const auto reach = [](const EllipseHole& hole) {
    Vector<2> most(0.0, 0.0);
    for (const auto& point : outline(Shape(hole)))
      most = most.cwiseMax((point - hole.centre).cwiseAbs());
    return most;
  };
  EXPECT_NEAR(reach(lying)[0], 0.004, 1e-15);
  EXPECT_NEAR(reach(lying)[1], 0.0015, 1e-15);
  EXPECT_NEAR(reach(standing)[0], 0.0015, 1e-15);
  EXPECT_NEAR(reach(standing)[1], 0.004, 1e-15);
  const Specimen<2> one = with({standing});
  for (std::size_t i = 0; i < one.grains.size(); ++i)
    {
      const Vector<2> x = at<2>(one.grains.position, i) - standing.centre;
      EXPECT_GE(std::hypot(x[0] / 0.0015, x[1] / 0.004), 1.0);
    }
}

TEST(Flaws, APolygonTakesOutWhatTheSameDiscWould)
{
  // Polygon of 200 corners: its area is that of the disc within 2e-4.
  PolygonHole polygon;
  for (int k = 0; k < 200; ++k)
    polygon.corners.emplace_back(0.006 + 0.003 * std::cos(std::numbers::pi * k / 100.0),
                                 0.010 + 0.003 * std::sin(std::numbers::pi * k / 100.0));
  EXPECT_EQ(with({polygon}).grains.position, with({EllipseHole{{0.006, 0.010}, {0.003, 0.003}}}).grains.position);
}

TEST(Flaws, AClosedFlawUnbondsTheJointsThatItCrossesAndNoOthers)
{
  // Upright: a joint crosses it if its grains lie on both sides and the crossing lies between its ends.
  const double x = 0.006;
  const Specimen<2> flawed = with({line(x, 0.004, x, 0.016)});
  ASSERT_EQ(flawed.joints.size(), rock().joints.size());
  EXPECT_EQ(flawed.grains.size(), rock().grains.size());
  std::uint64_t n = 0;
  for (std::size_t j = 0; j < flawed.joints.size(); ++j)
    {
      const auto [a, b] = ends(flawed, j);
      const double y = a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
      const bool crosses = (a[0] - x) * (b[0] - x) < 0.0 && y > 0.004 && y < 0.016;
      EXPECT_EQ(flawed.joints.holds(j), !crosses) << j;
      n += crosses;
    }
  EXPECT_GT(n, 5u);
  EXPECT_EQ(flawed.flaws.at(0).n_joints, n);
  EXPECT_FALSE(flawed.flaws[0].open);
}

TEST(Flaws, ASlotOfNoWidthCutsTheFacesAndTakesOutNoGrain)
{
  const Specimen<2> cut = with({Slot{{0.006, 0.0}, {0.006, 0.008}, 0.0}});
  EXPECT_EQ(cut.grains.size(), rock().grains.size());
  const Specimen<2> unbonded = with({line(0.006, 0.0, 0.006, 0.008)});
  EXPECT_EQ(rock().joints.size() - cut.joints.size(), unbonded.flaws.at(0).n_joints);
  for (std::size_t j = 0; j < cut.joints.size(); ++j)
    {
      const auto [a, b] = ends(cut, j);
      EXPECT_FALSE(cross(a, b, {0.006, 0.0}, {0.006, 0.008}));
    }
}

TEST(Flaws, ASlotOfAWidthTakesOutTheGrainsAlongIt)
{
  const Specimen<2> cut = with({Slot{{0.006, 0.0}, {0.006, 0.008}, 0.002}});
  EXPECT_LT(cut.grains.size(), rock().grains.size());
  for (std::size_t i = 0; i < cut.grains.size(); ++i)
    EXPECT_FALSE(std::abs(cut.grains.position[0][i] - 0.006) < 0.001 && cut.grains.position[1][i] < 0.008);
}

TEST(Flaws, AThroughGoingOneLeavesTwoPiecesThatOnlyTouch)
{
  const Specimen<2> flawed = with({line(0.0, 0.008, 0.012, 0.012)});
  const auto piece = fragments(flawed.joints, flawed.grains.size());
  for (std::size_t i = 0; i < flawed.grains.size(); ++i)
    if (piece[i] < 2) // others never had a joint
      {
        const double above = flawed.grains.position[1][i] - 0.008 - flawed.grains.position[0][i] / 3.0;
        const double of_first = flawed.grains.position[1][0] - 0.008 - flawed.grains.position[0][0] / 3.0;
        EXPECT_EQ(piece[i] == piece[0], (above > 0.0) == (of_first > 0.0));
      }
}

TEST(Flaws, AreRefusedByNumberKindAndReason)
{
  const EllipseHole fits{{0.006, 0.010}, {0.0025, 0.0025}};
  EXPECT_EQ(refusal({fits, EllipseHole{{0.011, 0.010}, {0.0025, 0.0025}}}).substr(0, 70),
            "FlawParameters: shape 2, hole: (13.5, 10) mm lies outside of the speci");
  EXPECT_TRUE(has(refusal({line(0.0, 0.0, 0.0, 0.03)}), "shape 1, closed flaw: (0, 30) mm lies outside"));
  EXPECT_TRUE(has(refusal({EllipseHole{{0.006, 0.010}, {1e-6, 1e-6}}}), "hole: takes out no grain"));
  EXPECT_TRUE(has(refusal({line(0.006, 0.01, 0.006 + 1e-7, 0.01)}), "closed flaw: crosses no joint"));
  EXPECT_TRUE(has(refusal({EllipseHole{{0.006, 0.010}, {0.006, 0.010}}}), "hole: takes out more than half"));
  EXPECT_TRUE(has(refusal({PolygonHole{{{0.002, 0.002}, {0.01, 0.01}, {0.01, 0.002}, {0.002, 0.01}}}}), "cuts itself"));
  EXPECT_TRUE(has(refusal({SphereHole{{0.006, 0.006, 0.010}, 0.002}}), "sphere: lies in space"));
}

TEST(Flaws, ThatLeaveAFreePieceAreRefused)
{
  // Two saw cuts that meet cut a corner off; either alone does not.
  const Slot down{{0.006, 0.011}, {0.006, 0.0}, 0.0};
  const Slot across{{0.0, 0.010}, {0.0065, 0.010}, 0.0};
  EXPECT_EQ(refusal({down}), "");
  EXPECT_EQ(refusal({across}), "");
  EXPECT_TRUE(has(refusal({down, across}), "FlawParameters: shape 2, slot: leaves a free piece of "));
}

TEST(JointSets, HaveTheSpacingThePersistenceAndTheSeedOfTheirEntry)
{
  // Trace length per area is persistence over spacing: of some 170 traces whose rows begin anywhere, within 5 %.
  const Vector<2> size(1.0, 1.0);
  JointSet set{.angle = 0.5, .spacing = 0.02, .persistence = 0.6, .trace_length = 0.15, .seed = 3};
  double length = 0.0;
  for (const ClosedFlaw& flaw : traces(set, size))
    {
      const Vector<2> way = flaw.points[1] - flaw.points[0];
      length += way.norm();
      EXPECT_NEAR(std::atan2(way[1], way[0]), 0.5, 1e-9);
      EXPECT_LE(way.norm(), 0.15 * (1.0 + 1e-12));
      for (const auto& point : flaw.points)
        EXPECT_TRUE((point.array() > -1e-12).all() && (point.array() < 1.0 + 1e-12).all());
    }
  EXPECT_NEAR(length, 0.6 / 0.02, 0.05 * 0.6 / 0.02);
  const Vector<2> first = traces(set, size)[0].points[0];
  set.seed = 4;
  EXPECT_NE(traces(set, size)[0].points[0], first);

  // Through-going ones: lines at the spacing, as many as fit across.
  set.persistence = 1.0;
  const double breadth = std::sin(0.5) + std::cos(0.5);
  EXPECT_NEAR(double(traces(set, size).size()), breadth / 0.02, 1.0);
}

TEST(JointMap, IsCutAtTheSidesOfTheBody)
{
  const auto of_map = [](std::vector<Vector<2>> points) { return ClosedFlaw{std::move(points), std::nullopt, "0"}; };
  const Vector<2> size(0.012, 0.020);
  // Out through the right side and back in, at 45 degrees: two parts, each with its end on the side.
  const ClosedFlaw zigzag = of_map({{0.010, 0.004}, {0.014, 0.008}, {0.008, 0.014}, {0.008, 0.016}});
  const auto parts = parts_inside(zigzag, size);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_LT((parts[0].points.at(1) - Vector<2>(0.012, 0.006)).norm(), 1e-12);
  ASSERT_EQ(parts[1].points.size(), 3u);
  EXPECT_LT((parts[1].points[0] - Vector<2>(0.012, 0.010)).norm(), 1e-12);
  EXPECT_EQ(parts[1].points[2], zigzag.points[3]);
  EXPECT_EQ(parts_inside(of_map({{0.001, 0.001}, {0.002, 0.009}}), size)[0].points.size(), 2u);
  EXPECT_TRUE(parts_inside(of_map({{0.013, 0.0}, {0.013, 0.02}}), size).empty());

  // The joints that it crosses are those of the same line drawn up to the sides; one outside has no effect.
  const auto whole = with({line(0.0, 0.010, 0.012, 0.010)});
  const auto mapped = with({of_map({{-0.1, 0.010}, {0.1, 0.010}}), of_map({{0.1, 0.1}, {0.2, 0.2}})});
  EXPECT_EQ(mapped.joints.bonded, whole.joints.bonded);
  EXPECT_EQ(mapped.flaws.size(), 1u);
  EXPECT_TRUE(has(refusal({of_map({{0.1, 0.1}, {0.2, 0.2}})}), "no trace of the map lies in the specimen"));
  // The shapes of an input are refused outside, as before.
  EXPECT_TRUE(has(refusal({line(-0.1, 0.010, 0.1, 0.010)}), "lies outside of the specimen"));
}

TEST(DiscSets, HaveFishersDistributionAboutTheirMean)
{
  const Vector<3> mean = Vector<3>(1.0, 2.0, 2.0) / 3.0;
  for (const double concentration : {0.5, 20.0})
    {
      DiscSet set{mean, concentration, 0.002, 4000, 3};
      const auto flaws = discs(set, {0.01, 0.02, 0.03});
      ASSERT_EQ(flaws.size(), 4000u);
      Vector<3> sum = Vector<3>::Zero();
      Vector<3> centre = Vector<3>::Zero();
      for (const DiscFlaw& flaw : flaws)
        {
          EXPECT_NEAR(flaw.normal.norm(), 1.0, 1e-12);
          sum += flaw.normal / 4000.0;
          centre += flaw.centre / 4000.0;
        }
      // The mean of the cosine to the mean normal is coth κ - 1/κ, its variance at most 1/3 and here 1/κ² for a large κ; across
      // it the mean is 0. Four standard errors each.
      const double cosine = 1.0 / std::tanh(concentration) - 1.0 / concentration;
      EXPECT_NEAR(sum.dot(mean), cosine, 4.0 * std::min(1.0 / std::sqrt(3.0), 1.0 / concentration) / std::sqrt(4000.0));
      EXPECT_LT((sum - sum.dot(mean) * mean).norm(), 4.0 * std::sqrt(2.0 / 3.0 / 4000.0));
      EXPECT_LT((centre - Vector<3>(0.005, 0.01, 0.015)).norm(),
                4.0 * 0.03 / std::sqrt(12.0 * 4000.0) * std::sqrt(3.0));
      set.seed = 4;
      EXPECT_NE(discs(set, {0.01, 0.02, 0.03})[0].centre, flaws[0].centre);
    }

  // Each disc of a set, which may reach out of the body, unbonds what a disc flaw of its own does.
  const DiscSet set{mean, 20.0, 0.003, 5, 1};
  Specimen<3> specimen = small_cylinder();
  const Specimen<3> intact = specimen;
  put_in_flaws<3>(specimen, {set});
  ASSERT_EQ(specimen.flaws.size(), 5u);
  EXPECT_EQ(specimen.flaws[0].name, "disc set");
  EXPECT_LT(std::count(specimen.joints.bonded.begin(), specimen.joints.bonded.end(), 1.0),
            std::count(intact.joints.bonded.begin(), intact.joints.bonded.end(), 1.0));
  EXPECT_TRUE(has(refusal({set}), "lies in space"));
}

TEST(Flaws, ComeBackFromASpecimenFile)
{
  const auto file = std::filesystem::temp_directory_path() / "flaws_test.h5";
  const Specimen<2> specimen = with({EllipseHole{{0.004, 0.012}, {0.002, 0.002}}, line(0.006, 0.004, 0.010, 0.008)});
  write_specimen(specimen, file);
  const Specimen<2> back = read_specimen<2>(file);
  ASSERT_EQ(back.flaws.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k)
    {
      EXPECT_EQ(back.flaws[k].name, specimen.flaws[k].name);
      EXPECT_EQ(back.flaws[k].open, specimen.flaws[k].open);
      EXPECT_EQ(back.flaws[k].outline, specimen.flaws[k].outline);
      EXPECT_EQ(back.flaws[k].n_joints, specimen.flaws[k].n_joints);
    }
  EXPECT_EQ(back.joints.bonded, specimen.joints.bonded);
  EXPECT_EQ(back.grains.position, specimen.grains.position);
  write_specimen(rock(), file);
  EXPECT_TRUE(read_specimen<2>(file).flaws.empty());
  std::filesystem::remove(file);
}

TEST(Flaws, InSpaceRunThroughTheDepth)
{
  // A borehole along y through a cube of 8 × 8 × 12 mm.
  Specimen<3> specimen = small_cylinder(1, 1.0, BodyShape::box);
  const std::size_t before = specimen.grains.size();
  put_in_flaws(specimen, {EllipseHole{{0.004, 0.006}, {0.0015, 0.0015}}});
  EXPECT_LT(specimen.grains.size(), before);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    EXPECT_GE(std::hypot(specimen.grains.position[0][i] - 0.004, specimen.grains.position[2][i] - 0.006), 0.0015);

  // A level disc: what crosses its plane beyond its rim stays bonded.
  specimen = small_cylinder(1, 1.0, BodyShape::box);
  put_in_flaws(specimen, {DiscFlaw{{0.004, 0.004, 0.006}, 0.003, {0.0, 0.0, 1.0}}});
  std::size_t n = 0;
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    {
      const Vector<3> a = at<3>(specimen.grains.position, specimen.joints.grain_1[j]);
      const Vector<3> b = at<3>(specimen.grains.position, specimen.joints.grain_2[j]);
      const double share = (0.006 - a[2]) / (b[2] - a[2]);
      const Vector<3> there = a + share * (b - a);
      const bool crosses = share > 0.0 && share < 1.0 && std::hypot(there[0] - 0.004, there[1] - 0.004) < 0.003;
      EXPECT_EQ(specimen.joints.holds(j), !crosses);
      n += crosses;
    }
  EXPECT_GT(n, 3u);
}

TEST(Plates, PressOnGrainsWithinTheirExtentOnly)
{
  // Two grains on a plate that ends between them and rises.
  Specimen<2> specimen = placed_specimen({0.1, 0.1}, {{{0.2, 0.8}, {0.1, 0.1}}});
  Dynamics<2> dynamics(specimen, {}, ZeroForce::at_touch);
  Wall plate{.axis = 1, .side = 1.0, .position = 0.0, .velocity = 1e-3};
  plate.extent = {0.0, 0.5};
  const std::size_t wall = dynamics.add_wall(plate);
  for (int k = 0; k < 3; ++k)
    dynamics.step();
  EXPECT_GT(dynamics.specimen().grains.force[1][0], 0.0);
  EXPECT_EQ(dynamics.specimen().grains.force[1][1], 0.0);
  EXPECT_DOUBLE_EQ(dynamics.wall_force(wall), dynamics.specimen().grains.force[1][0]);
}

TEST(Plates, ThrowOutNoGrainThatComesFromBeside)
{
  // A grain stands beside a plate, 1 mm deeper than its face, and slides over it: no force where it arrives, though the wall
  // would have one of 1e-3 times 2 E.
  Specimen<2> specimen = placed_specimen({0.1}, {{{0.55}, {0.099}}});
  Dynamics<2> dynamics(specimen, {.damping = 0.0}, ZeroForce::at_touch);
  Wall plate{.axis = 1, .side = 1.0, .position = 0.0};
  plate.extent = {0.0, 0.5};
  const std::size_t wall = dynamics.add_wall(plate);
  dynamics.push(0, {-10.0, 0.0});
  while (dynamics.specimen().grains.position[0][0] > 0.2)
    {
      dynamics.step();
      ASSERT_LT(dynamics.wall_force(wall), 1e-6 * 1e-3 * 2.0 * specimen.particle_contact.modulus);
    }
}

TEST(Plates, OnABedBearEveryGrainAsItLies)
{
  // One grain is in contact with the plate, one lies within the bed, one above it; all with the same stiffness. The
  // plate sinks by more than contacts are looked for, comes back, and rises by less than the third grain's gap.
  Specimen<2> specimen = placed_specimen({0.1, 0.1, 0.1}, {{{0.2, 0.5, 0.8}, {0.1, 0.14, 0.17}}});
  Dynamics<2> dynamics(specimen, {}, ZeroForce::as_placed);
  const std::size_t wall = dynamics.add_wall({.axis = 1, .side = 1.0, .velocity = -10.0, .bed = 0.05});
  while (dynamics.wall(wall).position > -0.2)
    {
      dynamics.step();
      ASSERT_EQ(dynamics.wall_force(wall), 0.0);
    }
  dynamics.wall(wall).velocity = 10.0;
  while (dynamics.wall_force(wall) == 0.0)
    dynamics.step();
  const auto& force = dynamics.specimen().grains.force[1];
  EXPECT_NEAR(dynamics.wall(wall).position, 0.0, 1.01 * 10.0 * dynamics.time_step());
  EXPECT_GT(force[0], 0.0);
  EXPECT_NEAR(force[1], force[0], 1e-9 * force[0]); // the same way after the same rounding of positions
  EXPECT_EQ(force[2], 0.0);
}

TEST(Plates, LoseNoEnergyUnbookedWhereAGrainSlidesOffTheirEnd)
{
  // Two smooth plates squeeze a grain by 1e-4 of its radius; it slides past the end of the lower one, and the upper one
  // throws it down. All that the lower one stored is gone then. In short steps, as a force that ends within one costs energy.
  Specimen<2> specimen = placed_specimen({0.1}, {{{0.45}, {0.1}}});
  Dynamics<2> dynamics(specimen, {.damping = 0.0, .time_step_safety = 0.02}, ZeroForce::as_placed);
  Wall plate{.axis = 1, .side = 1.0, .position = 0.0, .velocity = 0.01};
  plate.extent = {0.0, 0.5};
  const std::size_t lower = dynamics.add_wall(plate);
  const std::size_t upper = dynamics.add_wall({.axis = 1, .side = -1.0, .position = 0.2});
  while (dynamics.wall(lower).position < 2e-5)
    dynamics.step();
  dynamics.wall(lower).velocity = 0.0;
  const double squeezed = dynamics.energies().boundary_work;
  ASSERT_GT(dynamics.wall_force(upper), 0.0);
  dynamics.push(0, {10.0, 0.0});
  while (dynamics.specimen().grains.position[0][0] < 0.6)
    dynamics.step();
  EXPECT_EQ(dynamics.wall_force(lower), 0.0);
  const Energies end = dynamics.energies();
  EXPECT_GT(end.slip, 0.4 * squeezed);
  EXPECT_NEAR(end.unaccounted(), 0.0, 0.01 * squeezed);
}

TEST(Plates, ThatPivotTiltUntilTheirContactsHaveNoMoment)
{
  // Two contacts: (δ_1 - θ s_1) k_1 s_1 + (δ_2 - θ s_2) k_2 s_2 = 0.
  const std::vector<SpringOnPlate> two{{2.0, -1.0, 0.5}, {1.0, 3.0, 0.4}};
  EXPECT_NEAR(balanced_tilt(two, 0.0), (-2.0 * 0.5 + 3.0 * 0.4) / (2.0 + 9.0), 1e-14);
  EXPECT_NEAR(balanced_tilt(two, -7.0), balanced_tilt(two, 7.0), 1e-14); // wherever it comes from
  // A third one hangs free until the plate has tilted by 0.1; then it presses too.
  EXPECT_NEAR(balanced_tilt(std::vector<SpringOnPlate>{{2.0, -1.0, 0.0}, {1.0, 1.0, 0.9}, {3.0, -1.0, -0.1}}, 0.0),
              (0.9 + 3.0 * 0.1) / (2.0 + 1.0 + 3.0), 1e-14);
  // Tilted far, with overlaps of a nanometre: what is left of the moment is the rounding of its terms.
  const auto tilted = [](const double tilt) {
    std::vector<SpringOnPlate> springs;
    for (const double lever : {-1.7e-3, -0.6e-3, 0.3e-3, 1.1e-3, 1.9e-3})
      springs.push_back({1e8, lever, tilt * lever + 1e-9 * (lever < 0.0 ? 1.0 : 1.3)});
    return springs;
  };
  for (const double tilt : {1e-4, 1e-3, 1e-2})
    {
      const auto springs = tilted(tilt);
      const double found = balanced_tilt(springs, 0.0, 10);
      EXPECT_EQ(balanced_tilt(springs, 0.0), found); // more trials are not made
      double moment = 0.0, size = 0.0;
      for (const auto& spring : springs)
        if (const double overlap = spring.overlap - found * spring.lever; overlap > 0.0)
          {
            moment += overlap * spring.lever;
            size += std::abs(spring.overlap * spring.lever);
          }
      EXPECT_LT(std::abs(moment), 1e-13 * size);
      EXPECT_NEAR(found, tilt, 1e-6); // by the nanometres over levers of some millimetres
    }
  // On one side only a plate turns away as far as it must; over a gap it stays as it was.
  const std::vector<SpringOnPlate> one{{2.0, 0.5, 0.1}};
  EXPECT_DOUBLE_EQ(balanced_tilt(one, 0.0), 0.2);
  EXPECT_DOUBLE_EQ(balanced_tilt(one, 0.3), 0.3);
  const std::vector<SpringOnPlate> apart{{1.0, -1.0, -0.2}, {1.0, 1.0, -0.1}};
  EXPECT_DOUBLE_EQ(balanced_tilt(apart, 0.05), 0.05);
  EXPECT_DOUBLE_EQ(balanced_tilt(apart, -0.5), -0.1);
  EXPECT_DOUBLE_EQ(balanced_tilt({}, 0.1), 0.1);
}

template <int dim>
void expect_forces_of_a_lever()
{
  // Grains at 1 and 3 parts from the middle of a plate above them, bedded, with a gap over the nearer one, which gets three
  // times the force of the other.
  constexpr int axis = dim - 1;
  Components<dim> position;
  position[0] = {0.4, 0.8};
  position[axis] = {0.48, 0.5};
  if constexpr (dim == 3)
    position[1] = {0.5, 0.5};
  Specimen<dim> specimen = placed_specimen<dim>({0.1, 0.1}, position);
  // A quarter of the time after which the grains fly off.
  Dynamics<dim> dynamics(specimen, {.damping = 0.0, .time_step_safety = 0.02}, ZeroForce::as_placed);
  Wall plate{.axis = axis, .side = -1.0, .position = 0.6, .velocity = -1e-3, .pivots = true, .bed = 0.03};
  plate.extent = {0.0, 1.0};
  const std::size_t wall = dynamics.add_wall(plate);
  // Round-off of positions of order 1.
  const double rounding = 10.0 * std::numeric_limits<double>::epsilon() * Walls<dim>::stiffness(specimen, 0.1);
  dynamics.step(); // sees the plate where it was
  for (int k = 0; k < 40; ++k)
    {
      dynamics.step();
      const auto& force = dynamics.specimen().grains.force[axis];
      ASSERT_LT(force[1], 0.0);
      ASSERT_NEAR(force[0], 3.0 * force[1], rounding);
      ASSERT_NEAR(dynamics.wall_force(wall), -force[0] - force[1], 1e-12 * std::abs(force[0]));
      ASSERT_EQ(dynamics.specimen().grains.force[0][0], 0.0);
    }
  EXPECT_NE(dynamics.wall(wall).tilt, 0.0);
  // Work of the plate is stored in its contacts and in the grains' motion; the pivot does no work.
  EXPECT_LT(dynamics.energies().imbalance_over_work(), 0.01);
}

TEST(Plates, ThatPivotShareTheirForceAsALeverDoes)
{
  expect_forces_of_a_lever<2>();
  expect_forces_of_a_lever<3>();
}

TEST(Plates, ThatPivotFindAGrainThatTheyTiltTo)
{
  // A grain close to the pivot rises by half a thousandth; the far end of the plate comes down by forty times as much, on
  // another grain, which was not near when contacts were looked for.
  Specimen<2> specimen = placed_specimen({0.1, 0.1}, {{{0.49, 0.9}, {0.1, 0.08}}});
  Dynamics<2> dynamics(specimen, {.damping = 0.0}, ZeroForce::at_touch);
  Wall plate{.axis = 1, .side = -1.0, .position = 0.2, .pivots = true};
  plate.extent = {0.0, 1.0};
  const std::size_t wall = dynamics.add_wall(plate);
  dynamics.push(0, {0.0, 1.0});
  while (dynamics.wall_force(wall) == 0.0)
    {
      dynamics.step();
      ASSERT_LT(dynamics.specimen().grains.position[1][0], 0.1006);
    }
  EXPECT_NEAR(dynamics.wall(wall).tilt, -0.02 / 0.4, 0.002);
  const auto& force = dynamics.specimen().grains.force[1];
  EXPECT_LT(force[1], 0.0);
  EXPECT_NEAR(force[0], 40.0 * force[1], 1e-6 * std::abs(force[0]));
}

TEST(Plates, ThatPivotLetGoAGrainThatIsFarBesideThem)
{
  // Two grains on the bed of a plate of 0.8; one comes to stand beside it, without pressing.
  Specimen<2> specimen = placed_specimen({0.1, 0.1}, {{{0.2, 0.7}, {0.11, 0.11}}});
  Walls<2> walls;
  Wall plate{.axis = 1, .side = 1.0, .pivots = true, .bed = 0.03};
  EXPECT_THROW(walls.add(plate), std::logic_error); // it has no middle
  plate.extent = {0.0, 0.8};
  walls.add(plate);
  EnergyLedger ledger(2);
  const auto n_after = [&](const double place, const ZeroForce zero_force) {
    specimen.grains.position[0][1] = place;
    walls.search(specimen, {0, 2}, 0.01, zero_force, ledger);
    std::size_t n = 0;
    walls.for_each_touch([&](const Wall&, const WallTouch<2>&) { ++n; });
    return n;
  };
  EXPECT_EQ(n_after(0.7, ZeroForce::as_placed), 2u);
  EXPECT_EQ(n_after(1.19, ZeroForce::at_touch), 2u); // up to half its width
  EXPECT_EQ(n_after(1.21, ZeroForce::at_touch), 1u);
}

TEST(Plates, ThatPivotKeepAGrainThatLeavesTheirExtent)
{
  // Two grains under a plate that comes down slowly; one slides out from under it and is pressed on as before.
  Specimen<2> specimen = placed_specimen({0.1, 0.1}, {{{0.2, 0.75}, {0.1, 0.1}}});
  Dynamics<2> dynamics(specimen, {}, ZeroForce::as_placed);
  dynamics.add_wall({.axis = 1, .side = 1.0});
  Wall plate{.axis = 1, .side = -1.0, .position = 0.2, .velocity = -1e-3, .pivots = true, .bed = 0.03};
  plate.extent = {0.0, 0.8};
  const std::size_t wall = dynamics.add_wall(plate);
  dynamics.push(1, {100.0, 0.0});
  double before = 0.0;
  while (dynamics.specimen().grains.position[0][1] < 0.9)
    {
      dynamics.step();
      ASSERT_GE(dynamics.wall_force(wall), 0.9 * before);
      before = dynamics.wall_force(wall);
    }
  EXPECT_GT(before, 0.0);
}

TEST(GrainStress, HasTheMeanStressOfTheBodyAsItsMean)
{
  // Each contact's f ⊗ l is shared out between its two grains, so that both sums are the same but for round-off.
  Dynamics<2> dynamics(rock(), {}, ZeroForce::as_placed);
  for (const int axis : {0, 1})
    {
      dynamics.add_wall({axis, 1.0, 0.0, 0.0});
      const std::size_t far = dynamics.add_wall({axis, -1.0, rock().size[axis], 0.0});
      dynamics.wall(far).velocity = -0.02;
    }
  for (int k = 0; k < 800; ++k)
    dynamics.step();
  const auto stresses = dynamics.grain_stresses();
  Tensor<2> sum = Tensor<2>::Zero();
  for (std::size_t i = 0; i < stresses.size(); ++i)
    sum += stresses[i] * grain_volume<2>(dynamics.specimen().grains.radius[i], 1.0) / (1.0 - rock().report.porosity) /
           rock().volume();
  const Tensor<2> mean = dynamics.mean_stress();
  EXPECT_LT(mean(0, 0), -1e6);
  EXPECT_LT((sum - mean).norm(), 1e-9 * mean.norm());
}

TEST(NotchedBodies, HaveTheShapeFactorsOfTheirSources)
{
  // ASTM E399 tabulates K B W^1.5 / (P S) of the beam: 2.29, 2.66 and 3.14 at a/W = 0.45, 0.50 and 0.55. The measured
  // stress is 3 P S / (2 B W²), so that K over stress and √W is 2/3 of it.
  const Specimen<2> specimen = small_specimen();
  TestParameters wanted;
  const double depth = 0.020 / 4.4;
  for (const auto& [ratio, factor] : {std::pair(0.45, 2.29), std::pair(0.50, 2.66), std::pair(0.55, 3.14)})
    {
      wanted.of<NotchParameters>().ratio = ratio;
      const auto notch = (*three_point_bending.set_up<2>())(specimen, 0.0, wanted, {}).loading.notch;
      ASSERT_TRUE(notch);
      EXPECT_NEAR(notch->intensity_over_stress * 1.5 / std::sqrt(depth), factor, 0.005); // as tabulated
      EXPECT_NEAR(notch->ligament_area, depth * (1.0 - ratio), 1e-12);
    }
  // A half disc outside of 0.4 to 0.6 has a curve and no toughness.
  wanted.of<NotchParameters>().ratio = 0.3;
  EXPECT_FALSE((*semicircular_bending.set_up<2>())(specimen, 0.0, wanted, {}).loading.notch->is_valid);
  wanted.of<NotchParameters>().ratio = 0.5;
  EXPECT_TRUE((*semicircular_bending.set_up<2>())(specimen, 0.0, wanted, {}).loading.notch->is_valid);
}

/// The bonded grain that protrudes furthest towards a roller, within two mean radii of it; where its surface is, its radius.
std::pair<double, double> protruding(const Specimen<2>& half_disc, const double place, const double side)
{
  const auto fragment = fragments(half_disc);
  std::pair<double, double> furthest{1.0, 0.0};
  const auto& grains = half_disc.grains;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (fragment[i] == 0 && std::abs(grains.position[0][i] - place) <= 2.0 * half_disc.report.mean_radius)
      furthest = std::min(furthest, std::pair(side * grains.position[1][i] - grains.radius[i], grains.radius[i]));
  return {side * furthest.first, furthest.second};
}

TEST(NotchedBodies, LieWithBondedGrainsOnTheirRollers)
{
  // A half disc of 6 mm radius, with a span of 0.6 times its diameter. A grain without bonds would sink into the body and let
  // it rock.
  const auto set_up = [](const Specimen<2>& specimen) {
    return (*semicircular_bending.set_up<2>())(specimen, 0.0, {}, {});
  };
  const auto whole = set_up(rock());
  const auto& body = whole.dynamics.specimen();
  const auto& rollers = whole.dynamics.walls();
  ASSERT_EQ(rollers.size(), 3u);
  EXPECT_NEAR(rollers[0].position, protruding(body, 0.0024, 1.0).first, 1e-12);
  EXPECT_NEAR(rollers[1].position, protruding(body, 0.0096, 1.0).first, 1e-12);
  const auto [surface, radius] = protruding(body, 0.006, -1.0);
  EXPECT_NEAR(rollers[2].position, surface, 1e-12);

  Specimen<2> loosened = rock();
  const auto& radii = loosened.grains.radius;
  const auto grain = std::uint32_t(std::find(radii.begin(), radii.end(), radius) - radii.begin());
  ASSERT_LT(grain, radii.size());
  for (std::size_t j = 0; j < loosened.joints.size(); ++j)
    if (loosened.joints.grain_1[j] == grain || loosened.joints.grain_2[j] == grain)
      for (unsigned int segment = 0; segment < loosened.joints.n_segments; ++segment)
        loosened.joints.bonded[loosened.joints.segment(segment, j)] = 0.0;
  const auto without = set_up(loosened);
  const double next_surface = protruding(without.dynamics.specimen(), 0.006, -1.0).first;
  EXPECT_LT(next_surface, surface);
  EXPECT_NEAR(without.dynamics.walls().back().position, next_surface, 1e-12);
}

TEST(NotchedBodies, OfACentreCrackHaveTheIntensitiesOfIsida)
{
  // K / (σ √(πa)) by Isida's series, as the handbook of Tada, Paris and Irwin has them; without the correction for the
  // width it would be 1. Half the length of the crack is ratio W / 2.
  const Specimen<2> specimen = small_specimen();
  const double width = 0.012;
  TestParameters wanted;
  for (const auto& [ratio, factor] :
       {std::pair(0.2, 1.0246), std::pair(0.3, 1.0577), std::pair(0.5, 1.1867), std::pair(0.7, 1.4884)})
    {
      wanted.of<NotchParameters>().ratio = ratio;
      const auto notch = (*centre_cracked_plate.set_up<2>())(specimen, 0.0, wanted, {}).loading.notch;
      ASSERT_TRUE(notch);
      EXPECT_NEAR(notch->intensity_over_stress / std::sqrt(std::numbers::pi * 0.5 * ratio * width), factor,
                  1e-3 * factor);
      EXPECT_NEAR(notch->ligament_area, width * (1.0 - ratio), 1e-12);
      EXPECT_TRUE(notch->is_valid);
    }
  // Between grips that leave less than 1.2 widths there is a curve and no toughness.
  wanted.of<TensionParameters>().grip_ratio = 0.5 * (1.0 - 1.1 * 0.012 / 0.020);
  EXPECT_FALSE((*centre_cracked_plate.set_up<2>())(specimen, 0.0, wanted, {}).loading.notch->is_valid);
}

TEST(NotchedBodies, OfACentreCrackStandOnTheirShorterSide)
{
  // A specimen that lies is turned, so that its crack is across its longer side: the same crack in the same width.
  const auto lying = (*centre_cracked_plate.set_up<2>())(quarter_turned(rock()), 0.0, {}, {});
  const auto standing = (*centre_cracked_plate.set_up<2>())(rock(), 0.0, {}, {});
  EXPECT_DOUBLE_EQ(lying.loading.notch->intensity_over_stress, standing.loading.notch->intensity_over_stress);
  EXPECT_DOUBLE_EQ(lying.loading.notch->work_over_stress, standing.loading.notch->work_over_stress);
  const Specimen<2>& plate = lying.dynamics.specimen();
  EXPECT_DOUBLE_EQ(plate.size[0], 0.012);
  for (std::size_t j = 0; j < plate.joints.size(); ++j)
    {
      const auto [a, b] = ends(plate, j);
      EXPECT_FALSE(cross(a, b, {0.006 - 0.0024, 0.010}, {0.006 + 0.0024, 0.010}));
    }
  EXPECT_LT(plate.joints.size(), rock().joints.size());
}

template <int dim>
TestOutcome pull_cracked(const Specimen<dim>& specimen)
{
  TestParameters wanted;
  wanted.of<TensionParameters>().strain_rate = 0.5;
  wanted.of<TensionParameters>().sampling_strain = 1e-6;
  wanted.stop_stress_over_peak = 0.09;
  return tests::outcome_of<dim>({centre_cracked_plate}, specimen, wanted);
}

template <int dim>
void expect_breaks_from_its_crack(const TestOutcome& outcome, const Vector<dim>& size, const double mean_radius,
                                  const double end_area)
{
  const auto& record = outcome.record;
  EXPECT_EQ(record.failure, "");
  const TestResults results = evaluate(record);
  ASSERT_TRUE(results.fracture_toughness.value) << results.fracture_toughness.reason;
  ASSERT_TRUE(results.fracture_energy.value) << results.fracture_energy.reason;
  // Work of the grips is ∫ σ dε times the section times the length between them. The dynamics add force times way up
  // step by step; the rows of the curve take a hundredth of the strain at the peak each.
  double work = 0.0;
  for (std::size_t k = 1; k < record.curve.size(); ++k)
    work += 0.5 * (record.curve[k].axial_stress + record.curve[k - 1].axial_stress) *
            (record.curve[k].axial_strain - record.curve[k - 1].axial_strain);
  const double expected = record.curve.back().energies.boundary_work - record.curve.front().energies.boundary_work;
  EXPECT_GT(expected, 0.0);
  EXPECT_NEAR(work * record.notch->work_over_stress, expected, 0.02 * expected);
  EXPECT_NEAR(record.notch->ligament_area, 0.6 * end_area, 1e-9 * end_area);
  // The first crack opens within two mean diameters of a tip of the crack.
  ASSERT_FALSE(record.cracks.empty());
  const Crack& first = record.cracks.front();
  EXPECT_EQ(first.kind, CrackKind::tension);
  const double from_tip = std::abs(std::abs(first.centroid[0] - 0.5 * size[0]) - 0.2 * size[0]);
  EXPECT_LT(std::hypot(from_tip, first.centroid[dim - 1] - 0.5 * size[dim - 1]), 4.0 * mean_radius);
}

TEST(NotchedBodies, OfACentreCrackBreakFromItsTips)
{
  const auto plate = granite_box(0.030, 0.060);
  expect_breaks_from_its_crack<2>(pull_cracked(plate), plate.size, plate.report.mean_radius, 0.030);
}

TEST(NotchedBodies, OfACentreCrackBreakFromItsFrontsInSpace)
{
  // The crack runs through the depth of a box of 8 × 8 × 12 mm.
  const auto block = small_cylinder(1, 1.0, BodyShape::box);
  expect_breaks_from_its_crack<3>(pull_cracked(block), block.size, block.report.mean_radius, 0.008 * 0.008);
}

TEST(NotchedBodies, BreakFromTheNotchInTension)
{
  const auto specimen = granite_box(0.060, 0.014);
  TestParameters test_parameters;
  test_parameters.of<BendingParameters>().strain_rate = 0.5;
  test_parameters.of<BendingParameters>().sampling_strain = 1e-5;
  test_parameters.stop_stress_over_peak = 0.09;
  const TestOutcome outcome = tests::outcome_of<2>({three_point_bending}, specimen, test_parameters);
  EXPECT_EQ(outcome.record.failure, "");
  const TestResults results = evaluate(outcome.record);
  ASSERT_TRUE(results.fracture_toughness.value) << results.fracture_toughness.reason;
  EXPECT_DOUBLE_EQ(*results.fracture_toughness.value,
                   outcome.record.notch->intensity_over_stress * *results.peak_stress.value);
  ASSERT_TRUE(results.fracture_energy.value) << results.fracture_energy.reason;
  EXPECT_GT(*results.fracture_energy.value, 0.0);
  // The first crack opens within two mean diameters of the notch's tip at mid-length.
  ASSERT_FALSE(outcome.record.cracks.empty());
  const Crack& first = outcome.record.cracks.front();
  EXPECT_EQ(first.kind, CrackKind::tension);
  const double diameter = 2.0 * specimen.report.mean_radius;
  EXPECT_LT(std::hypot(first.centroid[0] - 0.030, first.centroid[1] - 0.4 * 0.060 / 4.4), 2.0 * diameter);
}

TEST(DirectShear, OfARoughFlawCarriesMoreUnderMoreNormalStress)
{
  auto specimen = granite_box(0.020, 0.012);
  put_in_flaws(specimen, {line(0.0, 0.006, 0.020, 0.006)});
  TestParameters test_parameters;
  test_parameters.of<ShearParameters>().strain_rate = 0.5;
  test_parameters.stop_strain = 0.002;
  double before = 0.0;
  for (const double normal_stress : {2e6, 8e6})
    {
      const TestOutcome outcome = tests::outcome_of<2>({direct_shear, normal_stress}, specimen, test_parameters);
      EXPECT_EQ(outcome.record.failure, "");
      const double highest = tests::highest_stress(outcome.record);
      // No plane of μ = 0.5 carries less than 0.5 σ_n; roughness adds to it.
      EXPECT_GT(highest, 0.45 * normal_stress);
      EXPECT_GT(highest, before);
      before = highest;
    }
}
} // namespace
} // namespace feldspar
