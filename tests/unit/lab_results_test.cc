#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/compression.h"
#include "laboratory/stop_rule.h"
#include "results/evaluation.h"
#include "tests/temporary_folder.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <variant>

namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

/// A compression curve with known answers: modulus 70 GPa to 50 MPa, then 35 GPa to the peak of 100 MPa, then down;
/// Poisson's ratio 0.2, and volumetric strain that turns round at 80 MPa; a crack a row from 42 MPa on.
TestRecord known_compression()
{
  TestRecord record;
  record.kind = uniaxial_compression.kind;
  record.size = {0.05, 0.1, 0.0};
  record.bulk_density = 2700.0;
  const double strain_at_50 = 50e6 / 70e9;
  const double strain_at_peak = strain_at_50 + 50e6 / 35e9;
  const double strain_at_80 = strain_at_50 + 30e6 / 35e9;
  std::uint64_t n_cracks = 0;
  for (int k = 0; k <= 1000; ++k)
    {
      const double strain = 1.5 * strain_at_peak * k / 1000.0;
      const double stress = strain < strain_at_50     ? 70e9 * strain
                            : strain < strain_at_peak ? 50e6 + 35e9 * (strain - strain_at_50)
                                                      : 100e6 - 60e9 * (strain - strain_at_peak);
      CurveSample row; // inside: tension positive
      row.time = strain;
      row.axial_strain = -strain;
      row.axial_stress = -stress;
      row.gauge_axial_strain = -strain;
      row.gauge_lateral_strain = 0.2 * strain;
      row.gauge_volumetric_strain = -0.8 * std::min(strain, strain_at_80) + std::max(0.0, strain - strain_at_80);
      if (stress >= 42e6 || strain > strain_at_50)
        ++n_cracks;
      row.n_tension_cracks = n_cracks;
      row.energies.strain = 1.0;
      record.curve.push_back(row);
    }
  return record;
}

// Files, pages and calibrations know quantities by their names, and evaluation walks the table.
TEST(LabResults, HaveOneRowEachInTheirTable)
{
  std::set<std::string_view> names;
  for (const TestQuantity& quantity : test_quantities)
    {
      EXPECT_TRUE(names.insert(quantity.name).second) << quantity.name;
      EXPECT_EQ(&quantity_of(quantity.member), &quantity) << quantity.name << " has the member of another row";
      EXPECT_EQ(quantity.figure() == nullptr, std::holds_alternative<std::monostate>(quantity.evaluate))
        << quantity.name;
    }
  for (const RockProperty& property : rock_properties)
    EXPECT_LT(property.least, property.most) << property.key;
}

TEST(LabResults, AreThoseOfAKnownCurve)
{
  const auto results = evaluate(known_compression());
  const double row = 1.5 * (50e6 / 70e9 + 50e6 / 35e9) / 1000.0; // strain between two rows
  EXPECT_NEAR(*results.peak_stress.value, 100e6, 70e9 * row);
  EXPECT_NEAR(*results.strain_at_peak.value, 50e6 / 70e9 + 50e6 / 35e9, row);
  EXPECT_NEAR(*results.youngs_modulus_initial.value, 70e9, 1e-6 * 70e9);
  // Secant to 50 % of the peak: still on the first branch, but for the row at which the peak was missed.
  EXPECT_NEAR(*results.youngs_modulus_secant.value, 70e9, 0.002 * 70e9);
  // Half of 40 to 60 % on either branch: between both moduli.
  EXPECT_GT(*results.youngs_modulus_tangent.value, 35e9);
  EXPECT_LT(*results.youngs_modulus_tangent.value, 70e9);
  EXPECT_NEAR(*results.poissons_ratio_initial.value, 0.2, 1e-9);
  EXPECT_NEAR(*results.poissons_ratio_secant.value, 0.2, 1e-9);
  EXPECT_NEAR(*results.crack_damage_stress.value, 80e6, 35e9 * row);
  // One crack a row: 1 % of those at the peak come within a few rows of the first.
  EXPECT_NEAR(*results.crack_initiation_stress.value, 42e6, 10 * 70e9 * row);
  EXPECT_NEAR(*results.post_peak_drop.value, 0.6 * 1.0714285714, 0.01);
}

