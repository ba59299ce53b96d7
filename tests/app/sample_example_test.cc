// The figures in the READMEs on samples of finite elements are those of the committed results.

#include "tests/app/committed_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace feldspar::tests
{
namespace
{
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
  const auto specimens = results_of("beishan-granite", "ensemble");
  for (const auto& [name, group] : {std::pair("direct tension", "direct_tension"),
                                    {"uniaxial compression", "uniaxial_compression"},
                                    {"triaxial compression at 20 MPa", "triaxial_compression_20_MPa"}})
    {
      std::vector<double> peaks;
      for (const auto& test : samples["tests"])
        if (test["name"].get<std::string>().starts_with(group))
          peaks.push_back(test["peak_stress_Pa"].get<double>() / 1e6);
      EXPECT_EQ(peaks.size(), 3u);
      const std::string row =
        fmt::format("| {} | {:.1f} | {} | {} |", name, fmt::join(peaks, ", "), mean_and_deviation(peaks, 1),
                    mean_and_deviation(specimens, group, "peak_stress_Pa", 1e6, 1));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
    }

  const auto peaks_of = [&](const char* const results, const std::string& group) {
    std::vector<std::string> peaks;
    const auto summary = nlohmann::json::parse(content(folder + "results/" + results + ".json"));
    for (const auto& test : summary["tests"])
      if (test["name"].get<std::string>().starts_with(group))
        peaks.push_back(test["peak_stress_Pa"].is_null() ? "no peak" : number(test["peak_stress_Pa"], 1e6, 1));
    return fmt::format("{}", fmt::join(peaks, ", "));
  };
  for (const auto& [name, group] : {std::pair("direct tension", "direct_tension"),
                                    {"uniaxial compression", "uniaxial_compression"},
                                    {"triaxial compression at 20 MPa", "triaxial_compression_20_MPa"}})
    {
      const std::string row = fmt::format("\n| {} | {} | {} |\n", name, peaks_of("beishan-by-coordination", group),
                                          peaks_of("beishan-finite", group));
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
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

  // The rates, seed by seed; the highest is that of the bodies above, on the same specimens.
  const auto by_rate = committed("rate");
  const auto crushed_at = [&](const std::string& rate) {
    std::map<unsigned, double> strengths;
    for (const auto& test : by_rate["tests"])
      if (test["variant"].get<std::string>().ends_with("= " + rate + " 1/s"))
        strengths[test["seed"]] = test["peak_stress_Pa"].get<double>() / 1e6;
    return strengths;
  };
  const auto fast = crushed_at("1");
  EXPECT_EQ(fast.size(), 10u);
  const auto cored = committed("cored");
  for (const auto& test : cored["tests"])
    if (test["kind"] == "uniaxial_compression" && test["variant"] == "Specimen/Coring = sides only")
      {
        EXPECT_EQ(fast.at(test["seed"]), test["peak_stress_Pa"].get<double>() / 1e6) << test["seed"];
      }
  for (const char* const rate : {"1", "0.5", "0.25"})
    {
      std::vector<double> strengths, shares;
      for (const auto& [seed, strength] : crushed_at(rate))
        {
          strengths.push_back(strength);
          shares.push_back(strength / fast.at(seed));
        }
      shown(fmt::format("| {} | {} | {} |", rate, mean_and_deviation(strengths, 1), mean_and_deviation(shares, 3)));
    }

  // Under pressure: means of the strengths, and of the stress at the end where a sample has no peak.
  const auto grains_under_pressure = committed("confined");
  const auto slow_grains_under_pressure = committed("confined-slow");
  auto sample_under_pressure = committed("sample-confined");
  const auto more_samples = committed("sample-5-mpa");
  for (const auto& test : more_samples["tests"])
    sample_under_pressure["tests"].push_back(test);
  for (const int pressure : {5, 20, 60})
    {
      std::size_t n_samples = 0, n_without_peak = 0;
      const auto highest = [&](const nlohmann::json& study) {
        std::vector<double> values;
        n_samples = n_without_peak = 0;
        for (const auto& test : study["tests"])
          if (std::lround(test["confining_pressure_Pa"].get<double>() / 1e6) == pressure)
            {
              const bool has_peak = !test["peak_stress_Pa"].is_null();
              values.push_back(test[has_peak ? "peak_stress_Pa" : "stress_at_end_Pa"].get<double>() / 1e6);
              ++n_samples;
              n_without_peak += !has_peak;
            }
        return mean_and_deviation(values, 0);
      };
      const std::string of_grains = highest(grains_under_pressure);
      EXPECT_EQ(n_samples, 10u);
      const std::string of_slow_grains = highest(slow_grains_under_pressure);
      EXPECT_EQ(n_samples, 10u);
      std::vector<double> shares;
      for (const auto& slow : slow_grains_under_pressure["tests"])
        for (const auto& fast : grains_under_pressure["tests"])
          if (slow["seed"] == fast["seed"] && slow["confining_pressure_Pa"] == fast["confining_pressure_Pa"] &&
              std::lround(slow["confining_pressure_Pa"].get<double>() / 1e6) == pressure)
            shares.push_back(slow["peak_stress_Pa"].get<double>() / fast["peak_stress_Pa"].get<double>());
      EXPECT_EQ(shares.size(), 10u);
      const std::string of_sample = highest(sample_under_pressure);
      const std::string without_peak =
        n_without_peak > 0 ? fmt::format(", {} of {} without a peak up to 1.2 %", n_without_peak, n_samples) : "";
      shown(fmt::format("| {} | {} | {} | {} | {}{} |", pressure, of_grains, of_slow_grains,
                        mean_and_deviation(shares, 3), of_sample, without_peak));
    }

  // Kinematics of the cells.
  std::vector<nlohmann::json> finite, small;
  for (const char* const name :
       {"sample-finite-uniaxial", "sample-finite-5-mpa", "sample-finite", "sample-finite-later-seeds"})
    {
      const auto study = committed(name);
      finite.insert(finite.end(), study["tests"].begin(), study["tests"].end());
    }
  for (const auto& study : {committed("sample"), sample_under_pressure})
    std::ranges::copy_if(study["tests"], std::back_inserter(small),
                         [](const auto& test) { return test["kind"] != "direct_tension"; });
  ASSERT_GE(finite.size(), 12u);
  const auto highest_of = [](const nlohmann::json& test) {
    return test[test["peak_stress_Pa"].is_null() ? "stress_at_end_Pa" : "peak_stress_Pa"].get<double>() / 1e6;
  };
  std::map<long, std::array<std::vector<double>, 2>> by_pressure; // highest stresses, and over those in small strains
  for (const auto& turned : finite)
    {
      const double pressure = turned["confining_pressure_Pa"].get<double>() / 1e6;
      auto& [stresses, shares] = by_pressure[std::lround(pressure)];
      stresses.push_back(highest_of(turned));
      const auto shown_of = [&](const nlohmann::json& test) {
        return test["peak_stress_Pa"].is_null()
                 ? fmt::format(" {:.0f} | no peak |", highest_of(test))
                 : fmt::format(" {:.0f} | {:.1f} |", highest_of(test), 1e3 * test["strain_at_peak"].get<double>());
      };
      const auto test = std::ranges::find_if(small, [&](const auto& one) {
        return one["seed"] == turned["seed"] && one["confining_pressure_Pa"] == turned["confining_pressure_Pa"];
      });
      if (test != small.end())
        shares.push_back(highest_of(turned) / highest_of(*test));
      shown(fmt::format("| {:.0f} | {} |{}{}", pressure, turned["seed"].get<int>(),
                        test != small.end() ? shown_of(*test) : " – | – |", shown_of(turned)));
    }
  for (const auto& [pressure, figures] : by_pressure)
    {
      EXPECT_EQ(figures[0].size(), 10u) << pressure << " MPa";
      shown(fmt::format("| {} | {} | {} | {} ({}) |", pressure, figures[0].size(), mean_and_deviation(figures[0], 0),
                        mean_and_deviation(figures[1], 3), figures[1].size()));
    }

  // Where the highest stress lies without pressure.
  const auto shows_peaks_of = [&](const std::string& name, const auto& tests, const auto& belongs) {
    std::vector<double> stresses, strains;
    for (const auto& test : tests)
      if (test["kind"] == "uniaxial_compression" && belongs(test))
        {
          stresses.push_back(highest_of(test));
          strains.push_back(1e3 * test["strain_at_peak"].template get<double>());
        }
    ASSERT_EQ(stresses.size(), 10u) << name;
    shown(fmt::format("| {} | {} | {} |", name, mean_and_deviation(stresses, 0), mean_and_deviation(strains, 2)));
  };
  const auto rates = committed("rate");
  shows_peaks_of("grains, 0.25/s", rates["tests"],
                 [](const auto& test) { return test["variant"] == "Tests/Compression strain rate = 0.25 1/s"; });
  shows_peaks_of("sample, small strains", small, [](const auto&) { return true; });
  shows_peaks_of("sample, contacts turn", finite, [](const auto&) { return true; });

  // Before the peak under pressure.
  for (const int pressure : {5, 20, 60})
    for (const auto& [name, tests] : {std::pair("grains, 0.25/s", slow_grains_under_pressure["tests"]),
                                      std::pair("sample, small strains", nlohmann::json(small)),
                                      std::pair("sample, contacts turn", nlohmann::json(finite))})
      {
        std::map<std::string, std::vector<double>> figures;
        for (const auto& test : tests)
          if (std::lround(test["confining_pressure_Pa"].get<double>() / 1e6) == pressure)
            for (const char* const key :
                 {"crack_initiation_stress_Pa", "crack_damage_stress_Pa", "poissons_ratio_secant"})
              if (test[key].is_number())
                figures[key].push_back(test[key].get<double>() / (std::string(key).ends_with("_Pa") ? 1e6 : 1.0));
        shown(fmt::format(
          "| {} | {} | {} ({}) | {} ({}) | {} |", pressure, name,
          mean_and_deviation(figures["crack_initiation_stress_Pa"], 0), figures["crack_initiation_stress_Pa"].size(),
          mean_and_deviation(figures["crack_damage_stress_Pa"], 0), figures["crack_damage_stress_Pa"].size(),
          mean_and_deviation(figures["poissons_ratio_secant"], 3)));
      }

  // A minimal kinematic cell beside a body of the same packing.
  const auto body = committed("one-box");
  for (const auto& [kind, name, key, sign, decimals] :
       {std::tuple("direct tension", "one-cell-tension", "highest_stress", 1e-6, 1),
        {"uniaxial compression", "one-cell-compression", "lowest_stress", -1e-6, 0}})
    {
      std::map<unsigned, double> of_body;
      for (const auto& test : body["tests"])
        if (std::string words = test["kind"]; std::ranges::replace(words, '_', ' '), words == kind)
          of_body[test["seed"]] = test["peak_stress_Pa"].get<double>() / 1e6;
      std::vector<double> of_cell, all_of_body, shares;
      const auto cells = committed(name);
      for (const auto& rve : cells["rves"])
        {
          of_cell.push_back(sign * rve[key]["yy"]["stress_Pa"].get<double>());
          all_of_body.push_back(of_body.at(rve["seed"]));
          shares.push_back(of_cell.back() / all_of_body.back());
        }
      shown(fmt::format("| {} | {} | {} | {} | {} |", of_cell.size(), kind, mean_and_deviation(of_cell, decimals),
                        mean_and_deviation(all_of_body, decimals), mean_and_deviation(shares, 2)));
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
      EXPECT_LT(*std::max_element(left.begin(), left.end()), 0.08) << angle; // as docs/multiscale-and-grains.md has it
      shown(fmt::format("| {} | {} | {} | {} |", angle, mean_and_deviation(strengths, 2), mean_and_deviation(works, 2),
                        mean_and_deviation(left, 2)));
    }
}

// How damage begins, in the grains at both rates and in the samples.
TEST(Example, TheReadmeOfSampleAndGrainsShowsWhatComesBeforeThePeak)
{
  const std::string readme = content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/README.md");
  for (const auto& [label, name, variant] : {std::tuple("cored at the sides only, 1/s", "cored", "= sides only"),
                                             {"cored at the sides only, 0.25/s", "rate", "= 0.25 1/s"},
                                             {"sample", "sample", ""}})
    {
      const auto tests = results_of("multiscale-and-grains", name)["tests"];
      std::string row = fmt::format("\n| {} | 10 |", label);
      for (const auto& [key, unit, decimals] : {std::tuple("crack_initiation_stress_Pa", 1e6, 0),
                                                {"crack_initiation_stress_lateral_Pa", 1e6, 0},
                                                {"crack_damage_stress_Pa", 1e6, 0},
                                                {"poissons_ratio_initial", 1.0, 3},
                                                {"poissons_ratio_secant", 1.0, 2}})
        {
          std::vector<double> values;
          for (const auto& test : tests)
            if (test["kind"] == "uniaxial_compression" && test.value("variant", std::string()).ends_with(variant))
              values.push_back(test[key].get<double>() / unit);
          ASSERT_EQ(values.size(), 10u) << label;
          row += fmt::format(" {} |", mean_and_deviation(values, decimals));
        }
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
    }
}

// The stress at equal shares of broken segments: some tenth higher, as the page says.
TEST(Example, TheReadmeOfSampleAndGrainsShowsTheFirstCracks)
{
  const std::string readme = content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/README.md");
  for (const auto& [label, share] : {std::pair("1 ‰", "0.001"), {"2 ‰", "0.002"}, {"5 ‰", "0.005"}})
    {
      std::string row = fmt::format("\n| {} |", label);
      std::vector<double> means;
      for (const char* const name : {"first-cracks-grains", "first-cracks-sample"})
        {
          std::vector<double> stresses;
          const auto results = results_of("multiscale-and-grains", name);
          for (const auto& test : results["tests"])
            stresses.push_back(test["stress_at_broken_share_Pa"][share].get<double>() / 1e6);
          ASSERT_EQ(stresses.size(), 10u) << name;
          row += fmt::format(" {} |", mean_and_deviation(stresses, 1));
          means.push_back(std::accumulate(stresses.begin(), stresses.end(), 0.0) / 10.0);
        }
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
      EXPECT_GT(means[1], 1.05 * means[0]) << label;
      EXPECT_LT(means[1], 1.10 * means[0]) << label;
    }
}

// The sample of bonds that soften beside grains of them, and what it loses in the step in which it loses most.
TEST(Example, TheReadmeOfSampleAndGrainsShowsBondsThatSoften)
{
  const std::string examples = std::string(FELDSPAR_SOURCE_DIR) + "/examples/";
  const std::string readme = content(examples + "multiscale-and-grains/README.md");
  const auto of_grains = results_of("toughness", "softening-strength");
  std::map<int, double> without_opening; // by seed
  for (const int opening : {0, 1, 2, 5})
    {
      std::vector<double> grains, sample, over, lost, cracks;
      for (const auto& test : of_grains["tests"])
        if (test["kind"] == "direct_tension" &&
            test["variant"].get<std::string>().ends_with(fmt::format("= {} um", opening)))
          grains.push_back(test["peak_stress_Pa"].get<double>() / 1e6);
      const auto results = results_of("multiscale-and-grains", fmt::format("softening-{}-um", opening));
      for (const auto& test : results["tests"])
        {
          const double strength = test["peak_stress_Pa"].get<double>() / 1e6;
          sample.push_back(strength);
          over.push_back(strength / without_opening.try_emplace(test["seed"].get<int>(), strength).first->second);
          const auto& fall = test["largest_fall"];
          lost.push_back(100.0 * (fall["stress_before_Pa"].get<double>() - fall["stress_after_Pa"].get<double>()) *
                         1e-6 / strength);
          cracks.push_back(100.0 * fall["n_cracks"].get<double>() / test["n_tension_cracks"].get<double>());
          EXPECT_LT(test["energy_imbalance"].get<double>(), 1e-4) << opening; // as the page says
          EXPECT_EQ(test["n_shear_cracks"], 0) << opening;
        }
      ASSERT_EQ(grains.size(), 3u);
      ASSERT_EQ(sample.size(), 3u);
      if (opening == 0)
        for (const auto& flat : results_of("multiscale-and-grains", "sample")["tests"])
          if (const auto same = without_opening.find(flat["seed"].get<int>());
              flat["kind"] == "direct_tension" && same != without_opening.end())
            {
              const double strength = flat["peak_stress_Pa"].get<double>() / 1e6;
              EXPECT_NEAR(same->second, strength, 1e-9 * strength);
              EXPECT_EQ(results["tests"][same->first - 1]["n_tension_cracks"], flat["n_tension_cracks"]);
            }
      const std::string row = fmt::format("\n| {} | {} | {} | {} | {} | {} |", opening, mean_and_deviation(grains, 1),
                                          mean_and_deviation(sample, 1), mean_and_deviation(over, 2),
                                          mean_and_deviation(lost, 0), mean_and_deviation(cracks, 0));
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
    }
}

TEST(Example, TheReadmeOfSampleAndGrainsShowsItsMeshes)
{
  const std::string readme = content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/README.md");
  double coarsest = 0.0;
  for (const auto& [elements, points, study] :
       {std::tuple("2 × 4", 32, "sample"), {"3 × 6", 72, "sample-3-by-6"}, {"4 × 8", 128, "sample-4-by-8"}})
    {
      const auto tests = results_of("multiscale-and-grains", study)["tests"];
      const auto first = std::find_if(tests.begin(), tests.end(), [](const auto& test) {
        return test["kind"] == "uniaxial_compression" && test["seed"] == 1;
      });
      ASSERT_NE(first, tests.end());
      const double strength = (*first)["peak_stress_Pa"];
      coarsest = coarsest > 0.0 ? coarsest : strength;
      EXPECT_NEAR(strength, coarsest, 0.05 * coarsest);
      const std::string row =
        fmt::format("\n| {} | {} | {} | {} | {} | {} | {:.2f} |\n", elements, points, number(strength, 1e6, 1),
                    number((*first)["strain_at_peak"], 1e-3, 1), number((*first)["crack_initiation_stress_Pa"], 1e6, 0),
                    number((*first)["youngs_modulus_initial_Pa"], 1e9, 1), strength / coarsest);
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
    }
}

// T8: of the first five seeds, and each over the turned sample of its seed.
TEST(Example, TheReadmeOfSampleAndGrainsShowsHowCellsAreDealt)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/";
  const std::string readme = content(folder + "README.md");
  using Figures = std::map<unsigned, double>; // by seed
  const auto figures = [&](const std::string& name, const std::string& kind, const char* const key,
                           const double scale) {
    Figures found;
    const auto summary = nlohmann::json::parse(content(folder + "results/" + name + ".json"));
    for (const auto& test : summary["tests"])
      if (test["kind"] == kind && test["seed"].get<unsigned>() <= 5)
        found[test["seed"]] = test[key].get<double>() / scale;
    return found;
  };
  const auto shown = [](const Figures& all, const int decimals) {
    std::vector<double> values;
    for (const auto& [seed, value] : all)
      values.push_back(value);
    return values.size() == 1 ? fmt::format("{:.{}f}", values.front(), decimals) : mean_and_deviation(values, decimals);
  };
  const char* const pressed = "uniaxial_compression";
  const Figures turned = figures("sample", pressed, "peak_stress_Pa", 1e6);
  for (const auto& [label, name] : {std::pair("4 packings, turned", "sample"),
                                    {"4 packings, as they lie", "sample-unturned"},
                                    {"one a point, turned", "sample-own"},
                                    {"one a point, as they lie", "sample-own-unturned"},
                                    {"4 packings, one an element, turned", "sample-elements"},
                                    {"4 packings, as they lie, edge cells at the sides", "sample-edges"}})
    {
      const Figures strengths = figures(name, pressed, "peak_stress_Pa", 1e6);
      Figures ratios;
      for (const auto& [seed, strength] : strengths)
        ratios[seed] = strength / turned.at(seed);
      const std::string row =
        fmt::format("\n| {} | {} | {} | {} | {} | {} | {} |\n", label, strengths.size(),
                    shown(figures(name, "direct_tension", "peak_stress_Pa", 1e6), 1), shown(strengths, 0),
                    shown(figures(name, pressed, "strain_at_peak", 1e-3), 2),
                    shown(figures(name, pressed, "crack_initiation_stress_Pa", 1e6), 0), shown(ratios, 2));
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
      const bool is_turned = !std::string(name).ends_with("unturned");
      for (const auto& [seed, ratio] : ratios)
        EXPECT_TRUE(is_turned || ratio > 1.0) << name << ", seed " << seed; // what the page says of them
    }
}

// T4 and T5: one gap, several sizes, walls or free sides.
TEST(Example, TheReadmeOfSampleAndGrainsShowsSpecimensOfSeveralSizes)
{
  const std::string readme = content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/README.md");
  struct Body
  {
    const char *label, *width, *example, *results, *variant;
  };
  for (const Body& body :
       {Body{"walled, plane", "25", "multiscale-and-grains", "laboratory-25-mm", ""},
        {"walled, plane", "50", "multiscale-and-grains", "laboratory", "0.0457"},
        {"walled cylinder", "13.2", "multiscale-and-grains", "walled-cylinder-13.2-mm", ""},
        {"walled cylinder", "20", "multiscale-and-grains", "walled-cylinder-20-mm", ""},
        {"walled cylinder", "33", "multiscale-and-grains", "walled-cylinder-33-mm", ""},
        {"walled cylinder", "50", "beishan-cylinder", "full-size-tests", ""},
        {"cylinder cut free at its sides", "13.2", "multiscale-and-grains", "cored-cylinder-13.2-mm", ""},
        {"cylinder cut free at its sides", "20", "multiscale-and-grains", "cored-cylinder-20-mm", ""},
        {"cylinder cut free at its sides", "33", "multiscale-and-grains", "cored-cylinder-33-mm", ""},
        {"cylinder cut free at its sides", "50", "multiscale-and-grains", "cored-cylinder-50-mm", ""}})
    {
      const auto study = results_of(body.example, body.results);
      const auto shown = [&](const std::string& kind, const char* const key, const double scale, const int decimals) {
        std::vector<double> values;
        for (const auto& test : study["tests"])
          if (test["kind"] == kind && test.value("variant", "").ends_with(body.variant))
            values.push_back(test[key].get<double>() / scale);
        return values.size() == 1 ? fmt::format("{:.{}f}", values.front(), decimals)
                                  : mean_and_deviation(values, decimals);
      };
      const auto n_specimens = std::ranges::count_if(study["tests"], [&](const auto& test) {
        return test["kind"] == "uniaxial_compression" && test.value("variant", "").ends_with(body.variant);
      });
      const std::string pressed = "uniaxial_compression";
      const std::string row =
        fmt::format("\n| {} | {} | {} | {} | {} | {} | {} | {} |\n", body.label, body.width, n_specimens,
                    shown(pressed, "coordination_number_core", 1.0, 2), shown(pressed, "porosity", 1.0, 3),
                    shown("direct_tension", "peak_stress_Pa", 1e6, 1), shown(pressed, "peak_stress_Pa", 1e6, 0),
                    shown(pressed, "youngs_modulus_initial_Pa", 1e9, 1));
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
    }
}

/// With a straight line through them by least squares.
class PointsOfALine
{
public:
  void add(const double at, const double value)
  {
    x.push_back(at);
    y.push_back(value);
  }
  double at(const double place) const { return mean(y) + slope() * (place - mean(x)); }
  /// Of the line at a place; with of_one = 1 that of one more point there.
  double deviation(const double place, const double of_one) const
  {
    const double n = double(x.size());
    double errors = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k)
      errors += std::pow(y[k] - at(x[k]), 2);
    return std::sqrt(errors / (n - 2.0) * (of_one + 1.0 / n + std::pow(place - mean(x), 2) / squares()));
  }

private:
  double squares() const
  {
    double sum = 0.0;
    for (const double value : x)
      sum += std::pow(value - mean(x), 2);
    return sum;
  }
  double slope() const
  {
    double products = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k)
      products += (x[k] - mean(x)) * (y[k] - mean(y));
    return products / squares();
  }

  std::vector<double> x, y;
};

