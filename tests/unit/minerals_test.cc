#include "dem/lab/laboratory_run.h"
#include "dem/lab/mineral_gauge.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/minerals/minerals.h"
#include "dem/rock/rock.h"
#include "dem/specimen/specimen_file.h"
#include "results/minerals.h"
#include "tests/temporary_folder.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>

/// Minerals in a rock: which grain is of which, and what their joints are like.
namespace feldspar
{
namespace
{
using tests::has;

constexpr double milli = 1e-3;

Mineral mineral(const std::string& name, const double share, const double size, const JointRatios& within = {})
{
  Mineral one;
  one.name = name;
  one.share = share;
  one.size = size;
  one.within = within;
  return one;
}

MineralParameters granite(const JointRatios& of_mica = {})
{
  MineralParameters wanted;
  wanted.minerals = {mineral("quartz", 0.35, 3 * milli), mineral("feldspar", 0.55, 4 * milli),
                     mineral("mica", 0.10, 2 * milli, of_mica)};
  return wanted;
}

/// A plate with some 1 600 grains.
RockParameters plate(const MineralParameters& minerals = {})
{
  RockParameters rock;
  rock.specimen.width = 20 * milli;
  rock.specimen.height = 40 * milli;
  rock.specimen.minimum_radius = 0.3 * milli;
  rock.joint = FlatJointParameters{};
  rock.minerals = minerals;
  return rock;
}

template <int dim>
std::vector<double> numbers_of(const Specimen<dim>& specimen)
{
  Joints<dim> joints = specimen.joints;
  std::vector<double> numbers(specimen.grains.mass);
  const auto take = [&](const std::string&, const auto& values) {
    numbers.insert(numbers.end(), values.begin(), values.end());
  };
  joints.visit_per_joint(take);
  joints.visit_per_segment(take);
  take("", joints.further_friction);
  return numbers;
}

TEST(Minerals, OfOneKindLeaveEveryBitOfTheRock)
{
  MineralParameters same = granite();
  for (Mineral& one : same.minerals)
    one.density = SpecimenParameters().bulk_density;
  const auto with = make_rock<2>(plate(same), 3);
  EXPECT_EQ(numbers_of(with), numbers_of(make_rock<2>(plate(), 3)));
  EXPECT_EQ(std::set<std::uint32_t>(with.mineral.begin(), with.mineral.end()).size(), 3u);
}

// Shares of the volume are met to half of the largest grain: no change of a grain to the cell beside would bring one nearer.
template <int dim>
void expect_shares(const Specimen<dim>& specimen, const MineralParameters& wanted)
{
  const double whole = specimen.grains.volume(specimen.thickness);
  const double largest = grain_volume<dim>(
    *std::max_element(specimen.grains.radius.begin(), specimen.grains.radius.end()), specimen.thickness);
  const auto shares = shares_of_minerals(specimen);
  ASSERT_EQ(shares.size(), wanted.minerals.size());
  for (std::size_t k = 0; k < shares.size(); ++k)
    {
      EXPECT_EQ(shares[k].mineral.name, wanted.minerals[k].name);
      EXPECT_NEAR(shares[k].share, *wanted.minerals[k].share, std::min(0.01, largest / whole));
    }
}

TEST(Minerals, HaveTheirSharesInThePlane)
{
  for (const std::uint64_t seed : {1, 2, 3})
    expect_shares(make_rock<2>(plate(granite()), seed), granite());
}

TEST(Minerals, HaveTheirSharesInSpaceAndInAPeriodicCell)
{
  RockParameters rock;
  rock.specimen.dimension = 3;
  rock.specimen.shape = BodyShape::periodic;
  rock.specimen.width = rock.specimen.height = 8 * milli;
  rock.specimen.minimum_radius = 0.4 * milli;
  rock.joint = FlatJointParameters{};
  rock.minerals.minerals = {mineral("quartz", 0.4, 4 * milli), mineral("feldspar", 0.6, 4 * milli)};
  const auto specimen = make_rock<3>(rock, 1);
  expect_shares(specimen, rock.minerals);
  // Cells go on across the sides: some mineral grain has joints that cross them.
  bool crosses = false;
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    crosses = crosses || (specimen.groups[specimen.joints.grain_1[j]] == specimen.groups[specimen.joints.grain_2[j]] &&
                          specimen.second_of(j).boxes != std::array<int, 3>{});
  EXPECT_TRUE(crosses);
}

// The second moments of cells with the aspect ratio r along and across differ by r² where nothing cuts them; sides and
// neighbours leave more than half of the logarithm.
TEST(Minerals, LieAlongTheirAngle)
{
  MineralParameters wanted;
  wanted.minerals = {mineral("mica", 1.0, 5 * milli)};
  wanted.minerals.front().aspect_ratio = 3.0;
  wanted.minerals.front().angle = 0.0;
  const auto specimen = make_rock<2>(plate(wanted), 1);
  std::map<std::uint32_t, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < specimen.groups.size(); ++i)
    members[specimen.groups[i]].push_back(i);
  double along = 0.0, across = 0.0;
  for (const auto& [group, grains] : members)
    for (const int c : {0, 1})
      {
        double mean = 0.0;
        for (const std::size_t i : grains)
          mean += specimen.grains.position[std::size_t(c)][i] / double(grains.size());
        for (const std::size_t i : grains)
          (c == 0 ? along : across) += std::pow(specimen.grains.position[std::size_t(c)][i] - mean, 2);
      }
  EXPECT_GT(std::sqrt(along / across), std::sqrt(3.0));
}

TEST(Minerals, HaveAStatedRuleAtBoundaries)
{
  MineralParameters wanted = granite({0.5, 0.25, 0.2, 0.6});
  wanted.boundary_strength = 0.8;
  wanted.boundaries = {{"mica", "quartz", std::nullopt, 0.1, std::nullopt, 2.0}};
  const JointRatios of_rule = boundary_ratios(wanted, 1, 2);
  EXPECT_DOUBLE_EQ(of_rule.stiffness, 2.0 * 0.5 / 1.5); // in series
  EXPECT_DOUBLE_EQ(of_rule.tensile_strength, 0.8 * 0.25);
  EXPECT_DOUBLE_EQ(of_rule.cohesion, 0.8 * 0.2);
  EXPECT_DOUBLE_EQ(of_rule.friction, 0.6);
  const JointRatios given = boundary_ratios(wanted, 0, 2);
  EXPECT_DOUBLE_EQ(given.tensile_strength, 0.8 * 0.1);
  EXPECT_DOUBLE_EQ(given.cohesion, 0.8 * 0.2);
  EXPECT_DOUBLE_EQ(given.friction, 2.0);
  EXPECT_EQ(boundary_ratios(wanted, 2, 0), given);
  EXPECT_DOUBLE_EQ(boundary_ratios(wanted, 0, 0).tensile_strength, 0.8); // between two grains of quartz
}

TEST(Minerals, GiveTheJointsTheirRatios)
{
  MineralParameters wanted = granite({0.5, 0.25, 0.2, 0.6});
  wanted.minerals[2].density = 3000.0;
  const auto plain = make_rock<2>(plate(), 1);
  const auto rock = make_rock<2>(plate(wanted), 1);
  std::set<std::pair<std::uint32_t, bool>> seen;
  for (std::size_t j = 0; j < rock.joints.size(); ++j)
    {
      const auto one = rock.joints.grain_1[j], two = rock.joints.grain_2[j];
      const bool on_boundary = rock.groups[one] != rock.groups[two];
      const JointRatios ratios = on_boundary ? boundary_ratios(wanted, rock.mineral[one], rock.mineral[two])
                                             : wanted.minerals[rock.mineral[one]].within;
      seen.insert({rock.mineral[one], on_boundary});
      EXPECT_EQ(rock.joints.normal_stiffness[j], ratios.stiffness * plain.joints.normal_stiffness[j]);
      EXPECT_EQ(rock.joints.shear_stiffness[j], ratios.stiffness * plain.joints.shear_stiffness[j]);
      EXPECT_NEAR(rock.joints.face(j).friction, ratios.friction * plain.joints.friction, 1e-15);
      EXPECT_EQ(rock.joints.tensile_strength[j], ratios.tensile_strength * plain.joints.tensile_strength[j]);
      EXPECT_EQ(rock.joints.cohesion[j], ratios.cohesion * plain.joints.cohesion[j]);
    }
  EXPECT_EQ(seen.size(), 6u); // within and at the boundaries of each
  for (std::size_t i = 0; i < rock.grains.size(); ++i)
    EXPECT_DOUBLE_EQ(rock.grains.mass[i], (rock.mineral[i] == 2 ? 3000.0 / 2700.0 : 1.0) * plain.grains.mass[i]);
  EXPECT_NEAR(rock.bulk_density, 2700.0 + 0.1 * 300.0, 1.0); // a hundredth of mica more or less are 3 kg/m³
}

// μ + the further friction of a joint is what its broken segments slide by: 0.2 + 0.3 as 0.5, bit for bit.
TEST(Minerals, OfAnotherFrictionSlideByIt)
{
  auto together = small_specimen();
  for (double& bonded : together.joints.bonded)
    bonded = 0.0;
  auto apart = together;
  together.joints.friction = 0.5;
  apart.joints.friction = 0.2;
  std::fill(apart.joints.further_friction.begin(), apart.joints.further_friction.end(), 0.3);
  const auto pressed = [](const Specimen<2>& specimen) {
    LabTest<2> test({uniaxial_compression}, specimen, quick_compression(), {});
    for (int k = 0; k < 30; ++k)
      test.advance();
    std::vector<double> course;
    for (const CurveSample& row : test.finish(true).record.curve)
      course.insert(course.end(), {row.axial_stress, row.energies.slip});
    return course;
  };
  EXPECT_EQ(pressed(together), pressed(apart));
}

/// Stripes along the axis of the tests with an edge at this place: the grain's larger part is where its centre lies.
TEST(Minerals, OfAPictureAreThoseOfTheLargestPart)
{
  constexpr std::size_t width = 200, height = 400; // of 0.1 mm
  auto map = std::make_shared<MineralMap>();
  map->width = width;
  for (std::size_t k = 0; k < width * height; ++k)
    map->colour.push_back(k % width < 80 ? 0xff0000U : k / width < 100 ? 0x00ff00U : 0x0000ffU);
  MineralParameters wanted;
  wanted.minerals = {mineral("left", 0.0, 0.0), mineral("above", 0.0, 0.0), mineral("below", 0.0, 0.0)};
  wanted.minerals[0].colour = 0xff0000;
  wanted.minerals[1].colour = 0x00ff00;
  wanted.minerals[2].colour = 0x0000ff;
  wanted.map = map;
  wanted.pixel_size = 0.1 * milli;
  const auto specimen = make_rock<2>(plate(wanted), 1);
  std::size_t n_checked = 0;
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const double x = specimen.grains.position[0][i], y = specimen.grains.position[1][i];
      const double r = specimen.grains.radius[i];
      const std::uint32_t expected = x < 8 * milli ? 0 : y > 30 * milli ? 1 : 2;
      // At the corner of three minerals, and where an edge passes a centre closely, the parts are nearly equal.
      const bool at_corner = std::hypot(x - 8 * milli, y - 30 * milli) < r;
      if (at_corner || std::abs(x - 8 * milli) < 0.1 * r || std::abs(y - 30 * milli) < 0.1 * r)
        continue;
      EXPECT_EQ(specimen.mineral[i], expected) << x << ' ' << y;
      ++n_checked;
    }
  EXPECT_GT(n_checked, specimen.grains.size() * 9 / 10);
  std::map<std::uint32_t, std::size_t> members;
  for (const std::uint32_t group : specimen.groups)
    ++members[group];
  // Each hangs together, but for single grains that no joint holds.
  EXPECT_EQ(std::ranges::count_if(members, [](const auto& group) { return group.second > 1; }), 3);
}

