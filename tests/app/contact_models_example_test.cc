// The figures of four contact models in the README of their example are those of the committed results, and what it says of
// them holds.

#include "tests/app/committed_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
using nlohmann::json;

const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/contact-models/";

json study(const std::string& name) { return results_of("contact-models", name); }

double ratio_of_strengths(const json& of)
{
  return mean_of(of, "direct_tension") / mean_of(of, "uniaxial_compression");
}

double slope(const json& of) { return of["fits"]["mohr_coulomb"]["slope"].get<double>(); }

const json& hoek_brown(const json& of) { return of["fits"]["intact"]["without_tension_point"]; }

void expect_shown(const std::string& row)
{
  static const std::string readme = content(folder + "README.md");
  EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
}

/// Within a sentence, wherever its lines break.
void expect_said(const std::string& words)
{
  static const std::string readme = [] {
    std::istringstream text(content(folder + "README.md"));
    std::string all;
    for (std::string word; text >> word;)
      all += word + ' ';
    return all;
  }();
  EXPECT_NE(readme.find(words), std::string::npos) << "missing: " << words;
}

TEST(ContactModels, StandInOneTable)
{
  const std::vector<json> models{study("parallel-bond"), study("clumped"), study("grain-based"), study("flat-joint")};
  const auto row = [&](const std::string& name, const std::function<std::string(const json&)>& figure) {
    std::string text = fmt::format("| {} |", name);
    for (const json& model : models)
      text += fmt::format(" {} |", figure(model));
    expect_shown(text);
  };
  for (const Row& one : {Row{"tensile strength [MPa]", "direct_tension", "peak_stress_Pa", 1e6, 2},
                         {"uniaxial compressive strength [MPa]", "uniaxial_compression", "peak_stress_Pa", 1e6, 1},
                         {"Young's modulus, tangent at half of the peak [GPa]", "uniaxial_compression",
                          "youngs_modulus_tangent_Pa", 1e9, 1},
                         {"strength at 5 MPa [MPa]", "triaxial_compression_5_MPa", "peak_stress_Pa", 1e6, 1},
                         {"strength at 20 MPa [MPa]", "triaxial_compression_20_MPa", "peak_stress_Pa", 1e6, 1},
                         {"strength at 60 MPa [MPa]", "triaxial_compression_60_MPa", "peak_stress_Pa", 1e6, 1}})
    row(one.name, [&](const json& of) { return mean_and_deviation(of, one.kind, one.key, one.scale, one.decimals); });
  row("ratio of their means", [](const json& of) { return fmt::format("{:.3f}", ratio_of_strengths(of)); });
  row("slope of the line of Mohr and Coulomb, σ₁ over σ₃",
      [](const json& of) { return fmt::format("{:.2f}", slope(of)); });
  row("its R²", [](const json& of) { return number(of["fits"]["mohr_coulomb"]["r_squared"], 1.0, 4); });
  row("R² of Hoek and Brown's curve, s = 1 and a = 0.5",
      [](const json& of) { return number(hoek_brown(of)["r_squared"], 1.0, 4); });

  const auto times = json::parse(content(std::string(FELDSPAR_SOURCE_DIR) +
                                         "/benchmarks/results/contact-models-benchmark-avx512.json"))["benchmarks"];
  std::string relative = "| time of an intact step, over that of the flat joint |";
  for (const char* const model : {"parallel_bond", "clumps", "grain_based", "flat_joint"})
    relative += fmt::format(" {:.1f} |", times[std::string("step/") + model]["processor_time_ns"].get<double>() /
                                           times["step/flat_joint"]["processor_time_ns"].get<double>());
  expect_shown(relative);

  // Like with like: the stiffness and the compressive strength of the rock, on packings of the same radii, in tests that end.
  double least_gap = 1.0;
  double largest_gap = 0.0;
  for (const json& of : models)
    {
      EXPECT_NEAR(mean_of(of, "uniaxial_compression"), 163e6, 15e6);
      EXPECT_NEAR(mean_of(of, "uniaxial_compression", "youngs_modulus_tangent_Pa"), 61e9, 3e9);
      ASSERT_EQ(of["tests"].size(), 25u);
      for (std::size_t k = 0; k < of["tests"].size(); ++k)
        {
          const json& test = of["tests"][k];
          EXPECT_EQ(test["name"], models[0]["tests"][k]["name"]);
          EXPECT_EQ(test["n_grains"], models[0]["tests"][k]["n_grains"]);
          const double gap = test["installation_gap_ratio"].get<double>();
          least_gap = std::min(least_gap, gap);
          largest_gap = std::max(largest_gap, gap);
          EXPECT_FALSE(test["interrupted"].get<bool>()) << test["name"];
          EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 0.01) << test["name"];
        }
    }
  // Grown with contacts of other moduli, they are not the same packings.
  expect_said(
    fmt::format("over models and specimens it is {:.3f} to {:.3f} of the mean radius", least_gap, largest_gap));
}

