// Tables as testing machines, spreadsheets and programs for statistics write them, and the curves that they hold.

#include "app/input/curves/laboratory_curve.h"
#include "base/input_error.h"
#include "base/table/csv.h"
#include "dem/lab/protocols/protocols.h"
#include "results/fits/run_envelopes.h"
#include "results/fits/strength_envelopes.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

constexpr double E = 50e3;  // [MPa]
constexpr double ucs = 120; // [MPa]
constexpr double nu = 0.25;

/// One row of a curve that is elastic up to its peak and falls to a half at 1.2 times the strain there; strains in per cent,
/// stresses in MPa.
struct Row
{
  double strain;
  double lateral;
  double stress;
};

std::vector<Row> rows(const bool falls = true)
{
  std::vector<Row> all;
  for (int k = 0; k <= 120; ++k)
    all.push_back({k / E * 100.0, -nu * k / E * 100.0, double(k)});
  for (int k = 1; falls && k <= 24; ++k)
    all.push_back({(120.0 + k) / E * 100.0, -nu * (120.0 + 5.0 * k) / E * 100.0, 120.0 - 2.5 * k});
  return all;
}

std::string table(const std::string& header, const std::function<std::string(const Row&)>& line,
                  const bool falls = true)
{
  std::string text = header + "\n";
  for (const Row& row : rows(falls))
    text += line(row) + "\n";
  return text;
}

std::string with_commas(std::string number)
{
  std::replace(number.begin(), number.end(), '.', ',');
  return number;
}

std::string in_utf16(const std::string& text)
{
  std::string wide = "\xff\xfe";
  for (const char c : text)
    wide += {c, '\0'};
  return wide;
}

class LaboratoryCurve : public testing::Test
{
protected:
  Series read(const std::string& text, const std::optional<CylinderSize>& size = {},
              const std::optional<TestKind>& kind = {}) const
  {
    return read_laboratory_curves({{folder.write("core.csv", text), size, kind}});
  }

  /// Strength 120 MPa, modulus 50 GPa, and Poisson's ratio 0.25 where the curve has lateral strains.
  void expect_rock(const std::string& text, const bool has_lateral, const std::optional<CylinderSize>& size = {}) const
  {
    SCOPED_TRACE(text.substr(0, 200));
    const Series series = read(text, size);
    ASSERT_EQ(series.tests.size(), 1u);
    const TestResults& results = series.tests.front().results;
    ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
    EXPECT_NEAR(*results.peak_stress.value, 1e6 * ucs, 1.0);
    ASSERT_TRUE(results.youngs_modulus_initial.value) << results.youngs_modulus_initial.reason;
    EXPECT_NEAR(*results.youngs_modulus_initial.value, 1e6 * E, 1e-6 * 1e6 * E);
    ASSERT_EQ(results.poissons_ratio_initial.value.has_value(), has_lateral);
    if (has_lateral)
      EXPECT_NEAR(*results.poissons_ratio_initial.value, nu, 1e-6);
    else
      for (const Figure* figure : {&results.poissons_ratio_initial, &results.poissons_ratio_secant,
                                   &results.crack_damage_stress, &results.crack_initiation_stress_lateral})
        {
          EXPECT_FALSE(figure->value);
          EXPECT_EQ(figure->reason, "the measured curve has no lateral strain");
        }
  }

  void refuse(const std::string& text, const std::string& words, const std::optional<CylinderSize>& size = {}) const
  {
    EXPECT_TRUE(has(tests::refusal([&] { read(text, size); }), words)) << text.substr(0, 200);
  }

  TemporaryFolder folder;
};