// A straight edge cuts grains of a radius R at any offset h; of each the smaller part is shown wrongly. Its mean area over h is
// (1/2R) ∫ segment = (2/3)R², so that of stripes of the width w the share 4R/(3π w) of the area is wrong, 0.21 diameters over w.
TEST(Minerals, OfAPictureAgreeWithItButAlongEdges)
{
  constexpr std::size_t width = 400, height = 800; // of 0.05 mm
  constexpr double pixel = 0.05 * milli, stripe = 5 * milli;
  auto map = std::make_shared<MineralMap>();
  map->width = width;
  const auto is_odd = [](const double x) { return int(x / stripe) % 2 == 1; };
  for (std::size_t k = 0; k < width * height; ++k)
    map->colour.push_back(is_odd((double(k % width) + 0.5) * pixel) ? 1 : 0);
  MineralParameters wanted;
  wanted.minerals = {mineral("even", 0.0, 0.0), mineral("odd", 0.0, 0.0)};
  wanted.minerals[1].colour = 1;
  wanted.map = map;
  wanted.pixel_size = pixel;
  double n_wrong = 0.0, n = 0.0, cubes = 0.0, squares = 0.0;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      const auto specimen = make_rock<2>(plate(wanted), seed);
      for (std::size_t i = 0; i < specimen.grains.size(); ++i)
        {
          const double r = specimen.grains.radius[i];
          cubes += r * r * r;
          squares += r * r;
          for (double x = -r; x < r; x += 0.5 * pixel)
            for (double y = -r; y < r; y += 0.5 * pixel)
              if (x * x + y * y < r * r)
                {
                  n += 1.0;
                  n_wrong += is_odd(specimen.grains.position[0][i] + x) != (specimen.mineral[i] == 1);
                }
        }
    }
  const double per_stripe = 4.0 / (3.0 * std::numbers::pi) * cubes / squares / stripe;
  const double n_edges_over_n_stripes = 3.0 / 4.0;
  // Some 400 grains at the edges scatter by a tenth; walls put grains in order.
  EXPECT_NEAR(n_wrong / n, n_edges_over_n_stripes * per_stripe, 0.2 * per_stripe);
}

