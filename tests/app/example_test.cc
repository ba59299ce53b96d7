// The figures in the READMEs of the examples are those of the committed results.

#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace feldspar::tests
{
namespace
{
const std::string example = std::string(FELDSPAR_SOURCE_DIR) + "/examples/beishan-granite/";
const std::string of_rves = std::string(FELDSPAR_SOURCE_DIR) + "/examples/rve-beishan/";

std::string content(const std::string& file)
{
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

nlohmann::json results(const std::string& study)
{
  return nlohmann::json::parse(content(example + "results/" + study + ".json"));
}

std::string number(const nlohmann::json& value, const double scale, const int decimals)
{
  return fmt::format("{:.{}f}", value.get<double>() / scale, decimals);
}

std::string mean_and_deviation(const nlohmann::json& study, const std::string& group, const std::string& key,
                               const double scale, const int decimals)
{
  const auto& figure = study["ensemble"][group][key];
  return number(figure["mean"], scale, decimals) + " ± " + number(figure["standard_deviation"], scale, decimals);
}

const nlohmann::json& test_of(const nlohmann::json& study, const std::string& name)
{
  for (const auto& test : study["tests"])
    if (test["name"] == name)
      return test;
  throw std::runtime_error("no test " + name);
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

const std::vector<Row> rows{
  {"tensile strength [MPa]", "direct_tension", "peak_stress_Pa", 1e6, 2},
  {"strain at the tensile peak [1e-4]", "direct_tension", "strain_at_peak", 1e-4, 2},
  {"uniaxial compressive strength [MPa]", "uniaxial_compression", "peak_stress_Pa", 1e6, 1},
  {"Young's modulus, tangent at half of the peak [GPa]", "uniaxial_compression", "youngs_modulus_tangent_Pa", 1e9, 1},
  {"Young's modulus, initial [GPa]", "uniaxial_compression", "youngs_modulus_initial_Pa", 1e9, 1},
  {"Poisson's ratio, secant at half of the peak", "uniaxial_compression", "poissons_ratio_secant", 1.0, 3},
  {"Poisson's ratio, initial", "uniaxial_compression", "poissons_ratio_initial", 1.0, 3}};

TEST(Example, TheReadmeShowsTheCommittedResults)
{
  const std::string readme = content(example + "README.md");
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  const auto one = results("beishan");
  const auto ten = results("ensemble");
  const auto fine = results("radius-as-diameter");
  for (const auto& [name, kind, key, scale, decimals] : rows)
    {
      const std::string over_seeds = mean_and_deviation(ten, kind, key, scale, decimals);
      shown(fmt::format("| {} | {} | {} | {} |", name, number(test_of(one, kind + "_seed_1")[key], scale, decimals),
                        over_seeds, number(ten["ensemble"][kind][key]["standard_error"], scale, decimals)));
      shown(fmt::format("| {} | {} | {} |", name, over_seeds, mean_and_deviation(fine, kind, key, scale, decimals)));
    }
  for (const int pressure : {5, 10, 20, 30, 40, 50, 60})
    {
      const std::string group = fmt::format("triaxial_compression_{}_MPa", pressure);
      shown(fmt::format("| {} | {} | {} |", pressure, number(test_of(one, group + "_seed_1")["peak_stress_Pa"], 1e6, 1),
                        mean_and_deviation(ten, group, "peak_stress_Pa", 1e6, 1)));
    }
  const std::string front_page = content(std::string(FELDSPAR_SOURCE_DIR) + "/README.md");
  for (const char* test : {"direct_tension_seed_1", "uniaxial_compression_seed_1"})
    EXPECT_NE(front_page.find(" " + number(test_of(one, test)["peak_stress_Pa"], 1e6, test[0] == 'd' ? 2 : 1) + " "),
              std::string::npos)
      << test;
  const auto rate = results("rate-study");
  for (const auto& [variant, strain_rate] : {std::pair(1, "1"), {2, "0.5"}, {3, "0.25"}})
    shown(fmt::format(
      "| {} | {} |", strain_rate,
      mean_and_deviation(rate, fmt::format("uniaxial_compression_variant_{}", variant), "peak_stress_Pa", 1e6, 1)));
}

TEST(Example, TheEnsembleIsTheRock)
{
  // Bounds: what the flat-joint law gives in an independent program over as many seeds, and its triaxial means ± 8 %.
  const auto ensemble = results("ensemble")["ensemble"];
  const auto mean = [&](const std::string& group, const char* key) {
    return ensemble[group][key]["mean"].get<double>();
  };
  const double compressive = mean("uniaxial_compression", "peak_stress_Pa");
  const double tensile = mean("direct_tension", "peak_stress_Pa");
  EXPECT_GT(compressive, 138e6);
  EXPECT_LT(compressive, 178e6);
  EXPECT_GT(tensile, 8.6e6);
  EXPECT_LT(tensile, 10.9e6);
  EXPECT_GT(tensile / compressive, 0.048);
  EXPECT_LT(tensile / compressive, 0.076);
  EXPECT_GT(mean("uniaxial_compression", "youngs_modulus_tangent_Pa"), 57e9);
  EXPECT_LT(mean("uniaxial_compression", "youngs_modulus_tangent_Pa"), 66e9);
  for (const auto& [pressure, expected] :
       {std::pair(5, 255e6), {10, 313e6}, {20, 384e6}, {30, 435e6}, {40, 463e6}, {50, 493e6}, {60, 523e6}})
    EXPECT_NEAR(mean(fmt::format("triaxial_compression_{}_MPa", pressure), "peak_stress_Pa"), expected, 0.08 * expected)
      << pressure << " MPa";
  EXPECT_GT(mean("triaxial_compression_60_MPa", "shear_share_at_peak"),
            3.0 * mean("triaxial_compression_5_MPa", "shear_share_at_peak"));
  EXPECT_LT(mean("uniaxial_compression", "residual_deviator_ratio"), 0.5);
  EXPECT_GT(mean("triaxial_compression_60_MPa", "residual_deviator_ratio"), 0.65);
  EXPECT_EQ(ensemble["uniaxial_compression"]["peak_stress_Pa"]["n"], 10);
  for (const int pressure : {5, 10, 20, 30, 40, 50, 60})
    EXPECT_LT(mean(fmt::format("triaxial_compression_{}_MPa", pressure), "servo_error"), 0.01) << pressure << " MPa";
  const auto tests = results("ensemble")["tests"];
  EXPECT_EQ(tests.size(), 90u);
  for (const auto& test : tests)
    EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 0.01) << test["name"];
}

TEST(Example, TheFirstTestAgainGivesTheCommittedResult)
{
  // The reduced piece of the study that every check runs: tension on the first specimen. Up to its brittle peak the
  // test is no matter of chance, so another processor's library functions move it by far less than this.
  const TemporaryFolder folder;
  std::string input = content(example + "ensemble.prm");
  input.replace(input.find("direct_tension, uniaxial_compression, triaxial_compression"), 58, "direct_tension");
  input.replace(input.find("1..10"), 5, "1");
  input.erase(input.find("subsection Report"));
  folder.write("piece.prm", input);
  ASSERT_EQ(run_feldspar(folder.path(), "lab piece.prm --output out --quiet").exit_code, 0);
  const auto again = nlohmann::json::parse(content((folder.path() / "out/summary.json").string()));
  const double committed = test_of(results("ensemble"), "direct_tension_seed_1")["peak_stress_Pa"].get<double>();
  EXPECT_NEAR(again["tests"][0]["peak_stress_Pa"].get<double>(), committed, 0.01 * committed);
}

TEST(Documentation, ParametersAreThoseOfTheCommand)
{
  const TemporaryFolder folder;
  EXPECT_EQ(content(std::string(FELDSPAR_SOURCE_DIR) + "/docs/parameters.md"),
            run_feldspar(folder.path(), "parameters --markdown").output)
    << "write it anew: feldspar parameters --markdown > docs/parameters.md";
}

TEST(Example, TheCalibrationsReadmeShowsTheCommittedAnswer)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/calibrate-beishan/";
  const std::string readme = content(folder + "README.md");
  const auto answer = nlohmann::json::parse(content(folder + "results/calibration.json"));
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  struct Figure
  {
    const char* name;
    const char* key;
    double scale;
    int decimals;
  };
  for (const auto& [name, key, scale, decimals] :
       {Figure{"tensile strength [MPa]", "tensile_strength", 1e6, 2},
        {"Young's modulus, tangent 40-60 % of peak [GPa]", "youngs_modulus", 1e9, 1},
        {"Poisson's ratio, initial", "poissons_ratio", 1.0, 3},
        {"uniaxial compressive strength [MPa]", "uniaxial_compressive_strength", 1e6, 1}})
    {
      const auto& target = answer["targets"][key];
      shown(fmt::format("| {} | {} | {} ± {} | {:+.1f} % |", name, number(target["target"], scale, decimals),
                        number(target["reached"], scale, decimals), number(target["standard_error"], scale, decimals),
                        100.0 * target["deviation"].get<double>()));
    }
  for (const auto& [name, key, scale, decimals] :
       {Figure{"modulus [GPa]", "modulus", 1e9, 1},
        {"bond tensile strength [MPa]", "bond_tensile_strength", 1e6, 1},
        {"bond cohesion [MPa]", "bond_cohesion", 1e6, 0},
        {"stiffness ratio", "stiffness_ratio", 1.0, 2},
        {"bond friction angle [deg]", "bond_friction_angle", M_PI / 180.0, 1},
        {"friction", "friction", 1.0, 2}})
    {
      const auto& parameter = answer["parameters"][key];
      shown(fmt::format("| {} | {} | {} to {} | {} |", name, number(parameter["best"], scale, decimals),
                        number(parameter["lower_90"], scale, decimals), number(parameter["upper_90"], scale, decimals),
                        parameter["verdict"].get<std::string>()));
    }
  // The input beside it is that answer.
  EXPECT_NE(content(folder + "best.prm")
              .find(fmt::format("set Bond tensile strength = {:.4g} MPa\n",
                                answer["parameters"]["bond_tensile_strength"]["best"].get<double>() / 1e6)),
            std::string::npos);
}

TEST(Example, TheInputsAreValid)
{
  const TemporaryFolder folder;
  std::size_t n_inputs = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(FELDSPAR_SOURCE_DIR) + "/examples"))
    if (entry.path().extension() == ".prm")
      {
        const auto outcome = run_feldspar(folder.path(), "parameters --check '" + entry.path().string() + "'");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
        ++n_inputs;
      }
  EXPECT_GT(n_inputs, 8u);
}

