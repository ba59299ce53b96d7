#include "dem/genesis/genesis.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/compression.h"
#include "results/evaluation.h"
#include "tests/unit/whole_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

/// Table 1 of the flat-joint paper at a coordination number of 4.2. Where a bound comes from "the independent program",
/// that is one written separately from the paper's equations, on packings of its own.
namespace feldspar
{
namespace
{
struct Variant
{
  double coordination_number = 4.2;
  unsigned int n_segments = 4;
  double rate_factor = 1.0;
  double platen_friction = 0.0;
  bool to_peak = false; ///< and little farther
};

/// The grains of a seed are packed once; each variant joins them for itself.
Specimen<2> joined(const std::uint64_t seed, const FlatJointParameters& flat_joint)
{
  static std::map<std::uint64_t, Specimen<2>> packings;
  if (!packings.contains(seed))
    {
      auto packing = make_specimen<2>({}, flat_joint, {}, seed);
      packing.joints = {};
      packings.emplace(seed, std::move(packing));
    }
  Specimen<2> specimen = packings.at(seed);
  install_joints(specimen, flat_joint);
  return specimen;
}

TestRecord test(const LaboratoryCase& wanted_test, const std::uint64_t seed, const Variant& variant = {})
{
  FlatJointParameters flat_joint;
  flat_joint.coordination_number = variant.coordination_number;
  flat_joint.n_segments = variant.n_segments;
  const auto specimen = joined(seed, flat_joint);
  EXPECT_NEAR(specimen.report.radius_multiplier, 1.0, 0.01);
  TestParameters wanted;
  wanted.of<TensionParameters>().strain_rate *= variant.rate_factor;
  wanted.of<CompressionParameters>().strain_rate *= variant.rate_factor;
  wanted.platen_friction = variant.platen_friction;
  if (variant.to_peak)
    wanted.stop_stress_over_peak = 0.8;
  return tests::outcome_of<2>(wanted_test, specimen, wanted).record;
}

double peak(const LaboratoryCase& wanted_test, const std::uint64_t seed, Variant variant = {})
{
  variant.to_peak = true;
  return *evaluate(test(wanted_test, seed, variant)).peak_stress.value;
}

/// One crack across the axis: a band of a quarter of the height holds most of what breaks, of which cracks scattered over the
/// whole specimen would leave it a quarter; and in it they reach from one side to the other. The other cracks are a second
/// crack that did not get through (of seed 2, a third of all).
void expect_one_crack_across(const TestRecord& record)
{
  std::vector<Crack> cracks = record.cracks;
  std::sort(cracks.begin(), cracks.end(), [](const Crack& a, const Crack& b) { return a.centroid[1] < b.centroid[1]; });
  std::vector<Crack> band;
  for (auto first = cracks.begin(); first != cracks.end(); ++first)
    {
      const auto above = std::find_if(first, cracks.end(), [&](const Crack& crack) {
        return crack.centroid[1] > first->centroid[1] + 0.25 * record.size[1];
      });
      if (std::size_t(above - first) > band.size())
        band.assign(first, above);
    }
  EXPECT_GT(double(band.size()), 0.6 * double(cracks.size()));
  for (int fifth = 0; fifth < 5; ++fifth)
    EXPECT_TRUE(std::any_of(band.begin(), band.end(),
                            [&](const Crack& crack) { return int(5.0 * crack.centroid[0] / record.size[0]) == fifth; }))
      << fifth;
}

/// Each of these tests is a long one, so that claims on the same specimen share it.
TEST(BeishanInTension, IsBrittleQuasiStaticAndAboutTheStrengthOfADisc)
{
  double usual = 0.0;
  double slow = 0.0;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      SCOPED_TRACE(seed);
      const auto record = test({direct_tension}, seed);
      const auto results = evaluate(record);
      const double strength = *results.peak_stress.value;
      EXPECT_GT(strength, 8e6); // the independent program
      EXPECT_LT(strength, 11e6);
      EXPECT_EQ(results.n_shear_cracks, 0u);         // paper: all cracks tensile
      EXPECT_GT(*results.post_peak_drop.value, 0.9); // brittle: one crack across

      // Energies are integrated each on its own. A brittle break moves at most the released part at once.
      EXPECT_LT(results.energy_imbalance_over_work, 0.01);
      // Quasi-static until the break: both grips carry the same, and motion holds little of the energy.
      EXPECT_LT(*results.end_stress_difference.value, 0.02);
      EXPECT_LT(*results.kinetic_to_strain_energy.value, 0.02);
      expect_one_crack_across(record);

      usual += strength / 3.0;
      slow += peak({direct_tension}, seed, {.rate_factor = 0.5}) / 3.0;
      // 2P/(πDt) assumes an elastic disc and line loads; discs of rock and of grains come within some tens of percent.
      if (seed == 2)
        {
          EXPECT_NEAR(peak({brazilian}, seed), strength, 0.3 * strength);
        }
    }
  // Half the rate changes the mean of three seeds by less than 3 %.
  EXPECT_NEAR(slow, usual, 0.03 * usual);
}

TEST(BeishanInCompression, OverThreeSeedsAndOfVariants)
{
  double mean_modulus = 0.0;
  std::map<std::uint64_t, double> strength;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      SCOPED_TRACE(seed);
      const auto results = evaluate(test({uniaxial_compression}, seed));
      strength[seed] = *results.peak_stress.value;
      EXPECT_GT(strength[seed], 125e6); // the independent program
      EXPECT_LT(strength[seed], 185e6);
      EXPECT_GT(*results.poissons_ratio_initial.value, 0.07);
      EXPECT_LT(*results.poissons_ratio_initial.value, 0.10);
      EXPECT_GT(results.n_tension_cracks, 20 * results.n_shear_cracks); // paper: tensile cracks dominate
      EXPECT_LT(results.energy_imbalance_over_work, 0.01);
      EXPECT_LT(*results.residual_deviator_ratio.value, 0.5); // strain softening
      mean_modulus += *results.youngs_modulus_initial.value / 3.0;
    }
  // The independent program; single specimens scatter by 1.5 GPa, so this is claimed of the mean.
  EXPECT_GT(mean_modulus, 69e9);
  EXPECT_LT(mean_modulus, 74e9);