TEST(Minerals, OfPointsAreThoseOfTheNearest)
{
  auto map = std::make_shared<MineralMap>();
  map->place = {{5 * milli, 5 * milli, 0.0},
                {15 * milli, 5 * milli, 0.0},
                {5 * milli, 35 * milli, 0.0},
                {15 * milli, 35 * milli, 0.0}};
  map->mineral_of_point = {"quartz", "mica", "quartz", "mica"};
  MineralParameters wanted;
  wanted.minerals = {mineral("mica", 0.0, 0.0), mineral("quartz", 0.0, 0.0)};
  wanted.map = map;
  const auto specimen = make_rock<2>(plate(wanted), 1);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    if (const double x = specimen.grains.position[0][i]; std::abs(x - 10 * milli) > 0.1 * specimen.grains.radius[i])
      {
        EXPECT_EQ(specimen.mineral[i], x < 10 * milli ? 1u : 0u);
      }
}

TEST(Minerals, WithSmoothBoundariesAreAGrainBasedModel)
{
  MineralParameters wanted = granite({0.5, 0.25, 0.2, 0.6});
  wanted.form = MineralGrainForm::smooth_boundaries;
  RockParameters rock = plate(wanted);
  rock.smooth_joint.tensile_strength = 10e6;
  const auto specimen = make_rock<2>(rock, 1);
  ASSERT_GT(specimen.smooth_joints.size(), 100u);
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    EXPECT_TRUE(specimen.groups[specimen.joints.grain_1[j]] == specimen.groups[specimen.joints.grain_2[j]] ||
                !specimen.joints.holds(j));
  for (const auto& joint : specimen.smooth_joints)
    {
      const JointRatios ratios =
        boundary_ratios(wanted, specimen.mineral[joint.grain_1], specimen.mineral[joint.grain_2]);
      EXPECT_DOUBLE_EQ(joint.face.bond.tensile_strength, ratios.tensile_strength * 10e6);
      EXPECT_DOUBLE_EQ(joint.face.normal_stiffness, ratios.stiffness * rock.smooth_joint.normal_stiffness);
    }
}

