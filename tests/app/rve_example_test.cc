// The figures in the README on representative volumes are those of the committed results, which agree with one another.

#include "tests/app/committed_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace feldspar::tests
{
namespace
{
const std::string of_rves = std::string(FELDSPAR_SOURCE_DIR) + "/examples/rve-beishan/";

/// A figure of each RVE of a study, of one variant or of all.
std::vector<double> over_rves(const nlohmann::json& study, const std::string& variant,
                              const std::function<double(const nlohmann::json&)>& figure)
{
  std::vector<double> figures;
  for (const auto& rve : rves_in(study))
    if (variant.empty() || rve["variant"] == variant)
      figures.push_back(figure(rve));
  return figures;
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

nlohmann::json rve_results(const std::string& study) { return results_of("rve-beishan", study); }

/// By value: the loop that walks through them would outlive the file they are read from.
std::vector<nlohmann::json> rves_of(const std::string& study)
{
  const auto study_results = rve_results(study);
  const auto& rves = rves_in(study_results);
  EXPECT_FALSE(rves.empty()) << study;
  return {rves.begin(), rves.end()};
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

  const auto laboratory = results_of("beishan-granite", "ensemble-by-motion");
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

TEST(Example, TheRvesReadmeShowsWhatTurningContactsChange)
{
  const std::string readme = content(of_rves + "README.md");
  const auto study = rve_results("kinematics");
  const auto peaks = [&](const double pressure, const double modulus, const std::string& solver,
                         const std::string& kinematics) {
    std::vector<double> values;
    for (const auto& rve : rves_in(study))
      {
        const auto& entries = rve["variant_values"];
        if (entries["Strain path/Confining pressure"]["value"] == pressure &&
            entries["Flat joint/Modulus"]["value"] == modulus && entries["Strain path/Solver"]["value"] == solver &&
            entries["Representative volume/Kinematics"]["value"] == kinematics)
          values.push_back(compressive_peak(rve));
      }
    EXPECT_EQ(values.size(), 5u) << pressure << " " << modulus << " " << solver << " " << kinematics;
    return values;
  };
  const auto over = [](std::vector<double> values, const std::vector<double>& others) {
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] /= others.at(k);
    return mean_and_deviation(values, 3);
  };
  for (const double pressure : {20.0, 60.0})
    {
      const auto small = peaks(pressure, 80.0, "event by event", "small strains");
      const auto finite = peaks(pressure, 80.0, "event by event", "finite");
      const auto dynamic = peaks(pressure, 80.0, "explicit", "small strains");
      const auto stiff_small = peaks(pressure, 1280.0, "event by event", "small strains");
      const auto stiff_dynamic = peaks(pressure, 1280.0, "explicit", "small strains");
      const std::string row = fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} |", pressure, mean_and_deviation(small, 0),
        mean_and_deviation(finite, 0), mean_and_deviation(dynamic, 0), over(small, dynamic), over(finite, dynamic),
        mean_and_deviation(stiff_small, 0), mean_and_deviation(stiff_dynamic, 0), over(stiff_small, stiff_dynamic));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
    }
}

TEST(Example, TheRvesReadmeShowsWhereCellsWithFreeSidesEnd)
{
  const std::string readme = content(of_rves + "README.md");
  struct Pressed
  {
    std::vector<double> peak, at;        ///< [MPa], [1e-3]
    std::vector<double> left;            ///< [MPa], of those that went to the end
    std::map<unsigned, double> ended_at; ///< [1e-3], of the others
  };
  std::map<std::string, Pressed> cells;
  std::size_t n_moved_apart = 0, n_widened = 0;
  for (const auto& rve : rves_of("kinematics-free-sides"))
    {
      const auto& entries = rve["variant_values"];
      std::string name =
        entries["Representative volume/Kinematics"]["value"] == "finite" ? "finite kinematics" : "small strains";
      if (entries["Strain path/Solver"]["value"] == "explicit")
        name =
          fmt::format("explicit, {} steps per 1e-3", entries["Strain path/Steps per millistrain"]["value"].get<int>());
      if (const double angle = entries["Strain path/Cell angle"]["value"]; angle > 0.0)
        name += fmt::format(", turned by {}°", angle);
      auto& [peak, at, left, ended_at] = cells[name];
      const auto& highest = rve["lowest_stress"]["yy"];
      peak.push_back(-highest["stress_Pa"].get<double>() / 1e6);
      at.push_back(-1e3 * highest["strain"].get<double>());
      if (const auto why = rve.value("ended_early", ""); why.empty())
        left.push_back(-rve["at_end"]["stress_yy_Pa"].get<double>() / 1e6);
      else
        {
          ended_at[rve["seed"]] = -1e3 * rve["at_end"]["strain_yy"].get<double>();
          EXPECT_NE(why.find("0.1; the path ends"), std::string::npos) << why; // strained beyond what is taken
          const bool was_wide = std::abs(rve["at_end"]["strain_xx"].get<double>()) > 0.0999;
          ++(was_wide ? n_widened : n_moved_apart);
        }
    }
  ASSERT_EQ(cells.size(), 6u);
  for (const auto& [name, of] : cells)
    {
      const std::string row = fmt::format("| {} | {} | {} | {} of {} | {} |", name, mean_and_deviation(of.peak, 0),
                                          mean_and_deviation(of.at, 2), of.ended_at.size(), of.peak.size(),
                                          of.left.empty() ? "–" : mean_and_deviation(of.left, 0));
      EXPECT_NE(readme.find("\n" + row), std::string::npos) << "missing: " << row;
    }
  const std::string ends =
    fmt::format("Of the {} that ended {} moved apart in the search", n_moved_apart + n_widened, n_moved_apart);
  EXPECT_NE(readme.find(ends), std::string::npos) << "missing: " << ends;

  // Where finite kinematics end, explicit dynamics have had their highest stress; the seeds are 1 to 20.
  const auto& ended_at = cells["finite kinematics"].ended_at;
  for (const char* const rate : {"20000", "80000"})
    {
      const auto& failed_at = cells[fmt::format("explicit, {} steps per 1e-3", rate)].at;
      const auto n_before = std::count_if(ended_at.begin(), ended_at.end(),
                                          [&](const auto& end) { return failed_at.at(end.first - 1) < end.second; });
      const std::string sentence =
        fmt::format("In {} of the {} that ended along their edges", n_before, ended_at.size());
      EXPECT_NE(readme.find(sentence), std::string::npos) << "missing: " << sentence;
    }
}

// Hill and Mandel within ten times the final tolerance and energy within 0.1 % along every path event by event.
TEST(Example, PathsEventByEventBalance)
{
  for (const char* const study :
       {"tension", "break-rules", "uniaxial", "triaxial-20", "triaxial-60", "kinematics", "kinematics-free-sides",
        "tension-3d", "uniaxial-3d", "triaxial-20-3d", "triaxial-60-3d", "size-12-mm", "size-16-mm", "size-23-mm",
        "size-32.5-mm", "size-46-mm"})
    for (const auto& rve : rves_of(study))
      if (rve.value("variant", "").find("Strain path/Solver = explicit") == std::string::npos)
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
  path_row("tension", rves_of("tension-3d")[0], "highest_stress", 1.0);
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