/// 1 805 575
std::string in_thousands(std::uint64_t n)
{
  std::string text = std::to_string(n);
  for (std::size_t at = text.size(); at > 3;)
    text.insert(at -= 3, 1, ' ');
  return text;
}

TEST(Example, ReliabilityShowsTheCommittedFigures)
{
  const std::string root = std::string(FELDSPAR_SOURCE_DIR) + "/";
  const std::string page = content(root + "docs/reliability.md");
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(page.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  const auto study = [&](const char* name) {
    return nlohmann::json::parse(content(root + "benchmarks/results/" + name + ".json"));
  };
  const auto fuzz = study("fuzz");
  std::uint64_t sum = 0;
  for (const auto& [reader, result] : fuzz["readers"].items())
    {
      const auto n = result["inputs"].get<std::uint64_t>();
      sum += n;
      shown(fmt::format("| {} | {} | {} |", reader, in_thousands(n), result["found"].get<int>()));
    }
  EXPECT_EQ(fuzz["inputs"].get<std::uint64_t>(), sum);
  shown(fmt::format("| all | {} |", in_thousands(sum)));
  const auto load = study("load");
  for (const auto& [body, result] : load.items())
    shown(fmt::format("| {} | {} | {} | {} | {} |", in_thousands(result["grains"].get<std::uint64_t>()) + " " + body,
                      result["steps"].get<int>(), number(result["seconds"], 60.0, 1),
                      number(result["processor_seconds"], 60.0, 1), number(result["peak_bytes"], 1e9, 2)));
  for (const auto& [name, label] : {std::pair("soak", "rows of 1e-4"), {"soak-dense", "rows of 1e-5"}})
    {
      const auto soak = study(name);
      shown(fmt::format("| {} | {} | {} | {} | {} to {} | {} % |", label, number(soak["seconds"], 60.0, 0),
                        in_thousands(soak["steps"].get<std::uint64_t>()), soak["rows"].get<int>(),
                        number(soak["least_bytes"], 1e6, 1), number(soak["most_bytes"], 1e6, 1),
                        number(soak["largest_deviation_from_mean"], 0.01, 1)));
    }
}

TEST(Example, TheCylindersReadmeShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/beishan-cylinder/";
  const std::string readme = content(folder + "README.md");
  const auto study = nlohmann::json::parse(content(folder + "results/beishan-cylinder.json"));
  auto shown = rows;
  shown.push_back({"strength at 10 MPa [MPa]", "triaxial_compression_10_MPa", "peak_stress_Pa", 1e6, 1});
  shown.push_back({"strength at 40 MPa [MPa]", "triaxial_compression_40_MPa", "peak_stress_Pa", 1e6, 1});
  for (const auto& [name, kind, key, scale, decimals] : shown)
    {
      const std::string row = fmt::format("| {} | {} |", name, mean_and_deviation(study, kind, key, scale, decimals));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
    }

  const auto& envelope = study["fits"]["intact"]["with_tension_point"];
  const std::string fit = fmt::format("σ_ci {} ± {} MPa,\nm {} ± {} (95 %)", number(envelope["sigma_ci_Pa"], 1e6, 1),
                                      number(envelope["sigma_ci_confidence_95_Pa"], 1e6, 1),
                                      number(envelope["m"], 1.0, 1), number(envelope["m_confidence_95"], 1.0, 1));
  EXPECT_NE(readme.find(fit), std::string::npos) << "missing: " << fit;

  // The packing at the paper's size; times are processor time.
  const auto packing = nlohmann::json::parse(content(folder + "results/full-size.json"));
  for (const auto& [name, key, scale, decimals] :
       {std::tuple("grains", "n_grains", 1.0, 0),
        {"joints", "n_joints", 1.0, 0},
        {"coordination number, more than three diameters from the walls", "coordination_number_core", 1.0, 2},
        {"porosity", "porosity", 1.0, 3},
        {"radii scaled by", "radius_multiplier", 1.0, 4},
        {"iterations", "iterations", 1.0, 0},
        {"processor time [s]", "processor_time_s", 1.0, 0},
        {"memory [MB]", "peak_memory_kB", 1000.0, 0}})
    {
      const std::string row = fmt::format("| {} | {} |", name, number(packing[key], scale, decimals));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
    }
  EXPECT_LT(packing["processor_time_s"].get<double>(), 2 * 300.0); // the aim: five minutes of two cores
  EXPECT_NEAR(packing["radius_multiplier"].get<double>(), 1.0, 0.01);

  // The tests of that packing that have come to their end, beside those of the smaller cylinder.
  const auto full = nlohmann::json::parse(content(folder + "results/full-size-tension.json"));
  EXPECT_EQ(full["tests"][0]["n_grains"], packing["n_grains"]);
  EXPECT_EQ(full["tests"][0]["n_joints"], packing["n_joints"]);
  for (const auto& [name, kind, key, scale, decimals] : rows)
    if (kind == std::string("direct_tension"))
      {
        const std::string row = fmt::format("| {} | {} | {} |", name,
                                            number(test_of(full, kind + std::string("_seed_1"))[key], scale, decimals),
                                            mean_and_deviation(study, kind, key, scale, decimals));
        EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
      }
}

TEST(Example, StaticPackingsAreTheRockOfDynamics)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string readme = content(folder + "README.md");
  const auto by_descent = nlohmann::json::parse(content(folder + "results/static-packings.json"))["specimens"];
  const auto by_dynamics = results("ensemble")["tests"];
  struct Mean
  {
    double value = 0.0;
    double deviation = 0.0;
  };
  const auto mean = [](const std::vector<double>& values) {
    const double n = double(values.size());
    Mean of_values;
    for (const double value : values)
      of_values.value += value / n;
    for (const double value : values)
      of_values.deviation += (value - of_values.value) * (value - of_values.value) / (n - 1.0);
    of_values.deviation = std::sqrt(of_values.deviation);
    return of_values;
  };
  for (const auto& [name, key, kind, key_of_test, scale, decimals] :
       {std::tuple("porosity", "porosity", "direct_tension", "porosity", 1.0, 4),
        {"coordination number in the core", "coordination_number_core", "direct_tension", "coordination_number_core",
         1.0, 3},
        {"installation gap over mean radius", "installation_gap_ratio", "direct_tension", "installation_gap_ratio", 1.0,
         4},
        {"tensile strength [MPa]", "tensile_strength_Pa", "direct_tension", "peak_stress_Pa", 1e6, 2},
        {"uniaxial compressive strength [MPa]", "uniaxial_compressive_strength_Pa", "uniaxial_compression",
         "peak_stress_Pa", 1e6, 1},
        {"Young's modulus, tangent [GPa]", "youngs_modulus_tangent_Pa", "uniaxial_compression",
         "youngs_modulus_tangent_Pa", 1e9, 1},
        {"Young's modulus, initial [GPa]", "youngs_modulus_initial_Pa", "uniaxial_compression",
         "youngs_modulus_initial_Pa", 1e9, 1}})
    {
      std::vector<double> one;
      std::vector<double> other;
      for (const auto& test : by_dynamics)
        if (test["kind"] == kind)
          one.push_back(test[key_of_test].get<double>());
      for (const auto& specimen : by_descent)
        other.push_back(specimen[key].get<double>());
      ASSERT_EQ(one.size(), 10u);
      ASSERT_EQ(other.size(), 10u);
      const Mean before = mean(one);
      const Mean now = mean(other);
      const double error = std::hypot(before.deviation, now.deviation) / std::sqrt(10.0);
      const double difference = (now.value - before.value) / error;
      // Two means of ten differ by more in one of a hundred trials (Student's t, 18 degrees of freedom).
      EXPECT_LT(std::abs(difference), 2.88) << name;
      const std::string row = fmt::format("| {} | {:.{}f} ± {:.{}f} | {:.{}f} ± {:.{}f} | {:.1f} |", name,
                                          before.value / scale, decimals, before.deviation / scale, decimals,
                                          now.value / scale, decimals, now.deviation / scale, decimals, difference);
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
    }
}