TEST(ContactModels, InSpaceTakeTheTimesOfTheBenchmark)
{
  const std::string benchmarks = content(std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/README.md");
  EXPECT_NE(benchmarks.find("| Feldspar, flat joint | 8 | 28.1 |"), std::string::npos);
  EXPECT_NE(benchmarks.find("| Feldspar, parallel bond | 1 | 36.2 |"), std::string::npos);
  expect_said(
    fmt::format("takes {:.1f} times as long as one of flat joints**, 36.2 against 28.1 ns a bond", 36.2 / 28.1));
}

TEST(ContactModels, ParallelBondsHaveTheRatioOfTheLiterature)
{
  // 0.30 to 0.36 is asked of the traditional model at the rock's stiffness and strength; the paper's own has 0.325.
  const auto bonds = study("parallel-bond");
  EXPECT_GT(ratio_of_strengths(bonds), 0.30);
  EXPECT_LT(ratio_of_strengths(bonds), 0.36);
}

TEST(ContactModels, ParallelBondsThatOnlyShearHaveALineAndThoseThatOpenACurve)
{
  const std::array<const char*, 4> tests{"uniaxial_compression", "triaxial_compression_5_MPa",
                                         "triaxial_compression_20_MPa", "triaxial_compression_60_MPa"};
  constexpr std::array<double, 4> pressures{0.0, 5e6, 20e6, 60e6};
  const auto mean_tension_share = [](const json& of, const std::string& test) {
    return 1.0 - mean_of(of, test, "shear_share_at_peak");
  };
  const auto row = [&](const std::string& name, const json& of) {
    std::string strengths, rises;
    for (std::size_t k = 0; k < tests.size(); ++k)
      {
        strengths += fmt::format(" {:.1f} |", mean_of(of, tests[k]) / 1e6);
        if (k > 0)
          rises += fmt::format("{}{:.1f}", k > 1 ? ", " : "",
                               (mean_of(of, tests[k]) - mean_of(of, tests[k - 1])) / (pressures[k] - pressures[k - 1]));
      }
    expect_shown(fmt::format("| {} |{} {} | {:.4f} | {:.4f} |", name, strengths, rises,
                             of["fits"]["mohr_coulomb"]["r_squared"].get<double>(),
                             hoek_brown(of)["r_squared"].get<double>()));
  };
  const json both = study("parallel-bond");
  const json shear = study("parallel-bond-shear-only");
  const json tension = study("parallel-bond-tension-only");
  row("bonds shear and open", both);
  row("bonds shear only", shear);
  row("bonds open only", tension);
  for (const char* const test : tests)
    {
      EXPECT_LT(mean_tension_share(shear, test), 0.005) << test;
      EXPECT_GT(mean_tension_share(tension, test), 0.995) << test;
    }
  expect_said(
    fmt::format("{:.0f} % are in tension without confinement, {:.0f} % at 5 MPa, {:.0f} % at 20 MPa and {:.0f} % "
                "at 60 MPa",
                100.0 * mean_tension_share(both, tests[0]), 100.0 * mean_tension_share(both, tests[1]),
                100.0 * mean_tension_share(both, tests[2]), 100.0 * mean_tension_share(both, tests[3])));
  // The claim of the page: a line where bonds shear, a curve where they open.
  EXPECT_GT(shear["fits"]["mohr_coulomb"]["r_squared"].get<double>(), hoek_brown(shear)["r_squared"].get<double>());
  EXPECT_LT(tension["fits"]["mohr_coulomb"]["r_squared"].get<double>(), hoek_brown(tension)["r_squared"].get<double>());
}

TEST(ContactModels, TheGrainBasedModelOpensAtItsBoundaries)
{
  // The range that is asked of a grain-based model (Potyondy 2010 has 0.047); most cracks at the peak are boundaries that
  // opened.
  const auto grains = study("grain-based");
  EXPECT_GT(ratio_of_strengths(grains), 0.035);
  EXPECT_LT(ratio_of_strengths(grains), 0.06);
  for (const char* const kind : {"direct_tension", "uniaxial_compression"})
    EXPECT_GT(mean_of(grains, kind, "smooth_tension_share_at_peak"), 0.6) << kind;
  for (const auto& test : grains["tests"])
    if (test["kind"] == "direct_tension")
      {
        EXPECT_EQ(test["smooth_tension_share_at_peak"].get<double>(), 1.0) << test["name"];
      }
  expect_said("Of the cracks at the peak in tension 100 % are boundaries that opened, in all five specimens.");
  expect_said("Of the cracks at the uniaxial peak " +
              mean_and_deviation(grains, "uniaxial_compression", "smooth_tension_share_at_peak", 1e-2, 1) + " %");
  for (const auto& test : grains["tests"])
    EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 5e-5) << test["name"];
}

