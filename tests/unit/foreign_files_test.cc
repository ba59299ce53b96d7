// Files as testing machines, other codes, spreadsheets and programs for statistics write them, which are seeds of the fuzzers
// too: each is read to the right numbers, or refused by name. They were made for these tests, after the formats.

#include "app/input/curves/laboratory_curve.h"
#include "dem/genesis/packing_table.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

namespace feldspar
{
namespace
{
using tests::has;

const std::filesystem::path corpus = std::filesystem::path(FELDSPAR_SOURCE_DIR) / "tests/fuzz/corpus";

template <typename Read>
void expect_refused(const Read& read, const std::string& words)
{
  EXPECT_TRUE(has(tests::refusal(read), words));
}

// An elastic rock of 50 GPa, ν = 0.25, with a strength of 120 MPa beyond its confining pressure. Files round to 5 digits.
TEST(ForeignFiles, OfTestingMachinesAndSpreadsheets)
{
  struct Curve
  {
    const char* file;
    double pressure; ///< [MPa]
    bool has_lateral;
  };
  for (const auto& [file, pressure, has_lateral] : {Curve{"mts", 0.0, false},
                                                    {"instron", 0.0, false},
                                                    {"gcts", 15.05, true},
                                                    {"r", 0.0, true},
                                                    {"pandas", 0.0, true},
                                                    {"libreoffice", 0.0, true},
                                                    {"excel-in-german", 0.0, true},
                                                    {"excel-in-english", 0.0, true},
                                                    {"excel-unicode-text", 0.0, false}})
    {
      SCOPED_TRACE(file);
      const Series series = read_laboratory_curves({{corpus / "curve" / file, CylinderSize{0.05, 0.1}}});
      const TestResults& results = series.tests.front().results;
      EXPECT_NEAR(series.tests.front().record.confining_pressure, 1e6 * pressure, 1e4);
      EXPECT_NEAR(results.peak_stress.value.value(), 1e6 * (120.0 + pressure), 1e5);
      EXPECT_NEAR(results.youngs_modulus_initial.value.value(), 50e9, 1e-3 * 50e9);
      EXPECT_EQ(results.poissons_ratio_initial.value.has_value(), has_lateral);
      EXPECT_NEAR(results.poissons_ratio_initial.value.value_or(0.25), 0.25, 1e-3);
    }
  for (const auto& [file, kind, strength] :
       {std::tuple("brazilian", "brazilian", 9.5e6), {"direct-tension", "direct_tension", 8e6}})
    {
      const Series series = read_laboratory_curves({{corpus / "curve" / file}});
      EXPECT_EQ(series.tests.front().record.kind.name, kind);
      EXPECT_NEAR(series.tests.front().results.peak_stress.value.value(), strength, 1.0);
    }
  const auto read = [](const char* const file) {
    return [=] { read_laboratory_curves({{corpus / "curve" / file, CylinderSize{0.05, 0.1}}}); };
  };
  expect_refused(read("zwick-in-german"), "there is no column axial_strain, nor axial_displacement");
  expect_refused(read("thousands"), "thousands:3: Axial load [N]: \"10,000\" may mean 10.000 or 10000");
}

// Three spheres, of which the first two touch.
TEST(ForeignFiles, OfOtherCodes)
{
  const std::vector<double> expected{0.002, 0.005, 0.003, 0.001, 0.004, 0.005,
                                     0.003, 0.001, 0.006, 0.004, 0.002, 0.0005};
  const auto read = [](const char* const file) { return read_packing_table(corpus / "packing" / file, 3, 1.0, [] {}); };
  for (const char* const file :
       {"yade-text", "yade-text-ext", "lammps-bpm", "lammps-hybrid", "lammps-dump-of-two-steps", "pfc-list",
        "pfc-numbers-only", "excel-in-german", "utf-16"})
    {
      SCOPED_TRACE(file);
      const PackingTable packing = read(file);
      std::vector<double> numbers;
      for (const PackedGrain& grain : packing.grains)
        {
          numbers.insert(numbers.end(), grain.position.begin(), grain.position.end());
          numbers.push_back(grain.radius);
        }
      ASSERT_EQ(numbers.size(), expected.size());
      for (std::size_t k = 0; k < numbers.size(); ++k)
        EXPECT_DOUBLE_EQ(numbers[k], expected[k]);
    }
  const auto bonds = read("lammps-bpm").bonds;
  ASSERT_EQ(bonds.size(), 1u);
  EXPECT_EQ(bonds[0].first, 0u);
  EXPECT_EQ(bonds[0].second, 1u);
  expect_refused([&] { read("lammps-dump-scaled"); }, "there is no column x");
  expect_refused([&] { read("lammps-atomic"); }, "atoms have the style \"atomic\"");
}
} // namespace
} // namespace feldspar