TEST(Example, TheBenchmarksReadmeShowsTheStepsOfTheLargeCylinder)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string readme = content(folder + "README.md");
  const auto large = nlohmann::json::parse(content(folder + "results/large-cylinder.json"));
  const auto shown = [&](const std::string& text) {
    EXPECT_NE(readme.find(text), std::string::npos) << "missing: " << text;
  };
  shown(fmt::format("{} spheres and {} joints", number(large["n_grains"], 1.0, 0), number(large["n_joints"], 1.0, 0)));
  shown(number(large["peak_memory_kB"], 1e3, 0) + " MB,\nthat of the packing " +
        number(large["packing_peak_memory_kB"], 1e3, 0) + " MB");
  shown("\n| packing, static, the first 300 iterations | " + number(large["packing_iteration_s"], 1e-3, 0) + " |");
  const auto& tests = large["tests"];
  shown("\n| direct tension | " + number(tests[0]["step_s"], 1e-3, 0) + " |");
  shown("\n| uniaxial compression | " + number(tests[1]["step_s"], 1e-3, 0) + " |");
  shown("\n| triaxial compression, seating at 10 MPa | " + number(tests[2]["step_s"], 1e-3, 0) + " |");
}

TEST(Example, TheContactModelsReadmeShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/contact-models/";
  const std::string readme = content(folder + "README.md");
  const auto bonds = nlohmann::json::parse(content(folder + "results/parallel-bond.json"));
  const auto joints = results("ensemble");
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  for (const auto& [name, group, key, scale, decimals] :
       {Row{"tensile strength [MPa]", "direct_tension", "peak_stress_Pa", 1e6, 2},
        {"uniaxial compressive strength [MPa]", "uniaxial_compression", "peak_stress_Pa", 1e6, 1},
        {"Young's modulus, tangent at half of the peak [GPa]", "uniaxial_compression", "youngs_modulus_tangent_Pa", 1e9,
         1},
        {"strength at 5 MPa [MPa]", "triaxial_compression_5_MPa", "peak_stress_Pa", 1e6, 1},
        {"strength at 20 MPa [MPa]", "triaxial_compression_20_MPa", "peak_stress_Pa", 1e6, 1},
        {"strength at 60 MPa [MPa]", "triaxial_compression_60_MPa", "peak_stress_Pa", 1e6, 1}})
    shown(fmt::format("| {} | {} | {} |", name, mean_and_deviation(bonds, group, key, scale, decimals),
                      mean_and_deviation(joints, group, key, scale, decimals)));
  const auto r_squared = [](const nlohmann::json& fit) { return number(fit["r_squared"], 1.0, 4); };
  shown(fmt::format("| R² of the line of Mohr and Coulomb | {} | {} |", r_squared(bonds["fits"]["mohr_coulomb"]),
                    r_squared(joints["fits"]["mohr_coulomb"])));
  shown(fmt::format("| R² of Hoek and Brown's curve, s = 1 and a = 0.5 | {} | {} |",
                    r_squared(bonds["fits"]["intact"]["without_tension_point"]),
                    r_squared(joints["fits"]["intact"]["without_tension_point"])));

  // The traditional model at the stiffness and the compressive strength of the rock: the ratio of strengths that the
  // literature has for it, where the flat joint has that of the rock.
  const auto peak = [&](const char* group) { return bonds["ensemble"][group]["peak_stress_Pa"]["mean"].get<double>(); };
  EXPECT_NEAR(peak("uniaxial_compression"), 163e6, 15e6);
  EXPECT_NEAR(bonds["ensemble"]["uniaxial_compression"]["youngs_modulus_tangent_Pa"]["mean"].get<double>(), 61e9, 3e9);
  EXPECT_GT(peak("direct_tension") / peak("uniaxial_compression"), 0.30);
  EXPECT_LT(peak("direct_tension") / peak("uniaxial_compression"), 0.36);
  for (const auto& test : bonds["tests"])
    EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 0.01) << test["name"];
}