TEST(Minerals, ThatAreRigidMoveAsClumps)
{
  MineralParameters wanted = granite();
  wanted.form = MineralGrainForm::rigid;
  const auto specimen = make_rock<2>(plate(wanted), 1);
  EXPECT_TRUE(specimen.groups_are_rigid);
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    EXPECT_NE(specimen.groups[specimen.joints.grain_1[j]], specimen.groups[specimen.joints.grain_2[j]]);
  std::map<std::uint32_t, std::uint32_t> mineral_of; // one for each clump
  for (std::size_t i = 0; i < specimen.groups.size(); ++i)
    EXPECT_EQ(mineral_of.emplace(specimen.groups[i], specimen.mineral[i]).first->second, specimen.mineral[i]);
  const tests::TemporaryFolder folder;
  write_specimen(specimen, folder.path() / "a.h5");
  EXPECT_EQ(read_specimen<2>(folder.path() / "a.h5").mineral, specimen.mineral);
}

TEST(Minerals, ComeBackFromAFile)
{
  const tests::TemporaryFolder folder;
  const auto specimen = make_rock<2>(plate(granite({0.5, 0.25, 0.2, 0.6})), 1);
  write_specimen(specimen, folder.path() / "a.h5");
  const auto back = read_specimen<2>(folder.path() / "a.h5");
  EXPECT_EQ(back.mineral, specimen.mineral);
  EXPECT_EQ(back.groups, specimen.groups);
  EXPECT_EQ(back.minerals.at(2).name, "mica");
  EXPECT_EQ(numbers_of(back), numbers_of(specimen));
}

