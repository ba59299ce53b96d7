// A kind of test has the properties that it names and no other.

#include "base/readable_file.h"
#include "dem/lab/laboratory_protocol.h"
#include "dem/lab/protocols/protocols.h"
#include "report/sections/comparison.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/result_folder.h"
#include "results/runs/test_groups.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

namespace feldspar::tests
{
namespace
{
constexpr TestKind torsion{.name = "torsion", .title = "Torsion"};

/// Rises to `peak` [Pa] in 30 rows and falls to half of it in 10, in the sense of the kind.
FinishedTest finished(const TestKind& kind, const double peak, const double confining_pressure = 0.0)
{
  FinishedTest test;
  test.record.kind = kind;
  test.record.confining_pressure = confining_pressure;
  test.record.seed = 1;
  test.group = name(TestCase{kind, confining_pressure});
  test.name = test.group + "_seed_1";
  const double direction = kind.sign == 0.0 ? -1.0 : kind.sign;
  for (int k = 0; k <= 40; ++k)
    {
      CurveSample row;
      row.axial_strain = row.gauge_axial_strain = direction * 1e-4 * k;
      row.gauge_lateral_strain = direction * -2e-5 * k;
      row.axial_stress = direction * (k <= 30 ? peak * k / 30.0 : peak * (1.0 - 0.05 * (k - 30)));
      test.record.curve.push_back(row);
    }
  test.results = evaluate(test.record);
  return test;
}

FinishedTest true_triaxial(const double strength, const double confining_pressure, const double intermediate_stress)
{
  FinishedTest test = finished(triaxial_compression.kind, strength, confining_pressure);
  test.record.intermediate_stress = intermediate_stress;
  return test;
}

std::string rows(const std::vector<FinishedTest>& tests)
{
  std::string text;
  for (const auto& row : compare(tests, std::nullopt))
    if (row.ours)
      text += fmt::format("{}: {:.1f}\n", row.property, row.ours->mean);
  return text;
}

TEST(TestKinds, AreThoseOfTheManualAndSayWhatATestMust)
{
  EXPECT_EQ(names(test_kinds()),
            "direct_tension, uniaxial_compression, triaxial_compression, brazilian, three_point_bending, "
            "semicircular_bending, centre_cracked_plate, direct_shear, own_loading, tilt");
  std::set<std::string_view> all_names;
  for (const LaboratoryProtocol* protocol : laboratory_protocols())
    {
      EXPECT_NO_THROW(complete(*protocol));
      EXPECT_TRUE(all_names.insert(protocol->kind.name).second) << protocol->kind.name << " is there twice";
      EXPECT_EQ(&protocol_of(protocol->kind), protocol);
    }
  EXPECT_THROW(protocol_of(torsion), std::logic_error);
}

TEST(TestKinds, ThatSayTooLittleAreNoProtocol)
{
  // In a constant that is checked by complete() each of these is an error of the compiler.
  const LaboratoryProtocol whole = direct_tension;
  EXPECT_NO_THROW(complete(whole));
  for (const auto& spoil :
       {+[](LaboratoryProtocol& p) { p.kind.name = ""; }, +[](LaboratoryProtocol& p) { p.kind.title = ""; },
        +[](LaboratoryProtocol& p) { p.kind.strength = ""; },
        +[](LaboratoryProtocol& p) { p.kind.sign = TestKind{}.sign; },
        +[](LaboratoryProtocol& p) { p.strain_rate.reset(); },
        +[](LaboratoryProtocol& p) {
          std::get<0>(p.set_ups).reset();
          std::get<1>(p.set_ups).reset();
        }})
    {
      LaboratoryProtocol spoilt = whole;
      spoil(spoilt);
      EXPECT_THROW(complete(spoilt), std::logic_error);
    }
}

TEST(TestKinds, OfANameOnlyAreInNoEnvelope)
{
  // Even with a sign, so that it has a strength.
  TestKind pressing = torsion;
  pressing.sign = -1.0;
  const FinishedTest other = finished(pressing, 300e6);
  ASSERT_NEAR(*other.results.peak_stress.value, 300e6, 1.0);
  const FinishedTest pulled = finished(direct_tension.kind, 10e6);
  const FinishedTest pressed = finished(uniaxial_compression.kind, 100e6);
  const StrengthData data = strength_data({pulled, other, pressed});
  ASSERT_EQ(data.points.size(), 1u);
  EXPECT_NEAR(data.points[0].sigma_1, 100e6, 1.0);
  EXPECT_NEAR(*data.tensile_strength, 10e6, 1.0);
  EXPECT_NEAR(*data.uniaxial_compressive_strength, 100e6, 1.0);
  const StrengthData alone = strength_data({other});
  EXPECT_TRUE(alone.points.empty());
  EXPECT_FALSE(alone.tensile_strength);
  EXPECT_FALSE(alone.uniaxial_compressive_strength);
}

TEST(TestKinds, OfANameOnlyPressAndPullNothing)
{
  const FinishedTest test = finished(torsion, 300e6);
  EXPECT_FALSE(test.results.peak_stress.value);
  EXPECT_FALSE(peak_row(test.record));
}

TEST(TestKinds, OfANameOnlyRunOnNoFiniteElementsUnderNoPressureAndGiveNoElasticConstants)
{
  EXPECT_EQ(objection_to_finite_elements(torsion),
            "Tests/List: torsion: the sample stands between platens; it makes direct_tension, uniaxial_compression, "
            "triaxial_compression, own_loading");
  EXPECT_NE(objection_to_finite_elements(brazilian.kind), "");
  EXPECT_EQ(objection_to_finite_elements(triaxial_compression.kind), "");

  EXPECT_EQ(objection_to_grains(three_point_bending.kind, Body::box), "");
  EXPECT_EQ(objection_to_grains(three_point_bending.kind, Body::cylinder),
            "Tests/List: three_point_bending: is not made on cylinders of spheres; tests that are: direct_tension, "
            "uniaxial_compression, triaxial_compression, brazilian, semicircular_bending, own_loading, tilt");

  EXPECT_FALSE(any_takes_confining_pressure({torsion, direct_tension.kind}));
  EXPECT_EQ(test_cases({torsion}, {5e6, 10e6}).size(), 1u);
  EXPECT_EQ(name(TestCase{torsion, 5e6}), "torsion");
  EXPECT_EQ(test_cases({torsion, triaxial_compression.kind}, {5e6, 10e6}).size(), 3u);

  TestKind pressing = torsion;
  pressing.sign = -1.0;
  const FinishedTest test = finished(pressing, 300e6);
  EXPECT_FALSE(test.results.youngs_modulus_secant.value);
  EXPECT_FALSE(test.results.poissons_ratio_secant.value);
  EXPECT_FALSE(test.results.crack_damage_stress.value);
  EXPECT_TRUE(finished(uniaxial_compression.kind, 300e6).results.youngs_modulus_secant.value);
}

TEST(TestKinds, HaveAStrengthThatAReferenceCanGiveAndAComparisonFinds)
{
  for (const TestKind& kind : test_kinds())
    if (kind.envelope_role == EnvelopeRole::none)
      {
        const FinishedTest test = finished(kind, 30e6, kind.takes_confining_pressure ? 5e6 : 0.0);
        const TemporaryFolder folder;
        const std::string key =
          fmt::format("{}{}_strength_MPa", kind.name, kind.takes_confining_pressure ? "_5_MPa" : "");
        const Reference reference = read_reference(
          folder.write("rock.json", fmt::format("{{\"experiment\": {{\"{}\": {{\"mean\": 31}}}}}}", key)),
          test_kinds());
        const auto compared = compare({test}, reference);
        EXPECT_TRUE(
          std::any_of(compared.begin(), compared.end(),
                      [](const ComparisonRow& row) { return row.experiment && *row.experiment->mean == 31.0; }))
          << key;
      }
}

TEST(TestKinds, OfANameOnlyAreComparedUnderTheirOwnName)
{
  TestKind pressing = torsion;
  pressing.sign = -1.0;
  pressing.strength = "strength in torsion";
  EXPECT_EQ(rows({finished(pressing, 30e6)}), "strength in torsion: 30.0\n");
  // Others keep their rows.
  const std::string text =
    rows({finished(pressing, 30e6), finished(direct_tension.kind, 10e6), finished(uniaxial_compression.kind, 100e6),
          finished(brazilian.kind, 8e6), finished(triaxial_compression.kind, 150e6, 5e6)});
  EXPECT_TRUE(has(text, "tensile strength: 10.0\n", "uniaxial compressive strength: 100.0\n",
                  "strength at 5 MPa confinement: 150.0\n", "Brazilian tensile strength: 8.0\n",
                  "strength in torsion: 30.0\n"));
}

TEST(TestKinds, ThatTiltAPlateAreComparedByItsFrictionAngle)
{
  FinishedTest tilted = finished(tilt.kind, 1e-4);
  tilted.results.sliding_angle = {std::atan(0.6), ""};
  EXPECT_TRUE(has(rows({tilted}), "friction angle on the plate: 31.0\n"));
}

TEST(TestKinds, StandInTheOrderOfTheirPlaceInTheEnvelope)
{
  std::vector<TestKind> kinds{torsion, brazilian.kind, triaxial_compression.kind, uniaxial_compression.kind,
                              direct_tension.kind};
  std::sort(kinds.begin(), kinds.end(), [](const auto& a, const auto& b) { return comes_before(a, b); });
  EXPECT_EQ(names(kinds), "direct_tension, uniaxial_compression, triaxial_compression, brazilian, torsion");
}

TEST(TestKinds, OfAFolderThatAreNotKnownAreLeftOutAndNamed)
{
  const TemporaryFolder folder;
  TestKind pressing = torsion;
  pressing.sign = -1.0;
  write_result_folder({}, {finished(pressing, 30e6), finished(brazilian.kind, 8e6)}, {}, folder.path());
  const auto series = read_result_folder(folder.path(), test_kinds());
  ASSERT_EQ(series.size(), 1u);
  EXPECT_EQ(series[0].tests.size(), 1u);
  EXPECT_EQ(times(joined(series[0].problems), "of a kind"), 1u);
  EXPECT_EQ(read_result_folder(folder.path(), {pressing, brazilian.kind})[0].tests.size(), 2u);
}

TEST(TensileStrength, OfAnEnvelopeSaysFromWhichTestItIs)
{
  for (const TestKind& pulling : {brazilian.kind, direct_tension.kind})
    {
      std::vector<FinishedTest> tests{finished(pulling, 8e6), finished(uniaxial_compression.kind, 100e6)};
      for (const auto& [pressure, strength] : {std::pair(5e6, 135e6), {10e6, 165e6}, {20e6, 210e6}, {40e6, 285e6}})
        tests.push_back(finished(triaxial_compression.kind, strength, pressure));
      const TemporaryFolder folder;
      write_result_folder({}, tests, fit_each_rock(tests), folder.path());
      const std::string wanted = fmt::format("\"measured_tensile_strength_from\": \"{}\"", pulling.name);
      EXPECT_TRUE(has(content_of(folder.path() / "summary.json"), wanted));
    }
}

TEST(TrueTriaxialTests, AreNoPointOfAnEnvelopeThatKnowsNoIntermediateStress)
{
  const FinishedTest usual = finished(triaxial_compression.kind, 150e6, 5e6);
  const FinishedTest other = true_triaxial(220e6, 5e6, 40e6);
  const StrengthData data = strength_data({usual, other});
  ASSERT_EQ(data.points.size(), 1u);
  EXPECT_NEAR(data.points[0].sigma_1, 150e6, 1.0);

  // They are shown, and compared, apart.
  const Series series{"both", SeriesKind::specimens, {}, {usual, other}, {}};
  const auto groups = groups_of(series);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].title(), "Triaxial compression, 5 MPa");
  EXPECT_EQ(groups[1].title(), "Triaxial compression, 5 MPa, intermediate stress 40 MPa");
  EXPECT_NE(groups[0].name(), groups[1].name());
  EXPECT_EQ(groups[1].envelope_role(), EnvelopeRole::none);
  EXPECT_EQ(rows({usual, other}),
            "strength at 5 MPa confinement: 150.0\nstrength at 5 MPa confinement, 40 MPa intermediate stress: 220.0\n");
}

TEST(TrueTriaxialTests, AreReadBackAsSuch)
{
  const TemporaryFolder folder;
  write_result_folder({}, {true_triaxial(220e6, 5e6, 40e6)}, {}, folder.path());
  const auto series = read_result_folder(folder.path(), test_kinds());
  EXPECT_EQ(series.at(0).tests.at(0).record.intermediate_stress, 40e6);
}
} // namespace
} // namespace feldspar::tests
