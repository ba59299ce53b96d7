// Gravity, a body on a plate that is tilted, machines with a stiffness, and load control.

#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/seating.h"
#include "laboratory/compression.h"
#include "laboratory/paired_moments.h"
#include "results/evaluation.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/taken_up.h"
#include "tests/unit/whole_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace feldspar::tests
{
namespace
{
constexpr double far_from_breaking = 1e3; // times the strength of the bonds
constexpr double earth = 9.81;            // [m/s²]

template <int dim>
TestParameters on_a_plate(const double friction)
{
  TestParameters wanted;
  wanted.gravity.assign(dim, 0.0);
  wanted.gravity.back() = -earth;
  wanted.platen_friction = friction;
  return wanted;
}

TestParameters load_controlled(const LoadingRate& rate)
{
  TestParameters wanted;
  wanted.of<CompressionParameters>().strain_rate = 2.0;
  wanted.of<CompressionParameters>().loading_rate = rate;
  return wanted;
}

/// Slope of the stress over a measure of the way, by least squares from where the one stress [Pa] is reached to where the
/// other is.
template <typename Way>
double slope(const TestRecord& record, const double from, const double to, const Way& way)
{
  std::vector<double> ways, stresses;
  for (const CurveSample& row : record.curve)
    {
      if (-row.axial_stress > to)
        break;
      if (-row.axial_stress >= from)
        {
          ways.push_back(way(row));
          stresses.push_back(-row.axial_stress);
        }
    }
  return paired_moments(ways, stresses).slope();
}

double time_of(const CurveSample& row) { return row.time; }
double shortening_of(const CurveSample& row) { return -row.axial_strain; }

const LaboratoryCase uniaxial{uniaxial_compression};
const LaboratoryCase confined{triaxial_compression, 5e6};

template <int dim>
void expect_own_weight_and_sliding(const Specimen<dim>& specimen, const double friction)
{
  const auto& grains = specimen.grains;
  const double height = specimen.size[dim - 1];
  const double area = specimen.volume() / height;
  const TestRecord record = outcome_of<dim>({tilt}, specimen, on_a_plate<dim>(friction)).record;

  // Under its own weight σ = ρ g h at the plate, and halfway up that of the grains above.
  const CurveSample& level = record.curve.front();
  const double weight = record.bulk_density * earth * height;
  EXPECT_NEAR(-level.lateral_stress, weight, 1e-3 * weight);
  double above = 0.0;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (grains.position[dim - 1][i] > 0.5 * height)
      above += grains.mass[i] * earth / area;
  EXPECT_NEAR(-level.mid_stress, above, 1e-3 * weight);

  // At rest the plate carries the components of the weight.
  const double friction_angle = std::atan(friction);
  for (const CurveSample& row : record.curve)
    if (const double angle = -row.axial_strain; angle < 0.9 * friction_angle)
      {
        EXPECT_NEAR(-row.axial_stress, weight * std::sin(angle), 2e-3 * weight);
        EXPECT_NEAR(-row.lateral_stress, weight * std::cos(angle), 1e-3 * weight);
      }

  // Beyond the friction angle φ the body slides, by what its weight is more than the friction, of which damping leaves
  // 1 - α: with θ = φ + ωt, v = (1 - α) g (θ - φ)²/(2ω cos φ), and the fourth root of the kinetic energy goes straight up
  // from φ. Two later rows thus tell where the motion began.
  const auto at = [&](const double angle) {
    return *std::ranges::find_if(record.curve, [=](const CurveSample& row) { return -row.axial_strain >= angle; });
  };
  const CurveSample one = at(1.15 * friction_angle);
  const CurveSample other = at(1.3 * friction_angle);
  const double root = std::pow(one.energies.kinetic, 0.25);
  const double per_angle = (std::pow(other.energies.kinetic, 0.25) - root) / (one.axial_strain - other.axial_strain);
  EXPECT_NEAR(-one.axial_strain - root / per_angle, friction_angle, 0.01 * friction_angle);
  const double beyond = -other.axial_strain - friction_angle;
  const double speed = (1.0 - DynamicsParameters().damping) * earth * beyond * beyond /
                       (2.0 * record.strain_rate * std::cos(friction_angle));
  // The formula is the first term of a series in θ - φ = 0.09, whose next term is a third of (θ - φ) tan φ.
  EXPECT_NEAR(other.energies.kinetic, 0.5 * weight * area / earth * speed * speed, 0.03 * other.energies.kinetic);

  // The results say so, by the stresses.
  const TestResults results = evaluate(record);
  ASSERT_TRUE(results.sliding_angle.value);
  EXPECT_NEAR(*results.sliding_angle.value, friction_angle, 0.01 * friction_angle);
  EXPECT_NEAR(*results.strain_at_peak.value, friction_angle, 0.01 * friction_angle);
  EXPECT_NEAR(*results.peak_stress.value, weight * std::sin(friction_angle), 0.01 * weight);
  // The work of gravity is moved, stored, rubbed and damped away.
  EXPECT_LT(record.curve.back().energies.imbalance(), 1e-3);
}

TEST(Tilt, ABodyCarriesItsWeightAndSlidesAtItsFrictionAngle)
{
  expect_own_weight_and_sliding<2>(small_specimen(1, far_from_breaking), 0.3);
}

TEST(Tilt, SoItDoesInSpace) { expect_own_weight_and_sliding<3>(small_cylinder(1, far_from_breaking), 0.3); }

TEST(Tilt, ALooseGrainKeepsNoBodyFromRest)
{
  // A loose grain would fall about in its void for milliseconds; the body carries its weight instead.
  for (std::uint64_t seed = 1; seed < 20; ++seed)
    {
      const Specimen<2> specimen = small_specimen(seed, far_from_breaking);
      const std::vector<bool> is_part = grains_of_body(specimen);
      const auto n_loose = std::size_t(std::ranges::count(is_part, false));
      if (n_loose == 0)
        continue;
      const TestRecord record = outcome_of<2>({tilt}, specimen, on_a_plate<2>(0.3)).record;
      EXPECT_EQ(record.specimen.n_grains, specimen.grains.size() - n_loose);
      const double weight = record.bulk_density * earth * specimen.size[1];
      EXPECT_NEAR(-record.curve.front().lateral_stress, weight, 1e-3 * weight);
      EXPECT_NEAR(*evaluate(record).sliding_angle.value, std::atan(0.3), 0.01 * std::atan(0.3));
      return;
    }
  FAIL() << "no specimen has a loose grain";
}

TEST(Gravity, PutsTheWeightOnTheLowerPlatenOfAnyTest)
{
  // Gravity of 1e5 m/s², so that it shows beside the waves of the platens: ρ g h = 5.4 MPa.
  TestParameters wanted = on_a_plate<2>(0.0);
  wanted.gravity.back() = -1e5;
  wanted.stop_strain = 1e-3;
  const TestRecord record = outcome_of<2>(uniaxial, small_specimen(1, far_from_breaking), wanted).record;
  const double weight = record.bulk_density * 1e5 * 0.020;
  EXPECT_NEAR(record.curve.back().end_stress_difference, weight, 0.01 * weight);
  EXPECT_LT(record.curve.back().energies.imbalance(), 1e-3);
}

TEST(Machine, AndSpecimenAreTwoSpringsInARow)
{
  // Travel of the crosshead per stress is that of the specimen, H/E, and that of the spring, A/K.
  for (const LaboratoryCase& test : {uniaxial, confined})
    {
      const double from = test.confining_pressure + 20e6;
      const double to = test.confining_pressure + 50e6;
      TestParameters wanted = quick_compression();
      wanted.stop_strain = 1e-3;
      auto& own = wanted.of<CompressionParameters>();
      own.sampling_strain = 1e-5;
      const auto specimen = small_specimen(1, far_from_breaking);
      const double modulus = slope(outcome_of(test, specimen, wanted).record, from, to, shortening_of);
      for (const double stiffness : {0.1, 1.0, 100.0}) // over that of the specimen
        {
          own.machine_stiffness = stiffness * modulus * 0.012 / 0.020;
          const TestRecord record = outcome_of(test, specimen, wanted).record;
          const auto crosshead = [&](const CurveSample& row) { return own.strain_rate * row.time; };
          const double of_both = modulus / (1.0 + 1.0 / stiffness);
          EXPECT_NEAR(slope(record, from, to, crosshead), of_both, 1e-3 * of_both);
          EXPECT_NEAR(slope(record, from, to, shortening_of), modulus, 1e-3 * modulus);
          EXPECT_LT(record.curve.back().energies.imbalance(), 1e-3);
        }
    }
}

TEST(Machine, ThatIsSoftCrushesABodyThatAStiffOneFollows)
{
  // From 90 % to 50 % of the peak: what the platens go while the crosshead goes on.
  const auto ways = [](const double stiffness) {
    TestParameters wanted = quick_compression();
    wanted.of<CompressionParameters>().machine_stiffness = stiffness * 60e9 * 0.012 / 0.020;
    wanted.stop_stress_over_peak = 0.3;
    const TestRecord record = outcome_of<2>(uniaxial, small_specimen(), wanted).record;
    const auto lowest_before = std::ranges::min_element(record.curve, {}, &CurveSample::axial_stress);
    const auto fallen_to = [&](const double share) {
      return *std::find_if(lowest_before, record.curve.end(), [&](const CurveSample& row) {
        return row.axial_stress > share * lowest_before->axial_stress;
      });
    };
    const CurveSample from = fallen_to(0.9);
    const CurveSample to = fallen_to(0.5);
    return std::pair(record.strain_rate * (to.time - from.time), from.axial_strain - to.axial_strain);
  };
  const auto [crosshead_of_stiff, platens_of_stiff] = ways(100.0);
  const auto [crosshead_of_soft, platens_of_soft] = ways(1.0);
  // A spring that is 100 times as stiff as the specimen gives back a hundredth of the strain at the peak, some 6e-5.
  EXPECT_NEAR(platens_of_stiff, crosshead_of_stiff, 6e-5);
  // One as stiff as the specimen gives back 40 % of that strain, 2.4e-3, within microseconds.
  EXPECT_GT(platens_of_soft, 1.5e-3);
  EXPECT_LT(crosshead_of_soft, 0.05 * platens_of_soft);
}

TEST(LoadControl, RaisesTheStressAtTheRateItSays)
{
  // 3e5 MPa/s is more than E_c times the strain rate; the laboratory's rate is run at that, of 80 GPa · 2/s.
  for (const auto& [rate, run_at] : {std::pair(LoadingRate{LoadingRate::Of::stress, 3e11, ""}, 3e11),
                                     {LoadingRate{LoadingRate::Of::stress, 0.7e6, ""}, 1.6e11},
                                     {LoadingRate{LoadingRate::Of::force, 0.7e6 * 0.012, ""}, 1.6e11}})
    for (const LaboratoryCase& test : {uniaxial, confined})
      {
        const TestOutcome made = outcome_of(test, small_specimen(), load_controlled(rate));
        const TestResults results = evaluate(made.record);
        ASSERT_TRUE(results.peak_stress.value);
        const double peak = *results.peak_stress.value;
        EXPECT_DOUBLE_EQ(made.record.stress_rate, run_at);
        EXPECT_NEAR(slope(made.record, 0.2 * peak, 0.9 * peak, time_of), run_at, 0.01 * run_at);
        const auto at_peak = std::ranges::find(made.record.curve, -peak, &CurveSample::axial_stress);
        ASSERT_NE(at_peak, made.record.curve.end());
        EXPECT_NEAR(peak, test.confining_pressure + run_at * at_peak->time, 0.05 * peak);
        EXPECT_LT(*results.stress_rate_error.value, 0.05);
        EXPECT_EQ(results.post_peak_drop.reason, "under load control the strain runs away at the peak");
        const double faster = std::max(1.0, run_at / 0.7e6);
        if (rate.value < run_at)
          {
            EXPECT_NEAR(made.record.rate_over_laboratory, faster, 1e-9 * faster);
            EXPECT_NEAR(made.bookkeeping.steps_at_laboratory_rate,
                        faster * double(made.record.curve.back().step - made.record.curve.front().step), 1e-6 * faster);
          }
        else
          EXPECT_DOUBLE_EQ(made.record.rate_over_laboratory, 1.0);
        EXPECT_LT(made.record.curve.back().energies.imbalance(), 1e-3);
      }
}

TEST(LoadingRate, ThatIsTooHighIsNamedAsTheCause)
{
  // At 5000/s the ends alone bring 2 ρ c · 5000/s · 20 mm = 2.9 GPa, more than any body of these grains holds.
  TestParameters wanted = load_controlled({LoadingRate::Of::travel, 5e3 * 0.020, ""});
  const TestRecord fast = outcome_of<2>(uniaxial, small_specimen(), wanted).record;
  EXPECT_EQ(fast.failure.find("the rate, 5e+03 1/s, is too high: waves alone bring about 2.9"), 0u) << fast.failure;
}

TEST(LoadingRate, OfTheTravelIsOneOfTheStrain)
{
  // 0.1 mm/min on 20 mm are 8.3e-5 1/s; the walls of the packing are its platens.
  TestParameters wanted = load_controlled({LoadingRate::Of::travel, 0.1e-3 / 60.0, ""});
  wanted.stop_strain = 1e-3;
  const TestRecord slow = outcome_of<2>(uniaxial, small_specimen(), wanted).record;
  const double of_laboratory = 0.1e-3 / 60.0 / 0.020;
  EXPECT_DOUBLE_EQ(slow.strain_rate, 2.0);
  EXPECT_NEAR(slow.rate_over_laboratory, 2.0 / of_laboratory, 1e-9 * 2.0 / of_laboratory);
  EXPECT_TRUE(std::isnan(slow.stress_rate));
  wanted.of<CompressionParameters>().loading_rate->value = 0.06; // faster than the run has to be: 3/s
  const TestRecord fast = outcome_of<2>(uniaxial, small_specimen(), wanted).record;
  EXPECT_NEAR(fast.strain_rate, 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(fast.rate_over_laboratory, 1.0);
}

TEST(Loads, AreTakenUpAgainToTheSameBits)
{
  TestParameters by_weight = on_a_plate<2>(0.3);
  by_weight.stop_strain = 0.05;
  TestParameters by_load = load_controlled({LoadingRate::Of::stress, 0.7e6, ""});
  by_load.stop_strain = 5e-4;
  TestParameters by_spring = quick_compression();
  by_spring.stop_strain = 1e-3;
  by_spring.of<CompressionParameters>().machine_stiffness = 30e9;
  for (const std::pair<LaboratoryCase, TestParameters>& test :
       {std::pair(LaboratoryCase{tilt}, by_weight), {confined, by_load}, {uniaxial, by_spring}})
    {
      const auto [whole, broken] =
        whole_and_taken_up([&] { return LabTest<2>(test.first, small_specimen(), test.second, {}); });
      ASSERT_GT(whole.curve().size(), 10u);
      ASSERT_EQ(whole.curve().size(), broken.curve().size());
      for (std::size_t k = 0; k < whole.curve().size(); ++k)
        {
          EXPECT_EQ(whole.curve()[k].axial_strain, broken.curve()[k].axial_strain);
          EXPECT_EQ(whole.curve()[k].axial_stress, broken.curve()[k].axial_stress);
          EXPECT_EQ(whole.curve()[k].energies.boundary_work, broken.curve()[k].energies.boundary_work);
        }
    }
}
} // namespace
} // namespace feldspar::tests