TEST(Minerals, ThatDoNotFitAreRefused)
{
  const auto refusal = [](const MineralParameters& wanted) {
    return tests::refusal([&] { make_rock<2>(plate(wanted), 1); });
  };
  MineralParameters wanted = granite();
  wanted.minerals[2].size = 0.5 * milli;
  EXPECT_TRUE(has(refusal(wanted),
                  "0.5 mm of mica: must be at least two mean diameters of the particles that make up a mineral grain"));
  wanted.minerals[2].size = 40 * milli;
  EXPECT_TRUE(has(refusal(wanted), "must be at most"));
}

/// The same rock in a homogeneous deformation u = G x, with a rotation.
template <int dim>
void expect_strain_in_each_mineral(RockParameters rock)
{
  rock.specimen.dimension = dim;
  Specimen<dim> specimen = make_rock<dim>(rock, 1);
  const std::vector<bool> all(specimen.grains.size(), true);
  const Components<dim> undeformed = specimen.grains.position;
  const MineralGauge<dim> gauge(specimen, undeformed, all);
  Tensor<dim> gradient;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      gradient(a, b) = 1e-3 * (1.0 + a - 0.7 * b * b);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    set<dim>(specimen.grains.position, i, at<dim>(undeformed, i) + gradient * at<dim>(undeformed, i));
  const auto strains = gauge.strains(specimen);
  std::size_t c = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b, ++c)
      for (std::size_t k = 0; k < specimen.minerals.size(); ++k)
        EXPECT_NEAR(strains[c][k], b < dim ? 0.5 * (gradient(a, b) + gradient(b, a)) : 0.0, 1e-14) << k; // of 1e-3
}

TEST(Minerals, AreStrainedAsTheSpecimenByAHomogeneousDeformation)
{
  RockParameters rock = plate(granite());
  expect_strain_in_each_mineral<2>(rock);
  rock.specimen.width = rock.specimen.height = 8 * milli;
  rock.specimen.minimum_radius = 0.4 * milli;
  expect_strain_in_each_mineral<3>(rock);
}