TEST_F(LaboratoryCurve, IsReadAsMachinesAndSpreadsheetsWriteIt)
{
  const auto three = [](const Row& row) {
    return fmt::format("{:.9f},{:.9f},{:.9f}", row.strain, row.lateral, row.stress);
  };
  const auto german = [](const Row& row) {
    return with_commas(fmt::format("{:.9f};{:.9f};{:.9f};", row.strain, row.lateral, row.stress));
  };
  const std::string plain = table("axial_strain [%],lateral_strain [%],axial_stress [MPa]", three);
  expect_rock(plain, true);
  expect_rock("\xef\xbb\xbf" + plain, true);
  // R and pandas: quotes, and a column of row numbers without a name.
  int k = 0;
  expect_rock(table("\"\",\"Axial Strain (%)\",\"Radial strain (%)\",\"Axial stress (MPa)\"",
                    [&](const Row& row) { return fmt::format("\"{}\",{}", ++k, three(row)); }),
              true);
  // A German spreadsheet: semicolons, decimal commas, line ends of Windows, an empty column at the end.
  expect_rock(table("Axial Strain [%];Lateral Strain [%];Axial Stress [N/mm2];\r", german), true);
  expect_rock(in_utf16(table("Axial Strain [%];Lateral Strain [%];Axial Stress [MPa];", german)), true);
  // A testing machine: a preamble, a line of units, tabs.
  expect_rock("Test: UCS; granite\nOperator:\tA. N.\nDate:\t3.4.2019\n\n" +
                table("Time\tAxial strain\tLateral strain\tAxial stress\ns\t%\t%\tMPa",
                      [](const Row& row) {
                        return fmt::format("1.0\t{:.9f}\t{:.9f}\t{:.9f}", row.strain, row.lateral, row.stress);
                      }),
              true);
  // numpy.savetxt, and units behind a slash.
  expect_rock(table("# Axial strain / %,Lateral strain / microstrain,Axial stress / MPa",
                    [](const Row& row) {
                      return fmt::format("{:.9f},{:.9f},{:.9f}", row.strain, 1e4 * row.lateral, row.stress);
                    }),
              true);
  // Volumetric strain in place of the lateral one.
  expect_rock(table("axial_strain [%],volumetric_strain [%],axial_stress [MPa]",
                    [](const Row& row) {
                      return fmt::format("{:.9f},{:.9f},{:.9f}", row.strain, row.strain + 2.0 * row.lateral,
                                         row.stress);
                    }),
              true);
}

TEST_F(LaboratoryCurve, MayLackGaugePressureAndFall)
{
  const auto two = [](const Row& row) { return fmt::format("{:.9f},{:.9f}", row.strain, row.stress); };
  expect_rock(table("axial_strain [%],axial_stress [MPa]", two), false);
  const std::string to_failure = table("axial_strain [%],axial_stress [MPa]", two, false);
  expect_rock(to_failure, false);
  const Series series = read(to_failure);
  ASSERT_EQ(series.problems.size(), 1u);
  EXPECT_TRUE(has(series.problems[0], "the record ends at its highest stress, which is taken as the strength"));
  const TestResults& results = series.tests.front().results;
  EXPECT_EQ(results.post_peak_drop.reason, "the measured curve ends at its highest stress");
  EXPECT_FALSE(results.residual_deviator_ratio.value);
  // The noise of a pressure cell in the open.
  int k = 0;
  expect_rock(table("axial_strain [%],axial_stress [MPa],confining_pressure [MPa]",
                    [&](const Row& row) { return two(row) + fmt::format(",{:.3f}", 0.02 * std::sin(++k)); }),
              false);
}

TEST_F(LaboratoryCurve, OfForcesAndDisplacementsNeedsTheSizeOfItsCylinder)
{
  const CylinderSize size = parse_cylinder_size("50, 100 mm");
  const double section = std::numbers::pi / 4.0 * 50.0 * 50.0; // [mm^2]
  const std::string text = table("Displacement (mm),Load (kN)", [&](const Row& row) {
    return fmt::format("{:.9f},{:.9f}", row.strain / 100.0 * 100.0, row.stress * section / 1e3);
  });
  expect_rock(text, false, size);
  refuse(text, "forces and displacements need the size of the specimen, as --curve-size \"50, 100 mm\"");
  for (const char* const wrong : {"50 mm", "50, 0 mm", "50, 100", "50, 100, 20 mm"})
    EXPECT_THROW(parse_cylinder_size(wrong), InputError) << wrong;
}