// The same cylinders under pressure.
TEST(Example, TheReadmeOfSampleAndGrainsShowsCylindersUnderPressure)
{
  const std::string readme = content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/README.md");
  struct Body
  {
    const char *label, *width, *example, *at_10_mpa, *at_40_mpa;
  };
  const char* const grains = "multiscale-and-grains";
  for (const Body& body :
       {Body{"walled cylinder", "20", "beishan-cylinder", "beishan-cylinder", "beishan-cylinder"},
        {"walled cylinder", "50", "beishan-cylinder", "full-size-triaxial-10", "full-size-triaxial-40"},
        {"cylinder cut free at its sides", "13.2", grains, "cored-cylinder-13.2-mm-confined",
         "cored-cylinder-13.2-mm-confined"},
        {"cylinder cut free at its sides", "20", grains, "cored-cylinder-20-mm-confined",
         "cored-cylinder-20-mm-confined"},
        {"cylinder cut free at its sides", "50", grains, "cored-cylinder-50-mm-confined",
         "cored-cylinder-50-mm-confined"}})
    {
      std::string cells;
      std::size_t n_specimens = 0;
      for (const auto& [pressure, study] : {std::pair(10e6, body.at_10_mpa), {40e6, body.at_40_mpa}})
        {
          std::vector<double> strengths, strains;
          const auto tests = results_of(body.example, study)["tests"];
          for (const auto& test : tests)
            if (test["kind"] == "triaxial_compression" && test["confining_pressure_Pa"] == pressure)
              {
                strengths.push_back(test["peak_stress_Pa"].get<double>() / 1e6);
                strains.push_back(test["strain_at_peak"].get<double>() * 1e3);
              }
          const auto shown = [](const std::vector<double>& values, const int decimals) {
            return values.size() == 1 ? fmt::format("{:.{}f}", values.front(), decimals)
                                      : mean_and_deviation(values, decimals);
          };
          n_specimens = strengths.size();
          cells += fmt::format(" {} | {} |", shown(strengths, 0), shown(strains, 1));
        }
      const std::string row = fmt::format("\n| {} | {} | {} |{}\n", body.label, body.width, n_specimens, cells);
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
    }

  // By a line over 1/diameter, where that is nothing.
  const auto without_surface = [](const double pressure, const std::vector<const char*>& diameters) {
    PointsOfALine points;
    for (const char* const diameter : diameters)
      {
        const auto study = results_of("multiscale-and-grains", fmt::format("cored-cylinder-{}-mm-confined", diameter));
        for (const auto& test : study["tests"])
          if (test["confining_pressure_Pa"] == pressure)
            points.add(1.0 / std::stod(diameter), test["peak_stress_Pa"].get<double>() / 1e6);
      }
    return fmt::format("{:.0f} ± {:.0f} MPa", points.at(0.0), points.deviation(0.0, 0.0));
  };
  for (const std::vector<const char*>& diameters : {std::vector{"13.2", "20", "50"}, {"13.2", "20"}})
    {
      const std::string line =
        without_surface(10e6, diameters) + " at 10 MPa and " + without_surface(40e6, diameters) + " at 40 MPa";
      EXPECT_NE(readme.find(line), std::string::npos) << "missing: " << line;
    }
}