  // Friction hinders the ends from widening; the independent program: by some 40 %. Here by 55, 49, 72 and 44 % with seeds
  // 1 to 4, of which this is the second; single strengths scatter by a tenth.
  const double by_friction = peak({uniaxial_compression}, 2, {.platen_friction = 0.5}) / strength[2];
  EXPECT_GT(by_friction, 1.3);
  EXPECT_LT(by_friction, 1.8);
  // A face of one segment breaks whole or not at all: what bends does not unzip.
  EXPECT_GT(peak({uniaxial_compression}, 1, {.n_segments = 1}), 2.0 * strength[1]);
  // The independent program: 161 MPa at 4.2, 350 MPa at 4.8.
  const double by_joints = peak({uniaxial_compression}, 1, {.coordination_number = 4.8}) / strength[1];
  EXPECT_GT(by_joints, 1.7);
  EXPECT_LT(by_joints, 2.7);
}

TEST(BeishanTriaxial, ConfinementTurnsSplittingIntoShearAndSofteningIntoFlow)
{
  const auto low = evaluate(test({triaxial_compression, 5e6}, 2));
  const auto high = evaluate(test({triaxial_compression, 60e6}, 2));
  // The independent program's means over seeds, 255 and 523 MPa; a single seed within 20 %, twice the seeds' scatter.
  EXPECT_NEAR(*low.peak_stress.value, 255e6, 0.2 * 255e6);
  EXPECT_NEAR(*high.peak_stress.value, 523e6, 0.2 * 523e6);
  EXPECT_GT(*high.shear_share_at_peak.value, 3.0 * *low.shear_share_at_peak.value);
  EXPECT_GT(*high.residual_deviator_ratio.value, 0.65);
  for (const auto& results : {low, high})
    {
      EXPECT_LT(*results.servo_error.value, 0.01);
      EXPECT_LT(*results.servo_error_largest.value, 0.03);
      EXPECT_LT(results.energy_imbalance_over_work, 0.01);
    }
}
} // namespace
} // namespace feldspar