/// A compression curve whose lateral strain has two kinks: modulus 60 GPa, Poisson's ratio 0.2 to 60 MPa, 0.35 to
/// 120 MPa, 0.9 to the peak of 160 MPa, then down. No cracks are counted. A row a half MPa.
TestRecord kinked_compression()
{
  TestRecord record;
  record.kind = uniaxial_compression.kind;
  const auto add = [&](const double strain, const double expansion, const double stress) {
    CurveSample row;
    row.axial_strain = row.gauge_axial_strain = -strain;
    row.axial_stress = -stress;
    row.gauge_lateral_strain = expansion;
    row.gauge_volumetric_strain = 2.0 * expansion - strain;
    record.curve.push_back(row);
  };
  const auto expansion = [](const double stress) {
    return (0.2 * std::min(stress, 60e6) + 0.35 * std::clamp(stress - 60e6, 0.0, 60e6) +
            0.9 * std::max(stress - 120e6, 0.0)) /
           60e9;
  };
  for (int k = 0; k <= 320; ++k)
    add(k * 0.5e6 / 60e9, expansion(k * 0.5e6), k * 0.5e6);
  for (int k = 1; k <= 100; ++k)
    add(160e6 / 60e9 * (1.0 + 0.005 * k), expansion(160e6) * (1.0 + 0.05 * k), 160e6 * (1.0 - 0.006 * k));
  return record;
}

/// A plane 50 mm long that slides at 5 MPa under 8 MPa from 20 µm on, and then opens by a tenth of what it slides. While it
/// slides the stress rises by so little that its highest value lies at the end.
TestRecord known_shear()
{
  TestRecord record;
  record.kind = direct_shear.kind;
  record.size = {0.05, 0.02, 0.0};
  record.confining_pressure = 8e6;
  double work = 0.0;
  for (int k = 0; k <= 100; ++k)
    {
      const double way = 1e-6 * k;
      const double stress = k < 20 ? 5e6 * k / 20 : 5e6 + k;
      CurveSample row;
      row.axial_strain = -way / 0.05;
      row.axial_stress = -stress;
      row.lateral_stress = -8e6;
      if (k > 0)
        work += 0.05 * (0.5 * (stress - record.curve.back().axial_stress) * 1e-6 - (k > 20 ? 8e6 * 1e-7 : 0.0));
      row.energies.boundary_work = work;
      row.energies.strain = 1.0;
      record.curve.push_back(row);
    }
  return record;
}

TEST(LabResults, OfAPlaneThatSlidesAreItsStrengthAndItsDilation)
{
  auto record = known_shear();
  const auto results = evaluate(record);
  ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
  EXPECT_EQ(*results.peak_stress.value, 5e6 + 100.0);
  ASSERT_TRUE(results.dilation_angle.value) << results.dilation_angle.reason;
  EXPECT_NEAR(*results.dilation_angle.value, std::atan(0.1), 1e-6);

  record.curve[60].lateral_stress = -3e6;
  EXPECT_TRUE(has(evaluate(record).dilation_angle.reason, "lost half of the normal stress"));
  record.curve.resize(22); // the last tenth rises by 5 % and more
  EXPECT_EQ(evaluate(record).peak_stress.reason,
            "the stress never peaked: it was still rising when the test ended; the highest was 5 MPa");
}