// A line over 1/diameter by least squares, the standard error of where it ends, and where it puts one more cylinder.
TEST(Example, TheReadmeOfSampleAndGrainsShowsACylinderWithoutSurface)
{
  const std::string readme = content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/README.md");
  struct Found
  {
    std::string without_surface, at_50_mm, measured;
  };
  const auto by_the_line = [](const std::string& kind, const int decimals) {
    PointsOfALine points;
    for (const char* const diameter : {"13.2", "20", "33"})
      {
        const auto study = results_of("multiscale-and-grains", fmt::format("cored-cylinder-{}-mm", diameter));
        for (const auto& test : study["tests"])
          if (test["kind"] == kind)
            points.add(1.0 / std::stod(diameter), test["peak_stress_Pa"].get<double>() / 1e6);
      }
    double measured = 0.0;
    const auto large = results_of("multiscale-and-grains", "cored-cylinder-50-mm");
    for (const auto& test : large["tests"])
      if (test["kind"] == kind)
        measured = test["peak_stress_Pa"].get<double>() / 1e6;
    EXPECT_LT(std::abs(measured - points.at(1.0 / 50.0)), points.deviation(1.0 / 50.0, 1.0))
      << kind; // as the page says
    const auto shown = [&](const double at, const double of_one) {
      return fmt::format("{:.{}f} ± {:.{}f} MPa", points.at(at), decimals, points.deviation(at, of_one), decimals);
    };
    return Found{shown(0.0, 0.0), shown(1.0 / 50.0, 1.0), fmt::format("{:.{}f}", measured, decimals)};
  };
  const Found crushed = by_the_line("uniaxial_compression", 0), pulled = by_the_line("direct_tension", 1);
  EXPECT_NE(readme.find(crushed.without_surface + " in uniaxial compression"), std::string::npos);
  EXPECT_NE(readme.find(pulled.without_surface + " in\n  tension"), std::string::npos);
  EXPECT_NE(readme.find(fmt::format("{} and {} (standard deviations): the one that was run has {} and {} MPa",
                                    crushed.at_50_mm, pulled.at_50_mm, crushed.measured, pulled.measured)),
            std::string::npos);
}