TEST(Example, TheGrainBasedModelIsAsItsReadmeSays)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/contact-models/";
  const std::string readme = content(folder + "README.md");
  const auto study = nlohmann::json::parse(content(folder + "results/grain-based.json"));
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  for (const auto& [name, group, key, scale, decimals] :
       {Row{"tensile strength [MPa]", "direct_tension", "peak_stress_Pa", 1e6, 2},
        {"uniaxial compressive strength [MPa]", "uniaxial_compression", "peak_stress_Pa", 1e6, 1},
        {"Young's modulus, tangent at half of the peak [GPa]", "uniaxial_compression", "youngs_modulus_tangent_Pa", 1e9,
         1},
        {"strength at 5 MPa [MPa]", "triaxial_compression_5_MPa", "peak_stress_Pa", 1e6, 1},
        {"strength at 20 MPa [MPa]", "triaxial_compression_20_MPa", "peak_stress_Pa", 1e6, 1},
        {"strength at 60 MPa [MPa]", "triaxial_compression_60_MPa", "peak_stress_Pa", 1e6, 1},
        {"share of cracks at the peak in tension on boundaries [%]", "uniaxial_compression",
         "smooth_tension_share_at_peak", 1e-2, 1}})
    shown(fmt::format("| {} | {} |", name, mean_and_deviation(study, group, key, scale, decimals)));
  shown(fmt::format("| R² of the line of Mohr and Coulomb | {} |",
                    number(study["fits"]["mohr_coulomb"]["r_squared"], 1.0, 4)));
  shown(fmt::format("| R² of Hoek and Brown's curve, s = 1 and a = 0.5 | {} |",
                    number(study["fits"]["intact"]["without_tension_point"]["r_squared"], 1.0, 4)));

  // The range that is asked of a grain-based model (Potyondy 2010 has 0.047), at the rock's compressive strength; most
  // cracks at the peak are boundaries that opened.
  const auto mean = [&](const char* group, const char* key) {
    return study["ensemble"][group][key]["mean"].get<double>();
  };
  const double ratio = mean("direct_tension", "peak_stress_Pa") / mean("uniaxial_compression", "peak_stress_Pa");
  EXPECT_GT(ratio, 0.035);
  EXPECT_LT(ratio, 0.06);
  EXPECT_NEAR(mean("uniaxial_compression", "peak_stress_Pa"), 161e6, 15e6);
  EXPECT_GT(mean("uniaxial_compression", "smooth_tension_share_at_peak"), 0.6);
  // All tests come to their ends, and their energies balance as the page says.
  EXPECT_EQ(study["tests"].size(), 25u);
  for (const auto& test : study["tests"])
    {
      EXPECT_FALSE(test["interrupted"].get<bool>()) << test["name"];
      EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 5e-5) << test["name"];
    }
}

TEST(Example, TheClumpedModelIsAsItsReadmeSays)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/contact-models/";
  const std::string readme = content(folder + "README.md");
  const auto study = nlohmann::json::parse(content(folder + "results/clumped-unconfined.json"));
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  for (const auto& [name, group, key, scale, decimals] :
       {Row{"tensile strength [MPa]", "direct_tension", "peak_stress_Pa", 1e6, 2},
        {"uniaxial compressive strength [MPa]", "uniaxial_compression", "peak_stress_Pa", 1e6, 1},
        {"Young's modulus, tangent at half of the peak [GPa]", "uniaxial_compression", "youngs_modulus_tangent_Pa", 1e9,
         1}})
    shown(fmt::format("| {} | {} |", name, mean_and_deviation(study, group, key, scale, decimals)));

  // As published: below the parallel bond's ratio of strengths, 0.25 to 0.33, and not below 0.07.
  const auto peak = [](const nlohmann::json& of, const std::string& group) {
    return of["ensemble"][group]["peak_stress_Pa"]["mean"].get<double>();
  };
  const double ratio = peak(study, "direct_tension") / peak(study, "uniaxial_compression");
  EXPECT_GT(ratio, 0.07);
  EXPECT_LT(ratio, 0.25);
  EXPECT_NEAR(peak(study, "uniaxial_compression"), 161e6, 15e6);
  EXPECT_NEAR(study["ensemble"]["uniaxial_compression"]["youngs_modulus_tangent_Pa"]["mean"].get<double>(), 61e9, 3e9);
  EXPECT_EQ(study["tests"].size(), 10u);
  for (const auto& test : study["tests"])
    {
      EXPECT_FALSE(test["interrupted"].get<bool>()) << test["name"];
      EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 1e-3) << test["name"];
    }
}

TEST(Example, TheToughnessReadmeShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/toughness/";
  const std::string readme = content(folder + "README.md");
  const auto study = nlohmann::json::parse(content(folder + "results/toughness.json"));
  for (const auto& [radius, variant] : {std::pair("0.62", 1), {"0.88", 2}, {"1.24", 3}})
    {
      const auto cell = [&](const char* kind, const char* key, const double scale, const int decimals) {
        return mean_and_deviation(study, fmt::format("{}_variant_{}", kind, variant), key, scale, decimals);
      };
      const std::string row = fmt::format("| {} | {} | {} | {} | {} |", radius,
                                          cell("three_point_bending", "fracture_toughness_Pa_sqrt_m", 1e6, 2),
                                          cell("semicircular_bending", "fracture_toughness_Pa_sqrt_m", 1e6, 2),
                                          cell("three_point_bending", "fracture_energy_J_per_m2", 1.0, 1),
                                          cell("semicircular_bending", "fracture_energy_J_per_m2", 1.0, 1));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
    }
}

TEST(Example, TheFlawedGraniteReadmeShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/flawed-granite/";
  const std::string readme = content(folder + "README.md");
  const auto study = nlohmann::json::parse(content(folder + "results/flaw.json"));
  const auto row = [&](const std::string& name, const int variant) {
    std::string text = fmt::format("| {} |", name);
    for (const char* const key : {"peak_stress_Pa", "crack_initiation_stress_Pa"})
      for (const int seed : {1, 2})
        text += fmt::format(
          " {} |",
          number(test_of(study, fmt::format("uniaxial_compression_variant_{}_seed_{}", variant, seed))[key], 1e6, 1));
    EXPECT_NE(readme.find("\n" + text), std::string::npos) << "missing: " << text;
  };
  row("intact", 1);
  for (int k = 0; k <= 6; ++k)
    row(fmt::format("slot, {}°", 15 * k), 2 + k);
  row("closed flaw, 45°", 9);
}

