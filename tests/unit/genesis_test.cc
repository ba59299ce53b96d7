#include "base/input_error.h"
#include "base/random.h"
#include "dem/genesis/grain_sizes.h"
#include "dem/genesis/packing_export.h"
#include "dem/genesis/packing_file.h"
#include "dem/genesis/packing_table.h"
#include "dem/laws/draw_bond.h"
#include "dem/specimen/fragments.h"
#include "dem/specimen/neighbours.h"
#include "tests/unit/small_specimen.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <tuple>

namespace feldspar
{
namespace
{
using tests::has;

TEST(Genesis, MeetsWhatItPromises)
{
  const auto specimen = small_specimen();
  const auto& report = specimen.report;
  EXPECT_NEAR(report.packing_stress, 1e-4 * 80e9, 0.01 * 1e-4 * 80e9);
  // Walls leave voids some 0.15 diameters wide: 4 % of this small box's area, so 2 % of the radii.
  EXPECT_NEAR(report.radius_multiplier, 0.98, 0.015);
  // The number of joints is the nearest whole number.
  EXPECT_NEAR(report.coordination_number, 4.2, 1.0 / double(report.n_grains));
  // Stress free and at rest.
  for (const double opening : specimen.joints.opening)
    EXPECT_EQ(opening, 0.0);
  for (const auto& component : specimen.grains.velocity)
    for (const double v : component)
      EXPECT_EQ(v, 0.0);
  // Bulk density over the box, whatever the porosity came out as.
  double mass = 0.0;
  for (const double m : specimen.grains.mass)
    mass += m;
  EXPECT_NEAR(mass, 2700.0 * specimen.volume(), 1e-9 * mass);
}

TEST(Genesis, PacksToTheStressAskedForWithTheOverlapsThatCarryIt)
{
  // The mean stress of N discs with z contacts each, of force E t δ and branch 2R, in an area NπR²/φ is
  // zφEδ/(2πR): with z = 4 and φ = 0.84 overlaps are δ/R = 1.87 P/E. Uneven grains have contacts softer by
  // min(R1, R2)/R, 0.917 on average of radii drawn evenly between R1 and 1.66 R1: 2.04 P/E. Walls leave voids, and contacts
  // that press little count too.
  for (const bool by_descent : {true, false})
    for (const double ratio : {1e-4, 4e-4, 1e-3})
      {
        SpecimenParameters wanted;
        wanted.width = 0.02;
        wanted.height = 0.03;
        wanted.packing_stress_ratio = ratio;
        wanted.packed_by_descent = by_descent;
        FlatJointParameters flat_joint;
        flat_joint.coordination_number = 4.2;
        const auto report = make_specimen<2>(wanted, flat_joint, {}, 1).report;
        EXPECT_NEAR(report.packing_stress, ratio * 80e9, (by_descent ? 1e-3 : 1e-2) * ratio * 80e9);
        EXPECT_NEAR(report.mean_overlap_ratio / ratio, 2.04, 0.2 * 2.04) << ratio;
      }
}

TEST(Genesis, SameSeedSameBitsOtherSeedOtherRock)
{
  const auto one = small_specimen(5);
  const auto again = small_specimen(5);
  const auto other = small_specimen(6);
  EXPECT_EQ(one.grains.position, again.grains.position);
  EXPECT_EQ(one.joints.tensile_strength, again.joints.tensile_strength);
  EXPECT_NE(one.joints.tensile_strength, other.joints.tensile_strength);
}

TEST(Genesis, TheGapOfACoordinationNumberGivesThatCoordinationNumber)
{
  auto specimen = small_specimen();
  const auto n_joints = specimen.joints.size();
  FlatJointParameters by_gap;
  by_gap.installation_gap_ratio = specimen.report.installation_gap_ratio * (1.0 + 1e-9);
  install_joints(specimen, by_gap);
  EXPECT_EQ(specimen.joints.size(), n_joints);
}

TEST(Genesis, StrengthsHaveTheirMeanAndDeviation)
{
  FlatJointParameters flat_joint;
  flat_joint.bond_tensile_strength_deviation = 2.2e6;
  const auto specimen = granite_box(0.02, 0.04, flat_joint, 4);
  const auto& strength = specimen.joints.tensile_strength;
  const auto n = double(strength.size());
  double mean = 0.0;
  double squares = 0.0;
  for (const double s : strength)
    mean += s / n;
  for (const double s : strength)
    squares += (s - mean) * (s - mean) / n;
  // Four standard errors: sd/√n and sd/√(2n).
  EXPECT_NEAR(mean, 22e6, 4.0 * 2.2e6 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares), 2.2e6, 4.0 * 2.2e6 / std::sqrt(2.0 * n));