// T7 in compression: cells with an edge or a diagonal along the axis, and oblique ones.
TEST(Example, TheReadmeOfSampleAndGrainsShowsWhichCellsAreWeak)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/";
  const std::string readme = content(folder + "README.md");
  struct Group
  {
    std::vector<double> strengths;
    int n_weak = 0, n_early = 0, n_inclined = 0, n_weak_inclined = 0, n_along = 0;
  };
  std::map<bool, Group> groups; // by whether they are oblique
  const auto compression = nlohmann::json::parse(content(folder + "results/angles-compression.json"));
  for (const auto& path : compression["after_peak"])
    {
      const std::string variant = path["variant"];
      const int angle = std::stoi(variant.substr(variant.find('=') + 1));
      Group& group = groups[angle % 45 != 0];
      const double strength = path["peak_stress_Pa"].get<double>() / 1e6;
      const double band = path["band_to_axis_deg"];
      const bool is_inclined = band >= 10.0 && band <= 35.0;
      group.strengths.push_back(strength);
      group.n_weak += strength < 200.0;
      group.n_early += path["ended_early"].get<bool>();
      group.n_inclined += is_inclined;
      group.n_weak_inclined += is_inclined && strength < 200.0;
      group.n_along += band < 1.0;
    }
  for (const auto& [label, oblique] :
       {std::pair("along the axis: 0, 45, 90 deg", false), {"oblique: 15, 30, 60, 75 deg", true}})
    {
      const Group& group = groups[oblique];
      const std::string row = fmt::format("\n| {} | {} | {} | {} | {} | {}, of those below 200 MPa {} |", label,
                                          group.strengths.size(), mean_and_deviation(group.strengths, 0), group.n_weak,
                                          group.n_early, group.n_inclined, group.n_weak_inclined);
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
    }
  EXPECT_NE(readme.find(fmt::format("along the axis {} have it parallel to the axis", groups[false].n_along)),
            std::string::npos);
}