TEST(LabResults, OfACurveWithoutCracksComeFromItsStrains)
{
  // The line from the start to crack damage lies furthest above the lateral strain at its first kink. Volume: with a
  // ratio below 0.5 it shrinks, with 0.9 it grows. Every kink is a row, so what is left is rounding.
  const auto results = evaluate(kinked_compression());
  EXPECT_NEAR(*results.crack_initiation_stress_lateral.value, 60e6, 1.0);
  EXPECT_NEAR(*results.crack_damage_stress.value, 120e6, 1.0);
  EXPECT_NEAR(*results.peak_stress.value, 160e6, 1.0);
  EXPECT_NEAR(*results.youngs_modulus_initial.value, 60e9, 1e-6 * 60e9);
  EXPECT_NEAR(*results.youngs_modulus_tangent.value, 60e9, 1e-6 * 60e9);
  EXPECT_NEAR(*results.poissons_ratio_initial.value, 0.2, 1e-6);
  // At 80 MPa: (0.2·60 + 0.35·20)/80.
  EXPECT_NEAR(*results.poissons_ratio_secant.value, 0.2375, 1e-6);
  EXPECT_EQ(results.crack_initiation_stress.reason, "no crack before the peak");
}

TEST(LabResults, OfAcousticEmissionAreTheKinksOfHitsAndOfTheirEnergy)
{
  // Hits in proportion to the lateral strain, which has its kinks at 60 and 120 MPa, and energy from 100 MPa on.
  TestRecord record = kinked_compression();
  for (CurveSample& row : record.curve)
    {
      row.n_tension_cracks = std::uint64_t(1e9 * row.gauge_lateral_strain);
      row.energies.released = std::max(0.0, -row.axial_stress - 100e6);
    }
  const auto results = evaluate(record);
  ASSERT_TRUE(results.crack_initiation_stress_emission.value) << results.crack_initiation_stress_emission.reason;
  EXPECT_NEAR(*results.crack_initiation_stress_emission.value, 60e6, 1.0);
  EXPECT_NEAR(*results.crack_damage_stress_emission.value, 100e6, 1.0);
  EXPECT_TRUE(has(evaluate(kinked_compression()).crack_damage_stress_emission.reason, "never lags behind"));
}

TEST(LabResults, SayWhenLateralStrainTellsNoCrackInitiation)
{
  TestRecord record = kinked_compression();
  for (auto& row : record.curve) // grows ever more slowly against the stress: never behind a straight line
    row.gauge_lateral_strain = std::sqrt(row.gauge_lateral_strain);
  EXPECT_TRUE(has(evaluate(record).crack_initiation_stress_lateral.reason, "never lags behind"));
  record.kind = direct_tension.kind;
  for (auto& row : record.curve)
    row.axial_stress *= -1.0;
  EXPECT_TRUE(has(evaluate(record).crack_initiation_stress_lateral.reason, "compression only"));
}

TEST(LabResults, SayWhyWhenACurveNeverPeaks)
{
  auto record = known_compression();
  record.curve.resize(200);
  const auto results = evaluate(record);
  EXPECT_FALSE(results.peak_stress.value);
  EXPECT_EQ(results.peak_stress.reason,
            "the stress never peaked: it was still rising when the test ended; the highest was 44.77 MPa");
  for (const Figure& of_peak : {results.youngs_modulus_tangent, results.youngs_modulus_secant,
                                results.poissons_ratio_secant, results.crack_initiation_stress})
    EXPECT_EQ(of_peak.reason, results.peak_stress.reason);
  // A specimen that came apart beyond its last row was strongest there.
  record.came_apart = true;
  EXPECT_EQ(evaluate(record).peak_stress.value, -record.curve.back().axial_stress);
  record.interrupted = true;
  EXPECT_EQ(evaluate(record).peak_stress.reason, "interrupted before its end");
}