TEST(Study, NetworksInSpaceAreThoseOfIndependentPrograms)
{
  // Mean of three packings of more than 800 spheres, gap by gap; benchmarks/networks_in_space.cc.
  const auto networks =
    nlohmann::json::parse(content(std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/results/networks-in-space.json"));
  const std::string readme = content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/rve-beishan/README.md");
  struct Expected
  {
    double gap, coordination, modulus;
  };
  for (const auto& [gap, coordination, modulus] :
       {Expected{0.0, 5.9, 0.65}, {0.05, 7.15, 0.82}, {0.1, 7.75, 0.92}, {0.3, 9.4, 1.20}})
    {
      double mean_coordination = 0.0;
      double mean_modulus = 0.0;
      int n = 0;
      for (const auto& row : networks["networks"])
        if (row["installation_gap_ratio"] == gap)
          {
            EXPECT_GT(row["n_grains"], 800);
            mean_coordination += row["coordination_number"].get<double>() / 3.0;
            mean_modulus += row["youngs_modulus_over_joint_modulus"].get<double>() / 3.0;
            ++n;
          }
      EXPECT_EQ(n, 3);
      EXPECT_NEAR(mean_coordination, coordination, 0.05 * coordination);
      EXPECT_NEAR(mean_modulus, modulus, 0.05 * modulus);
      const std::string shown = fmt::format("| {} | {:.2f} | {:.3f} |", gap, mean_coordination, mean_modulus);
      EXPECT_NE(readme.find(shown), std::string::npos) << "missing: " << shown;
    }
}

/// A figure of each RVE of a study, of one variant or of all.
std::vector<double> over_rves(const nlohmann::json& study, const std::string& variant,
                              const std::function<double(const nlohmann::json&)>& figure)
{
  std::vector<double> figures;
  for (const auto& rve : study["volumes"])
    if (variant.empty() || rve["variant"] == variant)
      figures.push_back(figure(rve));
  return figures;
}

double mean(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

std::string mean_and_deviation(const std::vector<double>& values, const int decimals)
{
  double square = 0.0;
  for (const double value : values)
    square += (value - mean(values)) * (value - mean(values));
  return fmt::format("{0:.{2}f} ± {1:.{2}f}", mean(values), std::sqrt(square / double(values.size() - 1)), decimals);
}

double tensile_peak(const nlohmann::json& rve) { return rve["highest_stress"]["yy"]["stress_Pa"].get<double>() / 1e6; }

double compressive_peak(const nlohmann::json& rve)
{
  return -rve["lowest_stress"]["yy"]["stress_Pa"].get<double>() / 1e6;
}

double n_cracks(const nlohmann::json& rve)
{
  return rve["at_end"]["n_tension_cracks"].get<double>() + rve["at_end"]["n_shear_cracks"].get<double>();
}

double dissipated(const nlohmann::json& rve)
{
  const auto& end = rve["at_end"];
  return end["slip_energy_J"].get<double>() + end["released_energy_J"].get<double>() +
         end["settling_energy_J"].get<double>();
}

nlohmann::json rve_results(const std::string& study)
{
  return nlohmann::json::parse(content(of_rves + "results/" + study + ".json"));
}

/// By value: the loop that walks through them would outlive the file they are read from.
std::vector<nlohmann::json> rves_of(const std::string& study)
{
  const auto rves = rve_results(study)["volumes"];
  EXPECT_FALSE(rves.empty()) << study;
  return {rves.begin(), rves.end()};
}

TEST(Example, TheRvesReadmeShowsTheCommittedResults)
{
  const std::string readme = content(of_rves + "README.md");
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  const auto rate_row = [&](const std::string& name, const nlohmann::json& study, const std::string& variant) {
    shown(fmt::format(
      "| {} | {} | {} | {} | {:.1f} |", name, mean_and_deviation(over_rves(study, variant, tensile_peak), 2),
      mean_and_deviation(over_rves(study, variant, n_cracks), 0),
      mean_and_deviation(over_rves(study, variant, dissipated), 3),
      mean(over_rves(study, variant, [](const auto& rve) { return rve["wall_time_s"].template get<double>(); }))));
  };
  const std::string rule = "Representative volume/Break rule = ";
  rate_row("event by event", rve_results("break-rules"), rule + "near worst");
  rate_row("the same, the worst segment only", rve_results("break-rules"), rule + "only worst");
  for (const auto& [steps, name] :
       {std::pair("1000", "1 000"), {"10000", "10 000"}, {"100000", "100 000"}, {"1000000", "1 000 000"}})
    rate_row("explicit, " + std::string(name), rve_results("explicit-tension"),
             "Strain path/Steps per millistrain = " + std::string(steps));

  std::istringstream sizes(content(of_rves + "results/sizes.csv"));
  std::string line;
  std::getline(sizes, line);
  while (std::getline(sizes, line))
    {
      std::vector<double> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');)
        cells.push_back(std::stod(cell));
      shown(fmt::format("| {} | {} | {:.1f} ± {:.1f} | {:.1f} ± {:.1f} | {:.0f} ± {:.0f} | {:.1f} ± {:.1f} |", cells[0],
                        cells[1], cells[2], cells[3], cells[4], cells[5], cells[8], cells[9], cells[6], cells[7]));
    }

  const auto laboratory = results("ensemble");
  shown(fmt::format(
    "| direct tension | {} | {} | {} |", mean_and_deviation(laboratory, "direct_tension", "peak_stress_Pa", 1e6, 2),
    mean_and_deviation(over_rves(rve_results("tension"), "", tensile_peak), 2),
    mean_and_deviation(
      over_rves(rve_results("explicit-tension"), "Strain path/Steps per millistrain = 100000", tensile_peak), 2)));
  const auto compression = [&](const std::string& name, const std::string& group, const std::vector<double>& by_events,
                               const std::vector<double>& by_dynamics) {
    shown(fmt::format("| {} | {} | {} | {} |", name, mean_and_deviation(laboratory, group, "peak_stress_Pa", 1e6, 0),
                      mean_and_deviation(by_events, 0),
                      by_dynamics.empty() ? "-" : mean_and_deviation(by_dynamics, 0)));
    shown(fmt::format("| {} | {:.0f} | {} |", name, fmt::join(by_events, ", "),
                      by_dynamics.empty() ? "-" : fmt::format("{:.0f}", fmt::join(by_dynamics, ", "))));
  };
  compression("uniaxial compression", "uniaxial_compression", over_rves(rve_results("uniaxial"), "", compressive_peak),
              over_rves(rve_results("size-32.5-mm-compression"), "", compressive_peak));
  const auto confined = rve_results("triaxial-20");
  compression("triaxial compression at 20 MPa", "triaxial_compression_20_MPa",
              over_rves(confined, "Strain path/Solver = event by event", compressive_peak),
              over_rves(confined, "Strain path/Solver = explicit", compressive_peak));
  compression("triaxial compression at 60 MPa", "triaxial_compression_60_MPa",
              over_rves(rve_results("triaxial-60"), "", compressive_peak), {});
}

// Hill and Mandel within ten times the final tolerance and energy within 0.1 % along every path from break to break.
TEST(Example, PathsFromBreakToBreakBalance)
{
  for (const char* const study :
       {"tension", "uniaxial", "triaxial-20", "triaxial-60", "tension-3d", "uniaxial-3d", "triaxial-20-3d",
        "triaxial-60-3d", "size-12-mm", "size-16-mm", "size-23-mm", "size-32.5-mm", "size-46-mm"})
    for (const auto& rve : rves_of(study))
      if (rve.value("variant", "") != "Strain path/Solver = explicit")
        {
          EXPECT_LE(rve["hill_mandel_residual"].get<double>(), 1e-5) << study << " " << rve["seed"];
          EXPECT_LE(rve["energy_imbalance"].get<double>(), 1e-3) << study << " " << rve["seed"];
        }
}

TEST(Example, TheRvesReadmeShowsTheCommittedResultsInSpace)
{
  const std::string readme = content(of_rves + "README.md");
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  const auto is_explicit = [](const nlohmann::json& rve) {
    return rve.value("variant", "") == "Strain path/Solver = explicit";
  };
  const auto path_row = [&](const std::string& name, const nlohmann::json& rve, const std::string& which,
                            const double sign) {
    const auto& at_end = rve["at_end"];
    shown(fmt::format(
      "| {} | {} | {} | {} | {:.0f} | {} | {:.1e} |", name, number(rve[which]["zz"]["stress_Pa"], sign * 1e6, 1),
      number(rve[which]["zz"]["strain"], sign * 1e-3, 2), number(at_end["strain_zz"], sign * 1e-3, 2), n_cracks(rve),
      number(at_end["crack_area_share"], 1.0, 2), rve["energy_imbalance"].get<double>()));
  };
  path_row("tension", rve_results("tension-3d")["volumes"][0], "highest_stress", 1.0);
  for (const auto& [name, study] : {std::pair("uniaxial compression", "uniaxial-3d"),
                                    {"triaxial compression at 20 MPa", "triaxial-20-3d"},
                                    {"triaxial compression at 60 MPa", "triaxial-60-3d"}})
    for (const auto& rve : rves_of(study))
      path_row(std::string(name) + (is_explicit(rve) ? ", explicit" : ""), rve, "lowest_stress", -1.0);

  for (const auto& [name, study, axis] : {std::tuple("plane, 16 mm", "2d-16-mm", "yy"),
                                          {"plane, 32.5 mm", "2d-32.5-mm", "yy"},
                                          {"space, 13.3 mm", "3d-13.3-mm", "zz"},
                                          {"space, 20 mm", "3d-20-mm", "zz"}})
    {
      const auto cell = rve_results("free-sides-" + std::string(study) + "-cell");
      const auto box = rve_results("free-sides-" + std::string(study) + "-box");
      const auto peak = [axis = std::string(axis)](const nlohmann::json& rve) {
        return -rve["lowest_stress"][axis]["stress_Pa"].template get<double>() / 1e6;
      };
      const auto n_grains = [](const nlohmann::json& rve) { return rve["n_grains"].template get<double>(); };
      shown(fmt::format("| {} | {:.0f} | {} | {} |", name, mean(over_rves(cell, "", n_grains)),
                        mean_and_deviation(over_rves(cell, "", peak), 0),
                        mean_and_deviation(box, "uniaxial_compression", "peak_stress_Pa", 1e6, 0)));
    }
}

/// Iterations and cascades a step, seconds of a core in all RVEs and milliseconds for an update of one.
std::string shown_work(const nlohmann::json& test, const int n_points)
{
  const auto& work = test["solver_work"];
  const double steps = test["steps"];
  const double iterations = work["iterations"];
  const double cascades = work["cascades"];
  const double seconds = work["seconds_in_points"];
  return fmt::format("{:.1f} | {:.1f} | {:.0f} | {:.2g}", iterations / steps, cascades / steps, seconds,
                     1e3 * seconds / ((iterations + cascades) * n_points));
}

TEST(Example, TheMultiscaleReadmeShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-beishan/";
  const std::string readme = content(folder + "README.md");
  const auto samples = nlohmann::json::parse(content(folder + "results/beishan.json"));
  const auto specimens = results("ensemble");
  for (const auto& [name, group] : {std::pair("direct tension", "direct_tension"),
                                    {"uniaxial compression", "uniaxial_compression"},
                                    {"triaxial compression at 20 MPa", "triaxial_compression_20_MPa"}})
    {
      std::vector<double> peaks;
      double steps = 0.0;
      double seconds = 0.0;
      for (const auto& test : samples["tests"])
        if (test["name"].get<std::string>().starts_with(group))
          {
            peaks.push_back(test["peak_stress_Pa"].get<double>() / 1e6);
            steps += test["steps"].get<double>() / 3.0;
            seconds += test["wall_time_s"].get<double>() / 3.0;
          }
      EXPECT_EQ(peaks.size(), 3u);
      const std::string row =
        fmt::format("| {} | {:.1f} | {} | {} |", name, fmt::join(peaks, ", "), mean_and_deviation(peaks, 1),
                    mean_and_deviation(specimens, group, "peak_stress_Pa", 1e6, 1));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
      const std::string costs = fmt::format("| {} | {:.0f} | {:.2g} |", name, steps, seconds / steps);
      EXPECT_NE(readme.find("\n" + costs), std::string::npos) << "missing: " << costs;
    }

  const auto demo = nlohmann::json::parse(content(folder + "results/demo.json"));
  for (const auto& [name, test] :
       {std::pair("direct tension", demo["tests"][0]), {"uniaxial compression", demo["tests"][1]}})
    {
      const std::string costs = fmt::format("| {} | {} | {} |", name, test["steps"].get<int>(), shown_work(test, 32));
      EXPECT_NE(readme.find("\n" + costs), std::string::npos) << "missing: " << costs;
      EXPECT_NE(readme.find(fmt::format("| {} | {:.1f}, ", name, test["peak_stress_Pa"].get<double>() / 1e6)),
                std::string::npos)
        << "another peak than that of three samples";
    }
}

// Each row of the table of bodies, and each angle of a turned cell, from the results of its run.
TEST(Example, TheReadmeOfSampleAndGrainsShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/";
  const std::string readme = content(folder + "README.md");
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
  };
  const auto committed = [&](const std::string& name) {
    return nlohmann::json::parse(content(folder + "results/" + name + ".json"));
  };
  for (const auto& [label, name, variant] : {std::tuple("walled, gap 0.0237", "laboratory", "= 0.0237"),
                                             {"walled, gap 0.0457", "laboratory", "= 0.0457"},
                                             {"cored, gap 0.0457", "cored", "= free sides"},
                                             {"cored at the sides only, gap 0.0457", "cored", "= sides only"},
                                             {"sample, gap 0.0457", "sample", ""}})
    {
      std::map<std::string, std::vector<double>> figures;
      std::vector<double> pulled;
      const auto summary = committed(name);
      for (const auto& test : summary["tests"])
        {
          if (!test.value("variant", std::string()).ends_with(variant) || test["peak_stress_Pa"].is_null())
            continue;
          if (test["kind"] == "direct_tension")
            pulled.push_back(test["peak_stress_Pa"].get<double>() / 1e6);
          else
            for (const char* const key : {"installation_gap_ratio", "coordination_number_core", "porosity",
                                          "peak_stress_Pa", "youngs_modulus_initial_Pa", "crack_initiation_stress_Pa"})
              figures[key].push_back(test[key].get<double>());
        }
      const auto mean = [&](const char* const key) {
        return std::accumulate(figures[key].begin(), figures[key].end(), 0.0) / double(figures[key].size());
      };
      const auto scaled = [&](const char* const key, const double scale) {
        std::vector<double> values = figures[key];
        for (double& value : values)
          value /= scale;
        return mean_and_deviation(values, 1);
      };
      ASSERT_GT(pulled.size(), 1u) << label;
      shown(fmt::format("| {} | {} | {:.4f} | {:.2f} | {:.3f} | {} | {} | {} | {} |", label, figures["porosity"].size(),
                        mean("installation_gap_ratio"), mean("coordination_number_core"), mean("porosity"),
                        mean_and_deviation(pulled, 2), scaled("peak_stress_Pa", 1e6),
                        scaled("youngs_modulus_initial_Pa", 1e9), scaled("crack_initiation_stress_Pa", 1e6)));
    }

  const auto tension = committed("angles-tension");
  for (const int angle : {0, 15, 30, 45, 60, 75, 90})
    {
      std::vector<double> strengths, works, left;
      for (const auto& path : tension["after_peak"])
        if (path["variant"] == fmt::format("Strain path/Cell angle = {} deg", angle))
          {
            strengths.push_back(path["peak_stress_Pa"].get<double>() / 1e6);
            works.push_back(path["work_after_peak_J_per_m2"].get<double>());
            left.push_back(path["stress_at_end_over_peak"].get<double>());
          }
      ASSERT_EQ(strengths.size(), 5u);
      shown(fmt::format("| {} | {} | {} | {} |", angle, mean_and_deviation(strengths, 2), mean_and_deviation(works, 2),
                        mean_and_deviation(left, 2)));
    }
}

TEST(Example, TheMultiscaleCylinderReadmeShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-beishan-cylinder/";
  const std::string readme = content(folder + "README.md");
  const auto piece = nlohmann::json::parse(content(folder + "results/published-size.json"))["tests"][0];
  const std::string costs_of_piece = fmt::format("| first steps of `published-size.prm` | 8192 | {} | {} |",
                                                 piece["steps"].get<int>(), shown_work(piece, 8192));
  EXPECT_NE(readme.find("\n" + costs_of_piece), std::string::npos) << "missing: " << costs_of_piece;
  EXPECT_NE(readme.find(fmt::format("{} broken segments", piece["n_tension_cracks"].get<int>())), std::string::npos);
  double moduli[2];
  for (int k = 0; k < 2; ++k)
    {
      const char* const study = k == 0 ? "tension" : "cylinder";
      const auto test = nlohmann::json::parse(content(folder + "results/" + study + ".json"))["tests"][0];
      moduli[k] = test["youngs_modulus_initial_Pa"];
      const char* const name = k == 0 ? "section, `tension.prm`" : "whole, `cylinder.prm`";
      const std::string row =
        fmt::format("| {} | {:.1f} | {:.2f} | {:.1f} |", name, test["peak_stress_Pa"].get<double>() / 1e6,
                    test["strain_at_peak"].get<double>() * 1e4, moduli[k] / 1e9);
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
      const int n_points = k == 0 ? 64 : 200;
      const std::string costs =
        fmt::format("| {} | {} | {} | {} |", name, n_points, test["steps"].get<int>(), shown_work(test, n_points));
      EXPECT_NE(readme.find("\n" + costs), std::string::npos) << "missing: " << costs;
    }
  EXPECT_NEAR(moduli[1], moduli[0], 0.02 * moduli[0]); // before anything breaks, of different packings

  const auto pressed = nlohmann::json::parse(content(folder + "results/compression.json"));
  const auto specimens = nlohmann::json::parse(
    content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/beishan-cylinder/results/beishan-cylinder.json"));
  for (const auto& [name, kind] : {std::pair("uniaxial", "uniaxial_compression"),
                                   {"at 10 MPa", "triaxial_compression_10_MPa"},
                                   {"at 40 MPa", "triaxial_compression_40_MPa"}})
    {
      const auto& test = test_of(pressed, std::string(kind) + "_seed_1");
      const std::string row = fmt::format("| {} | {} | {} | {} | {} |", name, number(test["peak_stress_Pa"], 1e6, 0),
                                          number(test["strain_at_peak"], 1e-3, 1),
                                          mean_and_deviation(specimens, kind, "peak_stress_Pa", 1e6, 0),
                                          mean_and_deviation(specimens, kind, "strain_at_peak", 1e-3, 1));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
      const std::string costs = fmt::format("| section, `compression.prm`, {} | 16 | {} | {} |", name,
                                            test["steps"].get<int>(), shown_work(test, 16));
      EXPECT_NE(readme.find("\n" + costs), std::string::npos) << "missing: " << costs;
    }
}

struct MeshFigure
{
  const char* key;
  double scale;
  int decimals;
};
constexpr MeshFigure peak_on_mesh{"peak_stress_Pa", 1e6, 2};
constexpr MeshFigure work_on_mesh{"work_after_peak_J_per_m2", 1.0, 1};
constexpr MeshFigure loss_on_mesh{"loss_after_peak_J_per_m2", 1.0, 1};

/// The runs of mesh-study.py with one geometry, the coarsest mesh first.
std::vector<nlohmann::json> runs_on_meshes(const nlohmann::json& study, const std::string& geometry)
{
  std::vector<nlohmann::json> runs;
  for (const auto& run : study["runs"])
    if (run["geometry"] == geometry)
      runs.push_back(run);
  return runs;
}

/// Seed by seed, how far the finer meshes are at most from the coarsest, which both ways of softening share.
std::vector<double> largest_differences(const std::vector<nlohmann::json>& runs, const std::string& softening,
                                        const MeshFigure& figure)
{
  std::vector<double> of_seeds;
  for (std::size_t k = 0; k < runs.front()["tests"].size(); ++k)
    {
      const auto of = [&](const nlohmann::json& run) { return run["tests"][k][figure.key].get<double>(); };
      double largest = 0.0;
      for (std::size_t r = 1; r < runs.size(); ++r)
        if (runs[r]["softening"] == softening)
          largest = std::max(largest, std::abs(of(runs[r]) / of(runs.front()) - 1.0));
      of_seeds.push_back(largest);
    }
  return of_seeds;
}

TEST(Study, TheReadmesShowTheMeshes)
{
  const std::string examples = std::string(FELDSPAR_SOURCE_DIR) + "/examples/";
  const auto study = nlohmann::json::parse(content(examples + "multiscale-beishan/results/mesh-study.json"));
  for (const auto& [geometry, folder] :
       {std::pair("plane", "multiscale-beishan"), {"axisymmetric", "multiscale-beishan-cylinder"}})
    {
      const std::string readme = content(examples + folder + "/README.md");
      const auto shown = [&](const std::string& row) {
        EXPECT_NE(readme.find("\n" + row + "\n"), std::string::npos) << "missing: " << row;
      };
      const auto runs = runs_on_meshes(study, geometry);
      ASSERT_EQ(runs.size(), 5u);
      for (const auto& run : runs)
        {
          std::string row = fmt::format("| {} x {} | {} |", run["elements"][0].get<int>(),
                                        run["elements"][1].get<int>(), run["softening"].get<std::string>());
          for (const MeshFigure& figure : {peak_on_mesh, work_on_mesh, loss_on_mesh})
            {
              std::vector<std::string> of_seeds;
              for (const auto& test : run["tests"])
                of_seeds.push_back(number(test[figure.key], figure.scale, figure.decimals));
              row += fmt::format(" {} |", fmt::join(of_seeds, ", "));
            }
          shown(row);
        }
      for (const std::string softening : {"scaled", "as it is"})
        {
          std::string row = fmt::format("| from the coarsest, at most | {} |", softening);
          for (const MeshFigure& figure : {peak_on_mesh, work_on_mesh, loss_on_mesh})
            {
              std::vector<std::string> of_seeds;
              for (const double difference : largest_differences(runs, softening, figure))
                of_seeds.push_back(fmt::format("{:.{}f}", 100.0 * difference, figure.decimals - 1));
              row += fmt::format(" {} % |", fmt::join(of_seeds, ", "));
            }
          shown(row);
        }
    }
}

// The platens' work is what the RVEs store and lose and what the elements set free between cascades. The README says
// 0.02 %; where the elastic unloading of a scaled RVE was taken for work of its element, it was 1 to 2 %.
TEST(Study, EnergiesBalanceOnEveryMesh)
{
  const auto study = nlohmann::json::parse(
    content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-beishan/results/mesh-study.json"));
  for (const auto& run : study["runs"])
    for (const auto& test : run["tests"])
      EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 2.5e-4) << run["geometry"] << run["elements"];
}

// Three meshes: the peak within 3 %, what follows it within 10 % where softening is scaled, and not where it is not. The
// work of the cylinder is left out: it falls in one avalanche, and one row of the curve before that is half of its work.
TEST(Study, WhatFollowsThePeakDoesNotDependOnTheMesh)
{
  const auto study = nlohmann::json::parse(
    content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-beishan/results/mesh-study.json"));
  for (const std::string geometry : {"plane", "axisymmetric"})
    {
      const auto runs = runs_on_meshes(study, geometry);
      for (const char* const softening : {"scaled", "as it is"})
        for (const double difference : largest_differences(runs, softening, peak_on_mesh))
          EXPECT_LT(difference, 0.03) << geometry << ", " << softening;
      for (const MeshFigure& figure : {work_on_mesh, loss_on_mesh})
        {
          if (geometry == "axisymmetric" && figure.key == work_on_mesh.key)
            continue;
          for (const double difference : largest_differences(runs, "scaled", figure))
            EXPECT_LT(difference, 0.1) << geometry << ", " << figure.key;
          for (const double difference : largest_differences(runs, "as it is", figure))
            EXPECT_GT(difference, 0.1) << geometry << ", " << figure.key;
        }
    }
}

TEST(Benchmark, TheReadmeShowsTheCommittedResults)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string readme = content(folder + "README.md");
  const auto shown = [&](const std::string& row) {
    EXPECT_NE(readme.find("\n" + row + "\n"), std::string::npos) << "missing: " << row;
  };
  const auto queue = nlohmann::json::parse(content(folder + "results/rank-queue.json"));
  for (const auto& [name, quantiles] : queue["costs_s"].items())
    {
      std::string row = "| " + name + " |";
      for (const char* quantile : {"10 %", "50 %", "90 %", "99 %"})
        row += fmt::format(" {:.3g} |", quantiles[quantile].get<double>() * 1e3);
      shown(row);
    }
  for (const auto& run : queue["runs"])
    if (const int cores = run["cores"]; cores == 4 || cores == 16 || cores == 64 || cores == 256 || cores >= 10000)
      {
        std::string row = fmt::format("| {} | {} |", run["volumes"].get<int>(), cores);
        for (const char* policy : {"equal", "measured", "equal, 16 cores", "measured, 16 cores",
                                   "measured, 16 cores, longest first", "queue", "bound"})
          row +=
            run["speed_up"].contains(policy) ? fmt::format(" {:.1f} |", run["speed_up"][policy].get<double>()) : " – |";
        shown(row);
      }
  const auto on_ranks = nlohmann::json::parse(content(folder + "results/many-ranks.json"))["runs"];
  EXPECT_EQ(on_ranks.size(), 7u);
  for (const auto& run : on_ranks)
    {
      const auto& of_ranks = run["in_volumes"];
      const double mean = of_ranks["mean_s"];
      shown(fmt::format(
        "| {} | {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {} | {} |",
        run["test"] == "direct_tension" ? "pulled" : "pressed", run["ranks"].get<int>(), run["threads"].get<int>(),
        run["clock_s"].get<double>(), run["processor_s"].get<double>(),
        of_ranks["longest_unmoved_s"].get<double>() / mean, of_ranks["longest_s"].get<double>() / mean,
        of_ranks["moves"].get<int>(),
        run.contains("speed_up_by_clock") ? fmt::format("{:.2f}", run["speed_up_by_clock"].get<double>()) : "–"));
      EXPECT_TRUE(run["same_events"]);
    }
  const auto kills = nlohmann::json::parse(content(folder + "results/kill-study.json"))["kills"];
  EXPECT_EQ(kills.size(), 10u);
  for (const auto& kill : kills)
    for (const auto& resumed : kill["resumed"])
      {
        EXPECT_TRUE(resumed["same_events"]);
        EXPECT_LE(resumed["curve_difference"], 1e-8);
        EXPECT_LE(resumed["field_difference"], 1e-8);
      }
}

TEST(Example, TheExplicitRveApproachesTheRateFreeOneAndBreakRulesAgree)
{
  const auto rules = rve_results("break-rules");
  const auto rates = rve_results("explicit-tension");
  const std::string rule = "Representative volume/Break rule = ";
  const double peak = mean(over_rves(rules, rule + "only worst", tensile_peak));
  const double energy = mean(over_rves(rules, rule + "only worst", dissipated));
  EXPECT_NEAR(mean(over_rves(rules, rule + "near worst", tensile_peak)), peak, 0.02 * peak);
  EXPECT_NEAR(mean(over_rves(rules, rule + "near worst", dissipated)), energy, 0.05 * energy);
  const double rate_free = mean(over_rves(rules, rule + "near worst", dissipated));
  double error = std::numeric_limits<double>::infinity();
  for (const char* steps : {"1000", "10000", "100000", "1000000"})
    {
      const std::string variant = std::string("Strain path/Steps per millistrain = ") + steps;
      if (std::string(steps) != "1000")
        {
          EXPECT_NEAR(mean(over_rves(rates, variant, tensile_peak)), peak, 0.01 * peak) << steps;
        }
      const double smaller = std::abs(mean(over_rves(rates, variant, dissipated)) - rate_free);
      EXPECT_LT(smaller, 0.5 * error) << steps;
      error = smaller;
    }
  // The slowest has as much as the rate-free one for all that five realisations can tell, each of which breaks in an order
  // of its own: the mean of the differences lies within its 95 % confidence interval about zero.
  constexpr double t_of_five = 2.776;
  std::vector<double> differences = over_rves(rates, "Strain path/Steps per millistrain = 1000000", dissipated);
  const std::vector<double> by_events = over_rves(rules, rule + "near worst", dissipated);
  ASSERT_EQ(differences.size(), 5u);
  ASSERT_EQ(by_events.size(), 5u);
  for (std::size_t k = 0; k < differences.size(); ++k)
    differences[k] -= by_events[k];
  double squares = 0.0;
  for (const double difference : differences)
    squares += std::pow(difference - mean(differences), 2);
  EXPECT_LT(std::abs(mean(differences)), t_of_five * std::sqrt(squares / 4.0 / 5.0));
  for (const char* study : {"tension", "break-rules", "uniaxial", "triaxial-20", "triaxial-60"})
    for (const auto& rve : rves_of(study))
      if (!rve.contains("variant") || rve["variant"] != "Strain path/Solver = explicit")
        {
          EXPECT_LE(rve["energy_imbalance"].get<double>(), 1e-3) << study << rve["name"];
        }
}

} // namespace
} // namespace feldspar::tests