// One cell at every point under four boundaries, beside the same cells as grains: seed by seed.
TEST(Example, TheReadmeOfSampleAndGrainsShowsTheSameCellUnderEachBoundary)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/";
  const std::string readme = content(folder + "README.md");
  for (const auto& [label, name] : {std::pair("grains side by side, 1/s", "same-cells-grains"),
                                    {"periodic", "same-cells-sample"},
                                    {"periodic, turned at random", "same-cells-sample-turned"},
                                    {"minimal kinematic", "same-cells-sample-minimal-kinematic"},
                                    {"weakly periodic", "same-cells-sample-weakly-periodic"},
                                    {"edge", "same-cells-sample-edge"}})
    {
      const auto summary = nlohmann::json::parse(content(folder + "results/" + name + ".json"));
      const auto of_seeds = [&](const std::string& kind, const char* const key, const double scale,
                                const int decimals) {
        std::string list;
        for (const auto& test : summary["tests"])
          if (test["kind"] == kind)
            list += (list.empty() ? "" : ", ") + number(test[key], scale, decimals);
        return list;
      };
      const std::string row =
        fmt::format("\n| {} | {} | {} | {} | {} |", label, of_seeds("direct_tension", "peak_stress_Pa", 1e6, 1),
                    of_seeds("uniaxial_compression", "peak_stress_Pa", 1e6, 0),
                    of_seeds("uniaxial_compression", "crack_initiation_stress_Pa", 1e6, 0),
                    of_seeds("uniaxial_compression", "youngs_modulus_initial_Pa", 1e9, 1));
      EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
    }
}