TEST(LabResults, OfATestBeforeItsPeakHaveTheElasticConstantsBeforeTheFirstCrack)
{
  // The first row at or above 20 % of the peak: the rows between a quarter of its stress and itself are those of 5-20 %.
  auto record = known_compression();
  const auto at_20_percent = std::find_if(record.curve.begin(), record.curve.end(),
                                          [](const CurveSample& row) { return row.axial_stress <= -20e6; });
  for (auto row = record.curve.begin(); row != record.curve.end(); ++row) // a curve that is not straight
    row->gauge_axial_strain *= 1.0 + 100.0 * std::abs(row->gauge_axial_strain);
  const auto whole = evaluate(record);
  auto stopped = record;
  stopped.curve.resize(std::size_t(at_20_percent - record.curve.begin()) + 1);
  const auto part = evaluate(stopped);
  ASSERT_TRUE(part.youngs_modulus_initial.value) << part.youngs_modulus_initial.reason;
  EXPECT_FALSE(part.peak_stress.value);
  // A row at either end may differ, of some 33: the stiffness falls by 200 times the strain of 3e-4 over the range.
  EXPECT_NEAR(*part.youngs_modulus_initial.value, *whole.youngs_modulus_initial.value, 2e-3 * 70e9);
  EXPECT_NEAR(*part.poissons_ratio_initial.value, *whole.poissons_ratio_initial.value, 2e-3 * 0.2);

  // Rows beyond the first crack, at 42 MPa, change nothing.
  record = known_compression();
  record.curve.resize(200);
  EXPECT_NEAR(*evaluate(record).youngs_modulus_initial.value, 70e9, 1e-6 * 70e9);
  for (std::size_t k = 190; k < 200; ++k)
    record.curve[k].gauge_axial_strain *= 2.0;
  EXPECT_NEAR(*evaluate(record).youngs_modulus_initial.value, 70e9, 1e-6 * 70e9);
  // A body that cracks under stresses which waves bring about too has no elastic part.
  record.peak_demands.least_stress = 43e6;
  EXPECT_TRUE(
    has(evaluate(record).poissons_ratio_initial.reason, "; too little of the curve lies before the first crack"));
  record.interrupted = true;
  EXPECT_TRUE(has(evaluate(record).youngs_modulus_initial.reason, "interrupted"));
}

TEST(LabResults, SayWhenTheCurveIsTooCoarseForAModulus)
{
  auto record = known_compression();
  std::vector<CurveSample> coarse;
  for (std::size_t k = 0; k < record.curve.size(); k += 200)
    coarse.push_back(record.curve[k]);
  record.curve = coarse;
  const auto results = evaluate(record);
  EXPECT_FALSE(results.youngs_modulus_initial.value);
  EXPECT_TRUE(has(results.youngs_modulus_initial.reason, "sampling strain"));
}

TEST(Energies, OfALaboratoryTestBalanceAndADoubledTermShows)
{
  TestParameters wanted;
  wanted.stop_stress_over_peak = 0.8; // past the peak, where everything is at work
  LabTest<2> test({uniaxial_compression}, small_specimen(), wanted, {});
  while (test.advance())
    ;
  const Energies energies = test.curve().back().energies;
  EXPECT_LT(energies.imbalance_over_work(), 0.01);
  for (double Energies::*term : {&Energies::strain, &Energies::slip, &Energies::released, &Energies::damping})
    {
      Energies wrong = energies;
      wrong.*term *= 2.0;
      EXPECT_TRUE(wrong.imbalance_over_work() > 0.01 || energies.*term < 0.03 * energies.boundary_work);
    }
  EXPECT_GT(energies.slip, 0.03 * energies.boundary_work);
  EXPECT_GT(energies.damping, 0.03 * energies.boundary_work);
}