// Layers of 5 mm: those of one mineral are strained by ε along the axis, those of the other one are rigid. The strain of the plate
// is ε times the share of the first. A pair of grains across the side of a layer has a part of ε; with grains of 0.8 mm such
// pairs are some 0.8 / 5 of all, and half of each counts for either mineral. A least-squares fit through all grains of a
// mineral would find the strain of the plate in both.
TEST(Minerals, AreEachStrainedByTheirOwnDeformation)
{
  Specimen<2> specimen = make_rock<2>(plate(granite()), 1);
  const double layer = 5 * milli, strain = 1e-3;
  specimen.minerals.resize(2);
  const Components<2> undeformed = specimen.grains.position;
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const double y = undeformed[1][i];
      const double n_below = std::floor(y / layer);
      const bool is_strained = std::fmod(n_below, 2.0) == 1.0;
      specimen.mineral[i] = is_strained;
      specimen.grains.position[1][i] +=
        strain * (layer * std::floor(0.5 * n_below) + (is_strained ? y - n_below * layer : 0.0));
    }
  const auto yy =
    MineralGauge<2>(specimen, undeformed, std::vector<bool>(specimen.grains.size(), true)).strains(specimen)[3];
  const double of_pairs_across = 0.5 * 0.8 * milli / layer * strain;
  EXPECT_NEAR(yy[0], 0.0, of_pairs_across);
  EXPECT_NEAR(yy[1], strain, of_pairs_across);
  const auto shares = shares_of_minerals(specimen);
  EXPECT_NEAR(shares[0].share * yy[0] + shares[1].share * yy[1], shares[1].share * strain, 0.02 * strain);
}

// The cracks are all in some mineral or between two; the means of the minerals add up to that of all grains.
TEST(Minerals, ShareCracksAndStress)
{
  RockParameters rock = plate(granite({1.0, 0.1, 0.1, 1.0}));
  rock.specimen.height = 20 * milli;
  const auto specimen = make_rock<2>(rock, 1);
  const auto outcome = tests::outcome_of<2>({uniaxial_compression}, specimen, quick_compression());
  const auto& cracks = outcome.record.cracks;
  ASSERT_GT(cracks.size(), 100u);
  const Snapshot& snapshot = outcome.appearance.snapshots.at(outcome.appearance.snapshots.size() / 2);
  const auto& grains = outcome.appearance.grains_at_end;
  const auto means = mineral_means(outcome.record, snapshot, grains);
  std::uint64_t n_within = 0, n_on_boundaries = 0;
  const auto& at_end = outcome.appearance.snapshots.back();
  for (const MineralMeans& of_mineral : mineral_means(outcome.record, at_end, grains))
    n_within += of_mineral.n_cracks_within;
  for (const Crack& crack : cracks)
    n_on_boundaries += crack.on_boundary && crack.step <= at_end.step;
  EXPECT_GT(n_on_boundaries, 0u);
  EXPECT_EQ(n_within + n_on_boundaries, std::size_t(std::ranges::count_if(cracks, [&](const Crack& crack) {
              return crack.step <= at_end.step && crack.mineral_1 > 0 && crack.mineral_1 <= crack.mineral_2;
            })));
  double of_minerals = 0.0, of_grains = 0.0, volume = 0.0;
  for (std::size_t k = 0; k < means.size(); ++k)
    of_minerals += outcome.record.minerals[k].share * means[k].stress[3];
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      of_grains += std::pow(grains[i].radius, 2) * snapshot.stress[3][i];
      volume += std::pow(grains[i].radius, 2);
    }
  EXPECT_NEAR(of_minerals, of_grains / volume, 1e-10 * std::abs(of_minerals));
  // Their strains add up to that between the platens but for the pores along these.
  double strain = 0.0;
  for (std::size_t k = 0; k < means.size(); ++k)
    strain += outcome.record.minerals[k].share * means[k].strain[3];
  EXPECT_NEAR(strain, snapshot.axial_strain, 0.05 * std::abs(snapshot.axial_strain));
  EXPECT_LT(of_minerals, -1e6);
}
} // namespace
} // namespace feldspar