// A row a size and boundary, and the bracket that minimal kinematic and affine cells give of one packing: the stiffness as
// (9.6) has it, the strengths as was found.
TEST(Example, TheReadmeOfSampleAndGrainsShowsTheBoundariesOfACell)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/examples/multiscale-and-grains/";
  const std::string readme = content(folder + "README.md");
  const std::vector<std::string> boundaries{"minimal kinematic", "weakly periodic", "edge", "periodic", "affine"};
  using Strengths = std::map<std::string, std::map<unsigned, double>>; // by boundary and seed
  std::size_t n_compared = 0, n_in_order = 0;
  const auto count_in_order = [&](Strengths& strengths) {
    for (const auto& [seed, periodic] : strengths["periodic"])
      {
        n_compared += 2;
        n_in_order += strengths["minimal kinematic"].at(seed) <= periodic;
        n_in_order += periodic <= strengths["affine"].at(seed);
      }
  };
  for (const char* const size : {"12.5", "18", "25", "36"})
    {
      Strengths pulled, pressed;
      std::map<std::string, std::vector<double>> moduli;
      std::map<std::string, std::size_t> ended;
      const auto file = [&](const std::string& way) {
        return folder + "results/boundaries-" + way + "-" + size + "-mm.json";
      };
      const auto of_boundary = [&](const nlohmann::json& rve) {
        const std::string name = rve["boundary"];
        return *std::find_if(boundaries.begin(), boundaries.end(),
                             [&](const std::string& boundary) { return name.starts_with(boundary); });
      };
      const auto in_tension = nlohmann::json::parse(content(file("tension")));
      for (const auto& rve : in_tension["rves"])
        {
          moduli[of_boundary(rve)].push_back(rve["youngs_modulus_Pa"].get<double>() / 1e9);
          pulled[of_boundary(rve)][rve["seed"]] = rve["highest_stress"]["yy"]["stress_Pa"].get<double>() / 1e6;
        }
      if (std::filesystem::exists(file("compression")))
        {
          const auto in_compression = nlohmann::json::parse(content(file("compression")));
          for (const auto& rve : in_compression["rves"])
            {
              pressed[of_boundary(rve)][rve["seed"]] = -rve["lowest_stress"]["yy"]["stress_Pa"].get<double>() / 1e6;
              ended[of_boundary(rve)] += !rve.contains("ended_early");
            }
        }
      const auto mean_of = [](const std::map<unsigned, double>& strengths, const int decimals) {
        std::vector<double> values;
        for (const auto& [seed, value] : strengths)
          values.push_back(value);
        return mean_and_deviation(values, decimals);
      };
      for (const std::string& boundary : boundaries)
        {
          ASSERT_EQ(moduli[boundary].size(), 5u) << size << " " << boundary;
          std::string row = fmt::format("\n| {} | {} | {} | {} | ", size, boundary,
                                        mean_and_deviation(moduli[boundary], 1), mean_of(pulled[boundary], 1));
          row += pressed.empty() ? std::string("– | – |")
                                 : fmt::format("{} | {} of {} |", mean_of(pressed[boundary], 0), ended[boundary],
                                               pressed[boundary].size());
          EXPECT_NE(readme.find(row), std::string::npos) << "missing: " << row;
        }
      count_in_order(pulled);
      count_in_order(pressed);
    }
  EXPECT_EQ(n_compared, 70u);
  EXPECT_NE(readme.find(fmt::format("in {} of {} pairs", n_in_order, n_compared)), std::string::npos);
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

  // What the cost of compression is projected from.
  for (const auto& [name, study, n_points] :
       {std::tuple("fine section, uniaxial", "compression-fine", 64),
        {"first steps of `published-size.prm`, uniaxial", "published-compression", 8192}})
    {
      const auto test = nlohmann::json::parse(content(folder + "results/" + study + ".json"))["tests"][0];
      const std::string costs =
        fmt::format("| {} | {} | {} | {} |", name, n_points, test["steps"].get<int>(), shown_work(test, n_points));
      EXPECT_NE(readme.find("\n" + costs), std::string::npos) << "missing: " << costs;
      if (n_points == 64)
        {
          const double of_point =
            test["solver_work"]["seconds_in_points"].get<double>() / (test["steps"].get<int>() * 64);
          EXPECT_NE(readme.find(fmt::format("took {:.0f} ms a point and step", 1e3 * of_point)), std::string::npos);
          EXPECT_NE(readme.find(fmt::format("steps of a point are {:.1f} core-hours", 819200 * of_point / 3600)),
                    std::string::npos);
        }
      else
        EXPECT_NE(readme.find(fmt::format("with {} broken segments", test["n_tension_cracks"].get<int>())),
                  std::string::npos);
    }
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

  // The sample beside specimens of two sizes: strength [MPa] at strain [1e-3].
  const auto pressed = nlohmann::json::parse(content(folder + "results/compression.json"));
  const auto with_edges = nlohmann::json::parse(content(folder + "results/compression-edges.json"));
  const auto turning = nlohmann::json::parse(content(folder + "results/compression-finite.json"));
  // Run one by one, an hour each.
  auto whole = nlohmann::json::parse(content(folder + "results/compression-whole.json"));
  const auto under_pressure = nlohmann::json::parse(content(folder + "results/compression-whole-confined.json"));
  for (const auto& test : under_pressure["tests"])
    whole["tests"].push_back(test);
  const std::string specimens = std::string(FELDSPAR_SOURCE_DIR) + "/examples/beishan-cylinder/results/";
  const auto small = nlohmann::json::parse(content(specimens + "beishan-cylinder.json"));
  const auto peak_of = [](const nlohmann::json& test) {
    return number(test["peak_stress_Pa"], 1e6, 0) + " at " + number(test["strain_at_peak"], 1e-3, 1);
  };
  for (const auto& [name, kind, of_large] : {std::tuple("uniaxial", "uniaxial_compression", "full-size-tests"),
                                             {"at 10 MPa", "triaxial_compression_10_MPa", "full-size-triaxial-10"},
                                             {"at 40 MPa", "triaxial_compression_40_MPa", "full-size-triaxial-40"}})
    {
      const auto& test = test_of(pressed, std::string(kind) + "_seed_1");
      const auto& test_of_whole = test_of(whole, std::string(kind) + "_seed_1");
      const std::string large = specimens + of_large + ".json";
      const std::string row =
        fmt::format("| {} | {} | {} | {} | {} | {} | {} at {} |", name, peak_of(test),
                    peak_of(test_of(turning, std::string(kind) + "_seed_1")), peak_of(test_of_whole),
                    kind == std::string("uniaxial_compression") ? peak_of(with_edges["tests"][0]) : "–",
                    peak_of(test_of(nlohmann::json::parse(content(large)), std::string(kind) + "_seed_1")),
                    mean_and_deviation(small, kind, "peak_stress_Pa", 1e6, 0),
                    mean_and_deviation(small, kind, "strain_at_peak", 1e-3, 1));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
      const std::string costs_of_whole = fmt::format("| whole, `cylinder.prm`, {} | 200 | {} | {} |", name,
                                                     test_of_whole["steps"].get<int>(), shown_work(test_of_whole, 200));
      EXPECT_NE(readme.find("\n" + costs_of_whole), std::string::npos) << "missing: " << costs_of_whole;
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
} // namespace
} // namespace feldspar::tests