TEST(Energies, KineticEnergyIsThatOfTheMotionAndTheSteadyStartIsCounted)
{
  // All tests set off with v = ε̇ (y - H/2): Σ ½ m v².
  const auto specimen = small_specimen();
  const auto& grains = specimen.grains;
  double set_off = 0.0;
  for (std::size_t i = 0; i < grains.size(); ++i)
    set_off += 0.5 * grains.mass[i] * std::pow(grains.position[1][i] - 0.5 * specimen.size[1], 2);
  TestParameters wanted; // 1/s
  wanted.stop_strain = 3e-4;
  LabTest<2> uniaxial({uniaxial_compression}, specimen, wanted, {});
  LabTest<2> triaxial({triaxial_compression, 10e6}, specimen, wanted, {});
  for (LabTest<2>* test : {&uniaxial, &triaxial})
    {
      while (test->advance())
        ;
      const auto record = test->finish(false).record;
      // Seating leaves the grains a tenth of that speed of their own, which adds twice as much to the square.
      const double tolerance = test == &uniaxial ? 1e-12 : 0.25;
      EXPECT_NEAR(record.curve.front().energies.kinetic, set_off, tolerance * set_off);
      EXPECT_NEAR(record.curve.front().energies.kinetic_at_start, set_off, tolerance * set_off);
      // A steady stretch keeps the energy it was set off with, which is not small beside the work of the first rows.
      const Energies later = record.curve[5].energies;
      EXPECT_NEAR(later.kinetic, set_off, 0.2 * set_off);
      EXPECT_LT(std::abs(later.unaccounted()), 0.1 * set_off); // 0.06; all of it, if it were not counted
    }
}

TEST(Curve, ARowThatIsBrokenOffIsGoneOnWithToTheSameBits)
{
  struct BrokenOff
  {
  };
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  const LaboratoryCase wanted{triaxial_compression, 10e6};
  TestParameters parameters;
  parameters.seating_transits = 2.0;
  parameters.of<CompressionParameters>().sampling_strain = 1e-4;
  const auto specimen = small_specimen();
  LabTest<2> whole(wanted, specimen, parameters, {});
  LabTest<2> broken(wanted, specimen, parameters, {});
  for (int n = 0; n < 3; ++n)
    whole.advance();
  // In the seating there is nothing to keep.
  EXPECT_THROW(broken.advance([] { throw BrokenOff(); }), BrokenOff);
  EXPECT_FALSE(broken.is_seated());

  LabTest<2> begun(wanted, specimen, parameters, {});
  begun.advance();
  std::uint64_t n_steps = 0;
  EXPECT_THROW(begun.advance([&] {
    if (++n_steps > 100)
      throw BrokenOff();
  }),
               BrokenOff);
  EXPECT_EQ(begun.curve().size(), 2u);
  begun.write_checkpoint(file, "this one");
  LabTest<2> resumed(wanted, specimen, parameters, {});
  resumed.read_checkpoint(file, "this one");
  for (LabTest<2>* test : {&begun, &resumed})
    {
      test->advance();
      test->advance();
      ASSERT_EQ(test->n_steps(), whole.n_steps());
      for (std::size_t k = 0; k < whole.curve().size(); ++k)
        {
          EXPECT_EQ(test->curve()[k].axial_stress, whole.curve()[k].axial_stress);
          EXPECT_EQ(test->curve()[k].lateral_stress, whole.curve()[k].lateral_stress);
        }
    }
}