// Strength 8 MPa at E = 40 GPa and ν = 0.2: tension is the positive or the negative sign, by the file.
TEST_F(LaboratoryCurve, OfDirectTensionHasEitherSign)
{
  const auto curve = [](const std::string& header, const double of_strain, const double of_stress) {
    std::string text = header + "\n";
    for (int k = 0; k <= 84; ++k)
      {
        const double stress = k <= 80 ? 0.1 * k : 8.0 - 2.0 * (k - 80);
        const double strain = k / 80.0 * 8.0 / 40e3 * 100.0;
        text +=
          fmt::format("{:.9f},{:.9f},{:.9f}\n", of_strain * strain, -0.2 * of_strain * strain, of_stress * stress);
      }
    return text;
  };
  const std::string tensile = "Tensile strain [%],Lateral strain [%],Tensile stress [MPa]";
  const std::string axial = "Axial strain [%],Lateral strain [%],Axial stress [MPa]";
  for (const auto& series :
       {read(curve(tensile, 1.0, 1.0)), read(curve(tensile, -1.0, 1.0)),
        read(curve(axial, 1.0, 1.0), {}, direct_tension.kind), read(curve(axial, -1.0, -1.0), {}, direct_tension.kind)})
    {
      const FinishedTest& test = series.tests.front();
      EXPECT_EQ(test.record.kind.name, "direct_tension");
      EXPECT_NEAR(test.results.peak_stress.value.value(), 8e6, 1.0);
      EXPECT_NEAR(test.results.youngs_modulus_initial.value.value(), 40e9, 1e-6 * 40e9);
      EXPECT_NEAR(test.results.poissons_ratio_initial.value.value(), 0.2, 1e-6);
      EXPECT_FALSE(test.results.crack_damage_stress.value);
      EXPECT_NE(test.results.crack_damage_stress.reason, "");
    }
  refuse(curve(axial, -1.0, -1.0), "a specimen that is pulled needs --curve-test direct_tension");
}

// 2P/(πDt) of a disc of 50 x 25 mm: 19.63 kN are 10 MPa. The halves carry more than the disc did.
TEST_F(LaboratoryCurve, OfASplitDiscEndsAtTheFallOfItsLoad)
{
  const double load = 10e6 * std::numbers::pi * 0.05 * 0.025 / 2.0;
  std::string text = "Displacement (mm),Load (kN)\n";
  for (int k = 0; k <= 50; ++k)
    text += fmt::format("{:.6f},{:.6f}\n", 0.004 * k, load / 1e3 * k / 50.0 * (k == 30 ? 0.98 : 1.0)); // noise
  for (int k = 0; k < 40; ++k)
    text += fmt::format("{:.6f},{:.6f}\n", 0.2 + 0.004 * k, load / 1e3 * (0.3 + 0.02 * k));
  const CylinderSize disc{0.05, 0.025};
  const Series series = read(text, disc, brazilian.kind);
  const TestResults& results = series.tests.front().results;
  EXPECT_NEAR(results.peak_stress.value.value(), 10e6, 10.0);
  EXPECT_NEAR(results.strain_at_peak.value.value(), 0.2 / 50.0, 1e-9);
  EXPECT_FALSE(results.youngs_modulus_initial.value);
  EXPECT_EQ(results.youngs_modulus_initial.reason, "the stress in this test is not uniform");
  EXPECT_TRUE(results.is_valid());
  refuse(text, "a disc that is split needs --curve-test brazilian", disc);
  EXPECT_EQ(read("strain [%],Splitting stress [MPa]\n0,0\n0.1,6\n0.2,9\n").tests.front().record.kind.name, "brazilian");
}

TEST(MeasuredCurves, HaveTheirSizesAndTestsInTheirOrder)
{
  const auto curves = measured_curves({"a", "b"}, {"50, 100 mm", "54, 27 mm"}, {"triaxial_compression", "brazilian"});
  EXPECT_EQ(curves[1].size->height, 0.027);
  EXPECT_EQ(curves[1].kind->name, "brazilian");
  EXPECT_EQ(measured_curves({"a", "b"}, {"50, 100 mm"}, {})[1].size->height, 0.1);
  EXPECT_THROW(measured_curves({"a", "b", "c"}, {"50, 100 mm", "54, 27 mm"}, {}), InputError);
  EXPECT_THROW(measured_curves({"a"}, {}, {"tension"}), InputError);
}