  flat_joint.strength_draw = StrengthDraw::per_contact;
  const auto per_contact = granite_box(0.02, 0.04, flat_joint, 4);
  for (std::size_t j = 0; j < per_contact.joints.size(); ++j)
    for (unsigned int i = 1; i < 4; ++i)
      EXPECT_EQ(per_contact.joints.cohesion[per_contact.joints.segment(i, j)],
                per_contact.joints.cohesion[per_contact.joints.segment(0, j)]);
}

// A share of 1 - 1/e of a Weibull distribution lies below its scale, whatever its modulus.
TEST(Genesis, WeibullStrengthsHaveTheirMeanDeviationAndModulus)
{
  // Standard deviation over mean of moduli 1 (exponential: 1), 2 (Rayleigh: sqrt(4/π - 1)) and 10 (by its Γ functions).
  EXPECT_NEAR(weibull_modulus(1.0), 1.0, 1e-9);
  EXPECT_NEAR(weibull_modulus(std::sqrt(4.0 / std::numbers::pi - 1.0)), 2.0, 1e-9);
  EXPECT_NEAR(weibull_modulus(0.1203102189311583), 10.0, 1e-9);
  EXPECT_NEAR(weibull_modulus(0.9e-3) * 0.9e-3, weibull_modulus(1.1e-3) * 1.1e-3, 1e-3); // across the limit

  constexpr double deviation = 0.1203102189311583 * 22e6;
  const double scale = 22e6 / std::tgamma(1.1);
  constexpr int n = 40000;
  Random random(3, RandomStream::strengths);
  double sum = 0.0, squares = 0.0;
  int n_below = 0;
  for (int k = 0; k < n; ++k)
    {
      const double strength = draw_strength(StrengthDistribution::weibull, 22e6, deviation, random);
      sum += strength;
      squares += (strength - 22e6) * (strength - 22e6);
      n_below += strength < scale;
    }
  // Four standard errors; the kurtosis is near that of the normal distribution.
  EXPECT_NEAR(sum / n, 22e6, 4.0 * deviation / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), deviation, 4.0 * deviation / std::sqrt(2.0 * n));
  EXPECT_NEAR(double(n_below) / n, 1.0 - std::exp(-1.0), 4.0 * 0.482 / std::sqrt(n));

  FlatJointParameters flat_joint;
  flat_joint.strength_distribution = StrengthDistribution::weibull;
  const auto weibull = small_specimen(1, 1.0, flat_joint);
  EXPECT_NE(weibull.joints.tensile_strength, small_specimen().joints.tensile_strength);
}

TEST(Genesis, RadiiHaveTheDistributionThatIsWanted)
{
  SpecimenParameters wanted;
  wanted.minimum_radius = 1e-3;
  wanted.radius_ratio = 4.0;
  // The middle of the normal ones is the mean, of the radius (2.5 mm) or of its logarithm (2 mm); the deviation is a sixth of the
  // way, less what the bounds at three of them cut off, 1.3 %.
  for (const auto& [distribution, mean, deviation] :
       {std::tuple(SizeDistribution::uniform, 2.5e-3, 3e-3 / std::sqrt(12.0)),
        {SizeDistribution::normal, 2.5e-3, 0.9867 * 0.5e-3},
        {SizeDistribution::log_normal, std::log(2e-3), 0.9867 * std::log(4.0) / 6.0}})
    {
      wanted.size_distribution = distribution;
      constexpr double solid = 0.4; // [m²]
      const auto radii = draw_radii<2>(wanted, solid, 1.0, 1);
      const auto n = double(radii.size());
      // Four standard errors of the mean area of n grains, whose deviation is at most its mean.
      EXPECT_NEAR(n, expected_number(wanted, solid), 4.0 * std::sqrt(n));
      double sum = 0.0, squares = 0.0;
      for (const double radius : radii)
        {
          const double value = distribution == SizeDistribution::log_normal ? std::log(radius) : radius;
          sum += value;
          squares += (value - mean) * (value - mean);
          EXPECT_TRUE(radius >= 1e-3 && radius <= 4e-3);
        }
      EXPECT_NEAR(sum / n, mean, 4.0 * deviation / std::sqrt(n));
      EXPECT_NEAR(std::sqrt(squares / n), deviation, 4.0 * deviation / std::sqrt(2.0 * n));
    }
}