// A grain without a contact is no part of the body: the strain of the body is the same with it and without it. A gauge
// that counted it would be off by its share of the moment of the positions times the difference of its motion, here 1.4 %
// of the axial strain.
TEST(StrainGauge, DoesNotSeeALooseGrain)
{
  Specimen<2> with = small_specimen();
  // The grain farthest from the middle of the height among those well inside the gauge weighs most.
  std::uint32_t loose = 0;
  double farthest = 0.0;
  for (std::uint32_t i = 0; i < with.grains.size(); ++i)
    {
      const Vector<2> from_middle = at<2>(with.grains.position, i) - 0.5 * with.size;
      if (std::abs(from_middle[0]) < 0.3 * with.size[0] && std::abs(from_middle[1]) < 0.24 * with.size[1] &&
          std::abs(from_middle[1]) > farthest)
        {
          farthest = std::abs(from_middle[1]);
          loose = i;
        }
    }
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < with.joints.size(); ++j)
    if (with.joints.grain_1[j] != loose && with.joints.grain_2[j] != loose)
      kept.push_back(j);
  with.joints.keep(kept);
  with.grains.radius[loose] *= 0.8;

  Specimen<2> without = with;
  std::vector<double> radii;
  Components<2> positions;
  for (std::uint32_t i = 0; i < with.grains.size(); ++i)
    if (i != loose)
      {
        radii.push_back(with.grains.radius[i]);
        for (int c = 0; c < 2; ++c)
          positions[c].push_back(with.grains.position[c][i]);
      }
  const double density = with.grains.mass[0] / grain_volume<2>(with.grains.radius[0], with.thickness);
  without.grains.place(radii, positions);
  without.grains.set_density(density, with.thickness);
  for (auto* grain : {&without.joints.grain_1, &without.joints.grain_2})
    for (std::uint32_t& i : *grain)
      i -= i > loose;

  const auto pressed = [](const Specimen<2>& specimen) {
    LabTest<2> test({triaxial_compression, 20e6}, specimen, {}, {});
    while (test.curve().size() < 20)
      test.advance();
    return test.curve();
  };
  const auto with_it = pressed(with);
  const auto without_it = pressed(without);
  for (std::size_t k = 1; k < with_it.size(); ++k)
    {
      EXPECT_NEAR(with_it[k].axial_stress, without_it[k].axial_stress, 1e-9 * std::abs(without_it[k].axial_stress));
      EXPECT_NEAR(with_it[k].gauge_axial_strain, without_it[k].gauge_axial_strain,
                  1e-6 * std::abs(without_it[k].gauge_axial_strain));
    }
}

TEST(Curve, LateralStressIsTheMeanSinceTheRowBefore)
{
  // A row stands for all steps since the one before: rows twice as far apart hold the means of two, weighted by time.
  const auto specimen = small_specimen();
  const auto curve = [&](const double sampling_strain) {
    TestParameters wanted;
    wanted.of<CompressionParameters>().sampling_strain = sampling_strain;
    wanted.stop_strain = 4e-4;
    return tests::outcome_of<2>({triaxial_compression, 10e6}, specimen, wanted).record.curve;
  };
  const auto fine = curve(1e-5);
  const auto coarse = curve(2e-5);
  for (std::size_t k = 1; k < coarse.size(); ++k)
    {
      const double first = fine[2 * k - 1].time - fine[2 * k - 2].time;
      const double second = fine[2 * k].time - fine[2 * k - 1].time;
      ASSERT_EQ(coarse[k].step, fine[2 * k].step);
      EXPECT_NEAR(coarse[k].lateral_stress,
                  (first * fine[2 * k - 1].lateral_stress + second * fine[2 * k].lateral_stress) / (first + second),
                  1e-9 * 10e6);
    }
}

TEST(Seating, TakesTheTransitsAskedForAndWastesLessTheLongerItTakes)
{
  // The pressure rises over n transits of a wave, n H / √(E_c/ρ), and is held for half as long. Raised at once it would
  // lose as much in damping as it stores; raised slowly, less and less.
  const auto specimen = small_specimen();
  const double transit = specimen.size[1] / std::sqrt(specimen.particle_contact.modulus / specimen.bulk_density);
  double lost_before = 1.0;
  for (const double n_transits : {2.0, 10.0, 50.0})
    {
      TestParameters wanted;
      wanted.seating_transits = n_transits;
      const auto seated = triaxial_compression.set_up<2>().value()(specimen, 30e6, wanted, {});
      auto dynamics = seated.dynamics;
      seated.loading.seat(dynamics, [] {});
      EXPECT_GE(dynamics.time(), 1.5 * n_transits * transit);
      // Raised too fast, the pressure takes longer to come to rest.
      EXPECT_LT(dynamics.time(), (n_transits < 10.0 ? 4.0 : 1.51) * n_transits * transit);
      const Energies energies = dynamics.energies();
      const double lost = energies.damping / energies.boundary_work;
      EXPECT_LT(lost, 0.5 * lost_before);
      lost_before = lost;
    }
}