TEST_F(LaboratoryCurve, UnderPressureBeginsWhereThePressureIsReached)
{
  std::string text = "axial_strain [%],deviator_stress [MPa],confining_pressure [MPa]\n";
  for (int k = 0; k < 10; ++k) // the cell is filled; the specimen shortens a little
    text += fmt::format("{:.9f},0,{}\n", 0.001 * k, 2.0 * k);
  for (const Row& row : rows())
    text += fmt::format("{:.9f},{:.9f},20\n", 0.01 + row.strain, row.stress);
  text += "0.4,10,3\n"; // the jacket fails
  const Series series = read(text);
  const FinishedTest& test = series.tests.front();
  EXPECT_EQ(test.record.confining_pressure, 20e6);
  EXPECT_EQ(test.record.kind.name, "triaxial_compression");
  EXPECT_NEAR(test.results.peak_stress.value.value(), 140e6, 1.0);
  EXPECT_NEAR(test.results.youngs_modulus_initial.value.value(), 1e6 * E, 1e-6 * 1e6 * E);
  ASSERT_EQ(series.problems.size(), 3u);
  EXPECT_TRUE(has(series.problems[0], "the first 10 rows, before the confining pressure was reached"));
  EXPECT_TRUE(has(series.problems[1], "the last 1 rows"));
  EXPECT_TRUE(has(series.problems[2], "strains are counted from row 1"));
}

// Both are less than 1 % of the peak stress; what wavers around zero is the noise of the cell.
TEST_F(LaboratoryCurve, KeepsASmallPressureThatIsHeld)
{
  const auto pressure_of = [&](const std::function<double(int)>& cell) {
    int k = 0;
    const Series series =
      read(table("axial_strain [%],axial_stress [MPa],confining_pressure [MPa]", [&](const Row& row) {
        return fmt::format("{:.9f},{:.9f},{:.6f}", row.strain, row.stress, cell(++k));
      }));
    return series.tests.front().record.confining_pressure;
  };
  EXPECT_EQ(pressure_of([](int) { return 0.5; }), 0.5e6);
  EXPECT_NEAR(pressure_of([](const int k) { return 0.5 + 0.04 * std::sin(k); }), 0.5e6, 1e3);
  EXPECT_EQ(pressure_of([](const int k) { return 0.5 * std::sin(k); }), 0.0);
  EXPECT_EQ(pressure_of([](const int k) { return 0.3 + 0.3 * std::sin(k); }), 0.0);
  EXPECT_EQ(pressure_of([](int) { return 0.0; }), 0.0);
}

// Peaks on a curve of Hoek and Brown of an intact rock, σ_ci = 100 MPa and m = 12: the fit finds both.
TEST_F(LaboratoryCurve, OfSeveralTestsGivesAnEnvelope)
{
  std::vector<MeasuredCurve> files;
  for (const double pressure : {0.0, 5.0, 10.0, 20.0, 40.0})
    {
      const double strength = pressure + 100.0 * std::sqrt(12.0 * pressure / 100.0 + 1.0);
      std::string text = "axial_strain [%],axial_stress [MPa],confining_pressure [MPa]\n";
      for (const Row& row : rows())
        text +=
          fmt::format("{:.9f},{:.9f},{}\n", row.strain, pressure + (strength - pressure) * row.stress / ucs, pressure);
      files.push_back({folder.write(fmt::format("tri{:g}.csv", pressure), text)});
    }
  // The curve meets σ_1 = 0 at t² + 12 t - 1 = 0 with t = σ_t/σ_ci.
  const double tensile = 100.0 * (std::sqrt(37.0) - 6.0); // [MPa]
  files.push_back({folder.write(
    "pull.csv", fmt::format("tensile strain [%],tensile stress [MPa]\n0,0\n0.005,4\n0.01,{}\n0.011,1\n", tensile))});
  const Series series = read_laboratory_curves(files);
  EXPECT_EQ(series.label, "measured curves");
  ASSERT_EQ(series.tests.size(), 6u);
  EXPECT_NEAR(strength_data(series.tests).tensile_strength.value(), 1e6 * tensile, 1.0);
  EXPECT_EQ(series.tests[2].name, "tri10");
  const StrengthEnvelopes envelopes = fit_strength_envelopes(strength_data(series.tests));
  const auto* const fit = envelopes.representative();
  ASSERT_NE(fit, nullptr);
  EXPECT_NEAR(fit->sigma_ci.value, 100e6, 1e-3 * 100e6);
  EXPECT_NEAR(fit->m.value, 12.0, 1e-3 * 12.0);
}