TEST(ContactModels, ClumpsLowerTheRatioAndSteepenTheEnvelope)
{
  // As published: below the parallel bond's 0.25 to 0.33, and not below 0.07.
  const auto clumps = study("clumped");
  EXPECT_GT(ratio_of_strengths(clumps), 0.07);
  EXPECT_LT(ratio_of_strengths(clumps), 0.25);
  // Of clumps, and not of their bonds, which are others than those of the parallel-bonded specimens.
  const json without = study("clumped-without-clumps");
  EXPECT_GT(slope(clumps), 2.0 * slope(without));
  EXPECT_GT(hoek_brown(without)["r_squared"].get<double>(), without["fits"]["mohr_coulomb"]["r_squared"].get<double>());
  expect_said(fmt::format(
    "a slope of {:.1f} (R² {:.4f}, and {:.4f} of the curve), with {:.1f}, {:.1f}, {:.1f} and {:.1f} MPa",
    slope(without), without["fits"]["mohr_coulomb"]["r_squared"].get<double>(),
    hoek_brown(without)["r_squared"].get<double>(), mean_of(without, "uniaxial_compression") / 1e6,
    mean_of(without, "triaxial_compression_5_MPa") / 1e6, mean_of(without, "triaxial_compression_20_MPa") / 1e6,
    mean_of(without, "triaxial_compression_60_MPa") / 1e6));
  for (const auto& test : clumps["tests"])
    {
      EXPECT_GT(test["n_clumps"].get<int>(), 0) << test["name"];
      // At 60 MPa the highest stress lies where the tests end.
      if (test["group"] == "triaxial_compression_60_MPa" && !test["strain_at_peak"].is_null())
        {
          EXPECT_GT(test["strain_at_peak"].get<double>(), 0.0195) << test["name"];
        }
    }
  EXPECT_EQ(clumps["ensemble"]["triaxial_compression_60_MPa"]["peak_stress_Pa"]["n"], 4);
}

TEST(ContactModels, TheRatioFallsAsClumpsGrow)
{
  const auto sizes = study("clump-size");
  double before = 1.0;
  for (const auto& [variant, diameter] : {std::pair(1, "none"), {2, "4 mm"}, {3, "8 mm"}})
    {
      const std::string pulled = group_of(sizes, "direct_tension", variant);
      const std::string pressed = group_of(sizes, "uniaxial_compression", variant);
      const double ratio = mean_of(sizes, pulled) / mean_of(sizes, pressed);
      expect_shown(fmt::format("| {} | {} | {} | {:.3f} |", diameter,
                               mean_and_deviation(sizes, pulled, "peak_stress_Pa", 1e6, 2),
                               mean_and_deviation(sizes, pressed, "peak_stress_Pa", 1e6, 1), ratio));
      EXPECT_LT(ratio, 0.7 * before) << diameter;
      before = ratio;
    }
  // Its middle size is the model of the table.
  const auto clumps = study("clumped");
  EXPECT_EQ(mean_of(sizes, group_of(sizes, "direct_tension", 2)), mean_of(clumps, "direct_tension"));
  EXPECT_EQ(mean_of(sizes, group_of(sizes, "uniaxial_compression", 2)), mean_of(clumps, "uniaxial_compression"));
}

TEST(ContactModels, TheFlatJointIsThatOfTheEnsemble)
{
  const auto five = study("flat-joint");
  const auto ten = results_of("beishan-granite", "ensemble-by-motion");
  for (const auto& test : five["tests"])
    {
      const double expected = test_of(ten, test["name"])["peak_stress_Pa"].get<double>();
      EXPECT_NEAR(test["peak_stress_Pa"].get<double>(), expected, 1e-6 * expected) << test["name"];
    }
}
} // namespace
} // namespace feldspar::tests