TEST(StopRules, AreKept)
{
  const auto specimen = small_specimen();
  const auto run = [&](const TestParameters& wanted) {
    LabTest<2> test({direct_tension}, specimen, wanted, {});
    while (test.advance())
      ;
    return test.curve().back();
  };
  TestParameters at_strain;
  at_strain.stop_strain = 5e-5;
  EXPECT_NEAR(run(at_strain).axial_strain, 5e-5, 1.1 * at_strain.of<TensionParameters>().sampling_strain);
  TestParameters at_stress;
  at_stress.stop_stress_over_peak = 0.3;
  const auto fallen = run(at_stress);
  const auto usual = run({});
  EXPECT_LT(fallen.axial_strain, usual.axial_strain); // brittle: falls long before 1.6 times the strain at peak
  // Two rules, of which the first that is met ends the test.
  TestParameters either = at_stress;
  either.stop_strain = at_strain.stop_strain;
  EXPECT_EQ(run(either).axial_strain, run(at_strain).axial_strain);
  either.stop_strain = 2.0 * fallen.axial_strain;
  EXPECT_EQ(run(either).axial_strain, fallen.axial_strain);
  // Longer grips leave less free length: at one strain rate over that length the grips move slower.
  TestParameters long_grips = at_strain;
  long_grips.of<TensionParameters>().grip_ratio = 0.3;
  EXPECT_NEAR(run(long_grips).axial_strain, 5e-5, 1.1 * at_strain.of<TensionParameters>().sampling_strain);
}

TEST(StopRules, EndADiscThatBearsMoreAfterItsFirstFall)
{
  // The whole disc carries 10 MPa at a strain of 1e-3; its halves fall to 9 MPa and rise to 30, never below the share
  // of 0.7.
  TestParameters wanted;
  wanted.stop_stress_over_peak = 0.7;
  const auto end = [&](const LaboratoryProtocol& protocol) {
    StopRule rule(protocol.kind, 0.0, {});
    CurveSample row;
    rule.add(row);
    row.n_tension_cracks = 1;
    for (int k = 1; k <= 60; ++k)
      {
        row.axial_strain = -1e-4 * k;
        row.axial_stress = -1e6 * (k <= 10 ? k : k == 11 ? 9.0 : 9.0 + 0.43 * (k - 11));
        rule.add(row);
        if (rule.is_met_by(row, wanted))
          return k;
      }
    return 0;
  };
  EXPECT_EQ(end(brazilian), 16);
  EXPECT_EQ(end(uniaxial_compression), 0); // where the highest stress is the strength, the share of it decides
}

TEST(StopRules, EndABodyThatBearsNothing)
{
  const auto end = [](const std::optional<double> stop_strain) {
    StopRule rule(semicircular_bending.kind, 0.0, {});
    rule.needs_crack = true;
    TestParameters wanted;
    wanted.stop_strain = stop_strain;
    CurveSample row;
    for (int k = 1; k <= 80; ++k)
      {
        row.axial_strain = rule.kind.sign * 1e-3 * k;
        rule.add(row);
        if (rule.is_met_by(row, wanted))
          {
            EXPECT_EQ(rule.bears_nothing(row, wanted), !stop_strain);
            return k;
          }
      }
    return 0;
  };
  EXPECT_EQ(end({}), 50);
  EXPECT_EQ(end(0.07), 70); // who asks for a strain gets it
}

TEST(Energies, ImbalanceSeesADoubledTerm)
{
  Energies energies{10.0, 1.0, 4.0, 2.0, 1.0, 2.0};
  EXPECT_NEAR(energies.imbalance(), 0.0, 1e-15);
  energies.slip *= 2.0;
  EXPECT_GT(energies.imbalance(), 0.05); // 2 of 22
}
} // namespace
} // namespace feldspar
