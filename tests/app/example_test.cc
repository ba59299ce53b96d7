// The figures in the READMEs of the examples are those of the committed results.

#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <string>

namespace feldspar::tests
{
namespace
{
const std::string example = std::string(FELDSPAR_SOURCE_DIR) + "/examples/beishan-granite/";

std::string content(const std::string& file)
{
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A row of a README's table: its name, and the result it shows.
struct Row
{
  std::string name;
  std::string kind;
  std::string key;
  double scale;
  int decimals;
};

TEST(Example, TheReadmeShowsTheCommittedResults)
{
  const std::string readme = content(example + "README.md");
  const auto results = nlohmann::json::parse(content(example + "results/beishan.json"));
  for (const auto& [name, kind, key, scale, decimals] : std::initializer_list<Row>{
         {"tensile strength [MPa]", "direct_tension", "peak_stress_Pa", 1e6, 2},
         {"strain at the tensile peak [1e-4]", "direct_tension", "strain_at_peak", 1e-4, 2},
         {"uniaxial compressive strength [MPa]", "uniaxial_compression", "peak_stress_Pa", 1e6, 1},
         {"Young's modulus, tangent at half of the peak [GPa]", "uniaxial_compression", "youngs_modulus_tangent_Pa",
          1e9, 1},
         {"Young's modulus, initial [GPa]", "uniaxial_compression", "youngs_modulus_initial_Pa", 1e9, 1},
         {"Poisson's ratio, secant at half of the peak", "uniaxial_compression", "poissons_ratio_secant", 1.0, 3},
         {"Poisson's ratio, initial", "uniaxial_compression", "poissons_ratio_initial", 1.0, 3},
         {"crack initiation stress in compression [MPa]", "uniaxial_compression", "crack_initiation_stress_Pa", 1e6, 1},
         {"tension cracks in the tension test", "direct_tension", "n_tension_cracks", 1.0, 0},
         {"shear cracks in the tension test", "direct_tension", "n_shear_cracks", 1.0, 0},
         {"tension cracks in the compression test", "uniaxial_compression", "n_tension_cracks", 1.0, 0},
         {"shear cracks in the compression test", "uniaxial_compression", "n_shear_cracks", 1.0, 0}})
    for (const auto& test : results["tests"])
      if (test["kind"] == kind)
        {
          const std::string row = fmt::format("\n| {} | {:.{}f} |", name, test[key].get<double>() / scale, decimals);
          EXPECT_NE(readme.find(row), std::string::npos) << "missing:" << row;
        }
}

TEST(Documentation, ParametersAreThoseOfTheCommand)
{
  const TemporaryFolder folder;
  EXPECT_EQ(content(std::string(FELDSPAR_SOURCE_DIR) + "/docs/parameters.md"),
            run_feldspar(folder.path(), "parameters --markdown").output)
    << "write it anew: feldspar parameters --markdown > docs/parameters.md";
}

TEST(Example, TheInputIsComplete)
{
  const TemporaryFolder folder;
  const auto outcome = run_feldspar(folder.path(), "parameters --check '" + example + "beishan.prm'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
}
} // namespace
} // namespace feldspar::tests