TEST_F(LaboratoryCurve, ThatCannotBeMeantIsRefusedByLineAndReason)
{
  refuse("axial_strain [%],axial_stress\n0,0\n0.1,50\n0.2,100\n", "core.csv:1: \"axial_stress\" has no unit");
  refuse("axial_strain [%],lateral_strain [%]\n0,0\n", "there is no column axial_stress, nor axial_force");
  refuse("", "there is no column axial_strain");
  refuse("axial_strain [%];axial_stress [MPa]\n0,1;50\n0.2;100\n",
         "core.csv:3: axial_strain [%]: \"0.2\" has another decimal sign than the numbers before it");
  refuse("axial_strain [%];axial_stress [MPa]\n0,1;1.234,5\n", "\"1.234,5\"");
  refuse("axial_strain [%],axial_stress [MPa]\n0,\"0\n0.1,50\n", "core.csv:2: a double quote is opened and not closed");
  refuse("\xff\xfe"
         "a",
         "begins as UTF-16 and is not");
  refuse("axial_strain [%],axial_stress [MPa]\n0,0\n0.1\n", "core.csv:3: there must be 2 values");
}

TEST(CsvReader, TakesQuotesOffAsRfc4180Says)
{
  const TemporaryFolder folder;
  CsvReader table(
    folder.write("t.csv", "\"a, first\",b\r\n# a remark\n\"1\",\"with \"\"quotes\"\", and\nlines\"\r\n\n,\n2,3,,\n"));
  ASSERT_EQ(table.header().size(), 2u);
  EXPECT_EQ(table.header()[0], "a, first");
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.number(0), 1.0);
  EXPECT_EQ(table.text(1), "with \"quotes\", and\nlines");
  ASSERT_TRUE(table.next()); // an empty row and empty cells at the end are no mistakes
  EXPECT_EQ(table.number(1), 3.0);
  EXPECT_EQ(table.line_of_row(), 7u);
  EXPECT_FALSE(table.next());
}

// 1,234 is 1.234 in German and 1234 in English; any other number of the file may tell which.
TEST(CsvReader, TakesNoCommaForADecimalSignThatMayStandBetweenThousands)
{
  const TemporaryFolder folder;
  const auto read = [&](const std::string& numbers) {
    return read_csv(folder.write("t.csv", "a;b\n" + numbers + "\n"), "a,b");
  };
  for (const char* const clear : {"0,234", "-0,234", "12,34", "1,2345", "1,23", "1234,567", "1,234e2"})
    EXPECT_EQ(read(fmt::format("1,234;2\n3;{}", clear))[0][0], 1.234) << clear;
  EXPECT_EQ(read("0,5;1,234")[0][1], 1.234);
  for (const char* const unclear : {"1,234;2", "5;-12,345\n100,000;7", "1,234;2\n3;0.5"})
    EXPECT_TRUE(has(tests::refusal([&] { read(unclear); }), "; write thousands without a comma")) << unclear;
  EXPECT_TRUE(
    has(tests::refusal([&] { read("5;0\n7;-12,345"); }), "t.csv:3: b: \"-12,345\" may mean -12.345 or -12345"));
}

// Quotes counted anew with each line that is added would read some 10^12 characters here, for minutes.
TEST(CsvReader, FindsThatAQuoteIsNotClosedInOnePass)
{
  const TemporaryFolder folder;
  std::string text = "a,b\n1,\"2\n";
  for (int k = 0; k < 500000; ++k)
    text += "1,2\n3,4\n";
  const auto file = folder.write("t.csv", text);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(read_csv(file, "a,b"), InputError);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(CsvReader, RefusesAColumnThatIsThereTwice)
{
  const TemporaryFolder folder;
  const auto read = [&] { CsvReader(folder.write("t.csv", "group,, \"group\" ,\na,1,b,2\n")); };
  EXPECT_TRUE(tests::refusal(read).ends_with("t.csv:1: the column \"group\" is there twice"));
}

TEST(CsvReader, FindsColumnsInAnyOrderButNoOthers)
{
  const TemporaryFolder folder;
  const auto rows = read_csv(folder.write("t.csv", "\"\",\"to\",\"from\"\n\"1\",2,3\n"), "from,to");
  EXPECT_EQ(rows, (std::vector<std::vector<double>>{{3.0, 2.0}}));
  EXPECT_THROW(read_csv(folder.write("t.csv", "from,to,weight\n1,2,3\n"), "from,to"), InputError);
  EXPECT_THROW(read_csv(folder.write("t.csv", "from\n1\n"), "from,to"), InputError);
}
} // namespace
} // namespace feldspar