TEST(Genesis, ASieveCurveComesOutAsItWentIn)
{
  SpecimenParameters wanted;
  wanted.shape = BodyShape::periodic;
  wanted.width = 0.06;
  wanted.height = 0.06;
  wanted.sieve_curve = {{0.8e-3, 0.0}, {1.2e-3, 0.3}, {1.6e-3, 0.5}, {2.4e-3, 1.0}};
  const auto packed = make_specimen<2>(wanted, FlatJointParameters{}, {}, 1);
  // Walls and stress scale all sizes by one factor, which the report names.
  const double factor = packed.report.radius_multiplier;
  EXPECT_NEAR(factor, 1.0, 0.01);
  // Poisson statistics: the deviation of the number of each class is at most its root, that of all the root of all.
  const auto n = double(packed.grains.size());
  EXPECT_NEAR(n, expected_number(wanted, (1.0 - wanted.porosity) * 36e-4), 4.0 * std::sqrt(n));
  double solid = 0.0;
  for (const double radius : packed.grains.radius)
    solid += radius * radius;
  for (std::size_t k = 1; k < wanted.sieve_curve.size(); ++k)
    {
      const auto& [size, passing] = wanted.sieve_curve[k];
      double retained = 0.0;
      double mean_logarithm = 0.0;
      for (const double radius : packed.grains.radius)
        if (radius / factor > 0.5 * wanted.sieve_curve[k - 1].size && radius / factor <= 0.5 * size * (1.0 + 1e-12))
          {
            retained += radius * radius / solid;
            mean_logarithm += radius * radius / solid * std::log(2.0 * radius / factor);
          }
      const double wanted_share = passing - wanted.sieve_curve[k - 1].passing;
      // Half of the largest grain of a class is 0.5 % of the smallest class here.
      EXPECT_NEAR(retained, wanted_share, 0.01 * wanted_share) << size;
      // The mass lies evenly over the logarithm: its mean is half-way, to four standard errors of some 300 grains or more.
      const double log_width = std::log(size / wanted.sieve_curve[k - 1].size);
      EXPECT_NEAR(mean_logarithm / retained, std::log(size) - 0.5 * log_width,
                  4.0 * log_width / std::sqrt(12.0 * 300.0))
        << size;
    }

  // Spheres: the number falls with the third power of the size.
  wanted.dimension = 3;
  const double volume = 1e-5;
  const auto radii = draw_radii<3>(wanted, volume, 1.0, 2);
  EXPECT_NEAR(double(radii.size()), expected_number(wanted, volume), 4.0 * std::sqrt(double(radii.size())));
  double below = 0.0;
  for (const double radius : radii)
    below += radius <= 0.6e-3 ? 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3) : 0.0;
  EXPECT_NEAR(below, 0.3 * volume, 0.01 * 0.3 * volume);
}

TEST(Genesis, DrawsGappedAndSlitJointsByLot)
{
  auto specimen = small_specimen();
  FlatJointParameters wanted;
  wanted.coordination_number = 4.2;
  wanted.gapped_fraction = 0.25;
  wanted.slit_fraction = 0.25;
  wanted.initial_gap = 1e-6;
  install_joints(specimen, wanted);
  const auto& joints = specimen.joints;
  std::size_t n_gapped = 0;
  std::size_t n_slit = 0;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (!joints.holds(j))
      ++(joints.opening[j] > 0.0 ? n_gapped : n_slit);
  EXPECT_EQ(n_gapped, std::size_t(std::llround(0.25 * double(joints.size()))));
  EXPECT_EQ(n_slit, n_gapped);
}

TEST(Genesis, SaysWhichCoordinationNumbersCanBeHad)
{
  auto specimen = small_specimen();
  for (const double z : {1.0, 40.0})
    {
      FlatJointParameters wanted;
      wanted.coordination_number = z;
      EXPECT_TRUE(has(tests::refusal([&] { install_joints(specimen, wanted); }), "this packing allows")) << z;
    }
}

// The search for contacts among millions of grains takes seconds, in which nobody waits for a run that was asked to
// end. For 30 000 grains it asks three times, and goes over their pairs once more in the dynamics, which also asks
// between its parts.
TEST(Genesis, CanBeEndedWithinAStep)
{
  struct Ended
  {
  };
  SpecimenParameters wanted;
  wanted.width = wanted.height = 0.28;
  for (const bool by_descent : {false, true})
    {
      wanted.packed_by_descent = by_descent;
      const int most_in_a_step = by_descent ? 3 : 8;
      int n_in_step = 0;
      const auto start = [&] { n_in_step = 0; };
      const auto end = [&] {
        if (++n_in_step == most_in_a_step)
          throw Ended();
      };
      EXPECT_THROW(make_specimen<2>(wanted, {}, {}, 1, start, end), Ended) << by_descent;
    }
}

TEST(Neighbours, AreThoseOfEveryPairTried)
{
  const auto specimen = small_specimen();
  const auto& grains = specimen.grains;
  const double gap = 3e-4;
  std::vector<GrainPair> tried;
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    for (std::uint32_t j = i + 1; j < grains.size(); ++j)
      if ((at<2>(grains.position, j) - at<2>(grains.position, i)).norm() < grains.radius[i] + grains.radius[j] + gap)
        tried.emplace_back(i, j);
  EXPECT_EQ(pairs_within(grains, gap), tried);
}

TEST(Fragments, FollowTheBonds)
{
  auto specimen = small_specimen();
  EXPECT_EQ(fragments(specimen.joints, specimen.grains.size())[0], 0u);
  // Cut everything off grain 0.
  auto& joints = specimen.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints.grain_1[j] == 0)
      for (unsigned int i = 0; i < joints.n_segments; ++i)
        joints.bonded[joints.segment(i, j)] = 0.0;
  const auto number = fragments(joints, specimen.grains.size());
  EXPECT_GT(number[0], 0u);
  EXPECT_EQ(number[1], 0u);
}

/// A packing file in the temporary folder, gone at the end.
class PackingFile
{
public:
  explicit PackingFile(const std::string& text)
    : path(std::filesystem::temp_directory_path() /
           (std::string("packing_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt"))
  {
    std::ofstream(path) << text;
  }
  ~PackingFile() { std::filesystem::remove(path); }
  PackingFile(const PackingFile&) = delete;
  PackingFile& operator=(const PackingFile&) = delete;

  SpecimenParameters wanted() const
  {
    SpecimenParameters parameters;
    parameters.width = 0.01;
    parameters.height = 0.01;
    parameters.packing_file = path.string();
    return parameters;
  }

  template <int dim = 2>
  std::string refusal(const BodyShape shape = BodyShape::box) const
  {
    FlatJointParameters flat_joint;
    flat_joint.installation_gap_ratio = 0.1;
    SpecimenParameters parameters = wanted();
    parameters.dimension = dim;
    parameters.shape = shape;
    return tests::refusal([&] { make_specimen<dim>(parameters, flat_joint, {}, 1); });
  }

private:
  std::filesystem::path path;
};

TEST(PackingImport, TakesGrainsAsTheyAre)
{
  const PackingFile file("# a row of three\n0.002 0.005 0.001\n0.004 0.005 0.001\n\n0.00599 0.005 1e-3 # touches\n");
  FlatJointParameters flat_joint;
  flat_joint.installation_gap_ratio = 0.01;
  const auto specimen = make_specimen<2>(file.wanted(), flat_joint, {}, 1);
  EXPECT_EQ(specimen.grains.size(), 3u);
  EXPECT_EQ(specimen.joints.size(), 2u);
}

// Three grains in a row that touch, as other programs write them: each file gives the same grains, to the last bit.
TEST(PackingImport, ReadsTheFormsOfOtherPrograms)
{
  const auto grains_of = [](const std::string& text, const int dim) {
    const PackingFile file(text);
    std::vector<double> numbers;
    for (const auto& grain : read_packing_table(file.wanted().packing_file, dim, 1.0, [] {}).grains)
      {
        numbers.insert(numbers.end(), grain.position.begin(), grain.position.end());
        numbers.push_back(grain.radius);
      }
    return numbers;
  };
  const std::vector<double> in_plane{0.002, 0.005, 0.001, 0.004, 0.005, 0.001, 0.006, 0.004, 0.0005};
  const std::vector<double> in_space{0.002, 0.005, 0.003, 0.001, 0.004, 0.005,
                                     0.003, 0.001, 0.006, 0.004, 0.002, 0.0005};
  for (const char* const text :
       {"0.002 0.005 0.001\n0.004 0.005 0.001\n0.006 0.004 0.0005\n",
        "#format x_y_z_r\n0.002\t0.005\t0\t0.001\n0.004\t0.005\t0\t0.001\n0.006\t0.004\t0\t0.0005\n", // YADE
        "#format x_y_z_r_matId\n0.002\t0.005\t0\t0.001\t3\n0.004\t0.005\t0\t0.001\t3\n0.006\t0.004\t0\t0.0005\t3\n",
        "0 0.002 0.005 0.001\n1 0.004 0.005 0.001\n2 0.006 0.004 0.0005\n",
        "7 0.002 0.005 0.1 0.001\n8 0.004 0.005 0.1 0.001\n9 0.006 0.004 0.1 0.0005\n",
        "id,x [mm],y [mm],d [mm],group\n1,2,5,2,rock\n2,4,5,2,rock\n3,6,4,1,rock\n",
        "\xef\xbb\xbfx [mm];y [mm];r [mm]\r\n2,0;5;1\r\n4;5,00;1\r\n6;4;0,5\r\n", // Excel in German
        "0,002;0,005;0,001\n0,004;0,005;0,001\n0,006;0,004;0,0005\n",
        "\"ID\";\"Radius\";\"Y\";\"X\"\n1;0.001;0.005;0.002\n2;0.001;0.005;0.004\n3;0.0005;0.004;0.006\n",
        "start_x_m,start_y_m,start_z_m,x_m,y_m,z_m,radius_m,fragment,mineral_grain\n"
        "0.002,0.005,0,1,1,1,0.001,0,0\n0.004,0.005,0,1,1,1,0.001,0,0\n0.006,0.004,0,1,1,1,0.0005,0,0\n"})
    EXPECT_EQ(grains_of(text, 2), in_plane) << text;
  for (const char* const text :
       {"0.002 0.005 0.003 0.001\n0.004 0.005 0.003 0.001\n0.006 0.004 0.002 0.0005\n",
        "1 0.002 0.005 0.003 0.001\n2 0.004 0.005 0.003 0.001\n3 0.006 0.004 0.002 0.0005\n",
        // The last step of a dump counts.
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
        "ITEM: ATOMS id type radius x y z\n1 1 1 1 1 1\n"
        "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ff ff ff\n0 0.01\n0 0.01\n0 0.01\n"
        "ITEM: ATOMS id type radius x y z\n1 1 0.001 0.002 0.005 0.003\n2 1 0.001 0.004 0.005 0.003\n"
        "3 1 0.0005 0.006 0.004 0.002\n",
        "LAMMPS data file via write_data\n\n3 atoms\n1 atom types\n\n0 0.01 xlo xhi\n0 0.01 ylo yhi\n0 0.01 zlo zhi\n\n"
        "Atoms # sphere\n\n1 1 0.002 2500 0.002 0.005 0.003 0 0 0\n2 1 0.002 2500 0.004 0.005 0.003 0 0 0\n"
        "3 1 0.001 2500 0.006 0.004 0.002 0 0 0\n\nVelocities\n\n1 0 0 0 0 0 0\n",
        "a packing of somebody\n\n3 atoms\n1 atom types\n\n0 0.01 xlo xhi\n0 0.01 ylo yhi\n0 0.01 zlo zhi\n\n"
        "Masses\n\n1 1\n\nAtoms # bpm/sphere\n\n1 1 1 0.002 2500 0.002 0.005 0.003\n"
        "2 1 1 0.002 2500 0.004 0.005 0.003\n3 1 1 0.001 2500 0.006 0.004 0.002\n",
        "LAMMPS data file\n\nAtoms # hybrid bond sphere\n\n1 1 0.002 0.005 0.003 1 0.002 2500\n"
        "2 1 0.004 0.005 0.003 1 0.002 2500\n3 1 0.006 0.004 0.002 1 0.001 2500\n"})
    EXPECT_EQ(grains_of(text, 3), in_space) << text;
  // A box that begins elsewhere.
  EXPECT_EQ(grains_of("# LAMMPS data\n-0.5 0.5 xlo xhi\n-0.25 0.25 ylo yhi\nAtoms\n\n1 1 0.5 1 0.25 0.125 0\n", 2),
            (std::vector<double>{0.75, 0.375, 0.25}));
}

// Four grains in a row. The file bonds two that touch and two with a gap of 0.6 mm, two thirds of the mean radius, where the
// installation gap would join none.
TEST(PackingImport, JoinsExactlyTheGrainsThatTheFileBonds)
{
  const std::string atoms = "LAMMPS data file\n\n4 atoms\n3 bonds\n\nAtoms # bpm/sphere\n\n"
                            "11 1 1 0.002 1 0.001 0.005 0\n7 1 1 0.002 1 0.003 0.005 0\n"
                            "5 1 1 0.0014 1 0.0053 0.005 0\n9 1 1 0.002 1 0.009 0.005 0\n\nBonds\n\n1 1 7 11\n";
  const PackingFile file(atoms + "2 1 5 7\n3 1 7 5\n");
  const auto joined = make_specimen<2>(file.wanted(), FlatJointParameters{}, {}, 1);
  ASSERT_EQ(joined.joints.size(), 2u); // a pair has one joint
  std::vector<double> distances(joined.joints.rest_distance.begin(), joined.joints.rest_distance.begin() + 2);
  std::sort(distances.begin(), distances.end());
  EXPECT_NEAR(distances[0], 0.002, 1e-12);
  EXPECT_NEAR(distances[1], 0.0023, 1e-12);
  EXPECT_NEAR(joined.report.installation_gap_ratio, 0.0006 / joined.report.mean_radius, 1e-9);
  FlatJointParameters by_number;
  by_number.installation_gap_ratio.reset();
  by_number.coordination_number = 2.0;
  EXPECT_THROW(make_specimen<2>(file.wanted(), by_number, {}, 1), InputError);

  EXPECT_TRUE(has(PackingFile(atoms + "2 1 9 5\n").refusal(), "a bond joins grains with a gap of 0.002 m; allowed is"));
  EXPECT_TRUE(has(PackingFile(atoms + "2 1 9 8\n").refusal(), ":16: a bond is a line of its number, its type"));
  EXPECT_TRUE(has(PackingFile(atoms + "2 1 9 9\n").refusal(), "a bond joins an atom to itself"));
  // Across the side of a periodic cell: the first and the last grain touch there.
  SpecimenParameters periodic = PackingFile(atoms + "2 1 9 11\n").wanted();
  periodic.shape = BodyShape::periodic;
  const PackingFile across(atoms + "2 1 9 11\n");
  EXPECT_EQ(make_specimen<2>(periodic, FlatJointParameters{}, {}, 1).joints.size(), 2u);
}

// In millimetres about the middle of the specimen; and a grain that has left a periodic cell by one width and two heights.
TEST(PackingImport, BringsGrainsOfAnotherUnitOriginAndCellToTheirPlace)
{
  const PackingFile file("-3 0 1\n-1 0 1\n1 -1 0.5\n");
  SpecimenParameters wanted = file.wanted();
  wanted.packing_unit = 1e-3;
  wanted.packing_shift = {0.005, 0.005};
  const auto grains = read_packing<2>(wanted).grains;
  EXPECT_NEAR(grains.position[0][0], 0.002, 1e-15);
  EXPECT_NEAR(grains.position[1][2], 0.004, 1e-15);
  EXPECT_NEAR(grains.radius[2], 0.0005, 1e-15);
  wanted.packing_shift = {0.005};
  EXPECT_THROW(read_packing<2>(wanted), InputError);

  const PackingFile outside("0.002 0.005 0.001\n0.014 -0.015 0.001\n");
  wanted = outside.wanted();
  EXPECT_TRUE(has(outside.refusal(), "lies outside the specimen"));
  wanted.shape = BodyShape::periodic;
  const auto wrapped = read_packing<2>(wanted).grains;
  EXPECT_NEAR(wrapped.position[0][1], 0.004, 1e-15);
  EXPECT_NEAR(wrapped.position[1][1], 0.005, 1e-15);
  EXPECT_TRUE(has(PackingFile("0.002 0.005 0.001\n20 0.005 0.001\n").refusal(BodyShape::periodic), "lies outside"));
}

/// All numbers of grains and the pairs of joints, in their order.
template <int dim>
std::vector<double> grains_and_joints(const Specimen<dim>& specimen)
{
  std::vector<double> all(specimen.grains.radius.begin(), specimen.grains.radius.end());
  for (const auto& component : specimen.grains.position)
    all.insert(all.end(), component.begin(), component.end());
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    all.insert(all.end(), {double(specimen.joints.grain_1[j]), double(specimen.joints.grain_2[j])});
  return all;
}

// To the last bit: numbers are written with all their digits, and grains that are in order stay so.
TEST(PackingExport, ComesBackAsItWentOut)
{
  const auto expect_same = [](const auto& specimen, SpecimenParameters wanted, const FlatJointParameters& joint) {
    constexpr int dim = int(std::decay_t<decltype(specimen.grains.position)>().size());
    for (const PackingForm& form : packing_forms)
      {
        const std::string text = packing_text(specimen, form.name);
        const PackingFile file(text);
        wanted.packing_file = file.wanted().packing_file;
        const auto back = make_specimen<dim>(wanted, joint, {}, specimen.seed);
        EXPECT_TRUE(grains_and_joints(back) == grains_and_joints(specimen)) << form.name;
        EXPECT_TRUE(packing_text(back, form.name) == text) << form.name;
      }
  };
  SpecimenParameters wanted;
  wanted.width = 0.01;
  wanted.height = 0.02;
  wanted.shape = BodyShape::periodic;
  const FlatJointParameters by_gap;
  expect_same(make_specimen<2>(wanted, by_gap, {}, 3), wanted, by_gap);
  wanted.shape = BodyShape::box;
  expect_same(make_specimen<2>(wanted, by_gap, {}, 3), wanted, by_gap);
  wanted.dimension = 3;
  wanted.porosity = porosity_in_space;
  wanted.shape = BodyShape::cylinder;
  wanted.minimum_radius = 1e-3;
  expect_same(make_specimen<3>(wanted, by_gap, {}, 3), wanted, by_gap);
}

TEST(PackingImport, RefusesFormsThatItCannotReadAndGrainsThatCannotBe)
{
  for (const auto& [text, words] :
       {std::pair("x [mm];y [mm];r [mm]\n2,5;5;1\n4.5;5;1\n", ":3: \"4.5\" has another decimal"),
        {"x,y,r\n0,002,0,005,0,001\n", ":2: 6 numbers found; there must be 3"},
        {"LAMMPS\nAtoms # hybrid sphere dipole\n1 1 1 1 1 1 1\n", "a hybrid with"},
        {"id x y\n1 2 3\n", ":1: there is no column radius; there must be x, y and radius"},
        {"x [kg] y r\n1 2 3\n", ":1: \"kg\" is not the unit of a length"},
        {"ITEM: ATOMS id xs ys radius\n1 0.1 0.2 0.001\n", "there is no column x"},
        {"LAMMPS\nAtoms # bond\n1 1 1 1 1 1 1\n", "it must be sphere"},
        {"0.002 0.005 0.1 0.001\n0.004 0.005 0.2 0.001\n", "4 numbers found; a line is x y radius"},
        {"0.002 0.005 0.001\n0.004 0.005\n", ":2: 2 numbers found; there must be 3"},
        {"0.002 0.005 0.001\n0.004 abc 0.001\n", ":2:"},
        {"0.002 0.005\n", "2 numbers found"},
        {"0.002 0.005 -0.001\n0.004 0.005 0.001\n", "radius"},
        {"0.002 0.005 0.001\n0.04 0.005 0.001\n", "outside"},
        {"0.002 0.005 0.001\n0.003 0.005 0.001\n", "overlaps"},
        {"", "at least two"}})
    EXPECT_TRUE(has(PackingFile(text).refusal(), words)) << text;
}

// In a periodic box of 10 mm; radii of 1 mm may overlap by 5 % of them, 0.05 mm.
TEST(PackingImport, HoldsOverlapsAcrossPeriodicSidesToTheRuleOfThoseInside)
{
  const std::string apart = "0.005 0.005 0.001\n";
  const auto words = [](const PackingFile& file) { return file.refusal(BodyShape::periodic); };
  const PackingFile half_a_radius(apart + "0.0008 0.005 0.001\n0.0093 0.005 0.001\n"); // 1.5 mm from centre to centre
  EXPECT_TRUE(has(half_a_radius.refusal(BodyShape::box),
                  ":2: reaches through the left side by 0.0002 m; allowed are 5 % of the "
                  "radius, 5e-05 m"));
  EXPECT_TRUE(has(words(half_a_radius),
                  ".txt:3: overlaps the grain of line 2 by 0.0005 m across the sides of the periodic "
                  "box; allowed are 5 % of the smaller radius, 5e-05 m"));
  // Across a corner, where no side alone brings them together: 0.9 mm along each axis is 1.27 mm.
  const PackingFile corner(apart + "0.0004 0.0004 0.001\n0.0095 0.0095 0.001\n");
  EXPECT_TRUE(has(words(corner), ":3: overlaps the grain of line 2 by 0.000727 m across"));
  // The two sides are one place: a grain on both, written twice.
  EXPECT_TRUE(
    has(words(PackingFile(apart + "0 0.002 0.001\n0.01 0.002 0.001\n")), ":3: overlaps the grain of line 2 by 0.002"));
  // Overlap of a grain with its own image, 10 mm away.
  EXPECT_TRUE(
    has(words(PackingFile("0.005 0.005 0.0052\n0.005 0.005 0.001\n")), ":1: overlaps its own image by 0.0004 m"));
  EXPECT_TRUE(has(words(PackingFile("0.005 0.005 1e300\n0.005 0.005 0.001\n")), ":1: overlaps its own image by"));
  // 1.96 mm are allowed, 1.94 mm are not; along the axis of the tests as well.
  EXPECT_EQ(words(PackingFile(apart + "0.005 0.0008 0.001\n0.005 0.00884 0.001\n")), "");
  EXPECT_NE(words(PackingFile(apart + "0.005 0.0008 0.001\n0.005 0.00886 0.001\n")), "");
}

TEST(PackingImport, HoldsOverlapsAcrossPeriodicSidesToTheRuleInSpaceToo)
{
  // Along the second axis, and across an edge.
  const PackingFile second("0.005 0.0008 0.005 0.001\n0.005 0.0093 0.005 0.001\n");
  EXPECT_TRUE(has(second.refusal<3>(BodyShape::box), ":1: reaches through the front side by 0.0002 m"));
  EXPECT_TRUE(has(second.refusal<3>(BodyShape::periodic), ":2: overlaps the grain of line 1 by 0.0005 m across"));
  const PackingFile edge("0.0004 0.005 0.0004 0.001\n0.0095 0.005 0.0095 0.001\n");
  EXPECT_TRUE(has(edge.refusal<3>(BodyShape::periodic), ":2: overlaps the grain of line 1 by 0.000727 m across"));
  EXPECT_EQ(PackingFile("0.001 0.005 0.005 0.001\n0.009 0.005 0.005 0.001\n").refusal<3>(BodyShape::periodic), "");
  // On the diagonal of a cylinder's section, 4.3 mm from its axis; 4 mm on an axis touch the side.
  const std::string inside = "0.005 0.005 0.005 0.001\n";
  EXPECT_TRUE(has(PackingFile(inside + "0.00804 0.00804 0.005 0.001\n").refusal<3>(BodyShape::cylinder),
                  ":2: reaches through the round side by 0.000299 m"));
  EXPECT_EQ(PackingFile(inside + "0.009 0.005 0.005 0.001\n").refusal<3>(BodyShape::cylinder), "");
}

// Pairs would be as many as grains squared, if they were listed before one is refused.
TEST(PackingImport, OfGrainsAllAtOnePlaceIsRefusedAtOnce)
{
  std::string lines;
  for (int k = 0; k < 50000; ++k)
    lines += "0.005 0.005 0.001\n";
  EXPECT_TRUE(has(PackingFile(lines).refusal(), ":2: overlaps the grain of line 1 by 0.002 m;"));
}

TEST(Random, IsTheStreamItAlwaysWas)
{
  // mt19937_64 seeded by seed_seq, both fixed by the C++ standard: these numbers must never change.
  Random random(1, RandomStream::radii);
  const double first = random.uniform();
  const double second = random.uniform();
  EXPECT_EQ(first, Random(1, RandomStream::radii).uniform());
  EXPECT_NE(first, second);
  EXPECT_NE(first, Random(1, RandomStream::positions).uniform());
  EXPECT_NE(first, Random(2, RandomStream::radii).uniform());
}
SpecimenParameters periodic_box(const double edge)
{
  SpecimenParameters wanted;
  wanted.shape = BodyShape::periodic;
  wanted.width = edge;
  wanted.height = edge;
  return wanted;
}

TEST(Genesis, APeriodicPackingHasItsStressAndNoWalls)
{
  FlatJointParameters flat_joint;
  flat_joint.coordination_number = 4.2;
  const auto specimen = make_specimen<2>(periodic_box(0.014), flat_joint, {}, 1);
  EXPECT_NEAR(specimen.report.packing_stress, 1e-4 * 80e9, 0.01 * 1e-4 * 80e9);
  EXPECT_NEAR(specimen.report.coordination_number, 4.2, 1.0 / double(specimen.report.n_grains));
  EXPECT_EQ(specimen.report.coordination_number_core, specimen.report.coordination_number);
  for (int c = 0; c < 2; ++c)
    for (const double x : specimen.grains.position[c])
      {
        EXPECT_GE(x, 0.0);
        EXPECT_LT(x, 0.014);
      }
  // Some joints cross each face, and the branch of every joint ends at its grain or at an image of it.
  std::array<int, 2> n_crossing{};
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    {
      const auto second = specimen.second_of(j);
      for (int c = 0; c < 2; ++c)
        n_crossing[c] += second.boxes[c] != 0;
      const Vector<2> end = at<2>(specimen.grains.position, second.owner) + shift(second, specimen.cell());
      const Vector<2> branch = specimen.joints.rest_distance[j] * at<2>(specimen.joints.normal, j);
      EXPECT_LT((at<2>(specimen.grains.position, specimen.joints.grain_1[j]) + branch - end).norm(), 1e-15);
    }
  EXPECT_GT(n_crossing[0], 5);
  EXPECT_GT(n_crossing[1], 5);
}

TEST(Genesis, ACellOfTwoGrainsMeetsSeveralImagesOfOnePair)
{
  // Two equal discs on a square lattice turned by 45°: each is in contact with four images of the other.
  Specimen<2> specimen;
  specimen.size = {2.0, 2.0};
  specimen.shape = BodyShape::periodic;
  const double radius = std::sqrt(0.5);
  specimen.grains.place({radius, radius}, {{{0.5, 1.5}, {0.5, 1.5}}});
  FlatJointParameters wanted;
  wanted.installation_gap_ratio = 1e-9;
  install_joints(specimen, wanted);
  ASSERT_EQ(specimen.joints.size(), 4u);
  for (std::size_t j = 0; j < 4; ++j)
    {
      EXPECT_EQ(specimen.joints.grain_1[j], 0u);
      EXPECT_EQ(specimen.joints.grain_2[j], 1u);
      EXPECT_NEAR(specimen.joints.rest_distance[j], 2.0 * radius, 1e-15);
    }
}
} // namespace
} // namespace feldspar
