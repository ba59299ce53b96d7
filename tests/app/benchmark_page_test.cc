// The figures in the README of the benchmarks are those of their committed results.

#include "tests/app/committed_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <tuple>
#include <utility>

namespace feldspar::tests
{
namespace
{
std::string number(const nlohmann::json& value, const double scale, const int decimals)
{
  return fmt::format("{:.{}f}", value.get<double>() / scale, decimals);
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

TEST(Example, BenchmarksShowHowMuchFasterDamagedCellsAre)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string page = content(folder + "README.md");
  const auto with_avx512 = nlohmann::json::parse(content(folder + "results/damaged-avx512.json"))["new_over_old"];
  const auto with_avx2 = nlohmann::json::parse(content(folder + "results/damaged-avx2.json"))["new_over_old"];
  for (const auto& [label, name] : {std::pair("increment of 408 discs without a break", "damaged_increment<2>/150"),
                                    {"increment of 602 spheres, 30 breaks", "damaged_increment<3>/110"},
                                    {"increment of 602 spheres, 15 breaks", "damaged_increment<3>/120"},
                                    {"increment of 602 spheres without a break", "damaged_increment<3>/150"},
                                    {"tangent of 602 damaged spheres", "damaged_tangent<3>/150"},
                                    {"reference of 602 spheres", "reference<3>"}})
    {
      const std::string row = fmt::format("\n| {} | {:.1f} | {:.1f} |\n", label, 1.0 / with_avx512[name].get<double>(),
                                          1.0 / with_avx2[name].get<double>());
      EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
    }
}

TEST(Example, BenchmarksShowTheCommittedFactors)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string page = content(folder + "README.md");
  const auto times = nlohmann::json::parse(content(folder + "results/factor-benchmark-avx512.json"))["benchmarks"];
  const auto shown = [&](const std::string& body, const int dim, const int width) {
    const auto time = [&](const std::string& name) {
      return times[fmt::format("{}>/{}", name, width)]["processor_time_ns"].get<double>();
    };
    std::string row = "\n| " + body + " |";
    for (const auto& [what, unit] : {std::pair("factorise", 1e6), std::pair("solve", 1e3)})
      for (const std::string& name :
           {fmt::format("block_{}<{}", what, dim), fmt::format("library_{}<{}, OfEigen", what, dim),
            fmt::format("library_{}<{}, OfCholmod", what, dim)})
        row += fmt::format(" {:.3g} |", time(name) / unit);
    EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
  };
  shown("408 discs", 2, 325);
  shown("100 spheres", 3, 74);
  shown("602 spheres", 3, 133);
}

TEST(Example, BenchmarksShowTheCommittedPackings)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string page = content(folder + "README.md");
  for (const auto& [label, instructions] : {std::pair("AVX-512", "avx512"), {"AVX2", "avx2"}})
    {
      const auto times = nlohmann::json::parse(
        content(folder + fmt::format("results/packing-benchmark-{}.json", instructions)))["benchmarks"];
      for (const auto& [dim, body] : {std::pair(2, "discs between walls"), {3, "spheres in a cylinder"}})
        {
          const auto& by_descent = times[fmt::format("by_descent<{}>", dim)];
          const auto& by_motion = times[fmt::format("by_motion<{}>", dim)];
          EXPECT_EQ(by_descent["grains"], by_motion["grains"]);
          const double one = by_descent["processor_time_ns"].get<double>() / 1e9;
          const double other = by_motion["processor_time_ns"].get<double>() / 1e9;
          const std::string row = fmt::format("\n| {} {} | {} | {:.2g} | {:.2g} | {:.0f} |\n",
                                              by_descent["grains"].get<int>(), body, label, one, other, other / one);
          EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
        }
      const auto nine =
        nlohmann::json::parse(content(folder + fmt::format("results/nine-tests-{}.json", instructions)));
      const std::string row = fmt::format("\n| {} | {:.0f} | {:.0f} |\n", label, nine["clock_s"].get<double>(),
                                          nine["user_time_s"].get<double>());
      EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
      // The program chooses its instructions by the processor, and they do not change a bit.
      const auto by_coordination = results_of("beishan-granite", "ensemble-by-coordination");
      EXPECT_EQ(nine["peak_stress_Pa"].size(), 9u);
      for (const auto& [name, peak] : nine["peak_stress_Pa"].items())
        EXPECT_EQ(peak, test_of(by_coordination, name)["peak_stress_Pa"]) << name;
    }
}

TEST(Example, BenchmarksShowTheCommittedSteps)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string page = content(folder + "README.md");
  const auto result = [&](const std::string& name) {
    return nlohmann::json::parse(content(folder + "results/" + name + ".json"));
  };
  for (const auto& [label, measured] :
       {std::pair("AVX2, EPYC", "avx2"), {"AVX2, Xeon", "avx2-xeon"}, {"AVX-512, Xeon", "avx512"}})
    {
      const auto ratios = result(fmt::format("steps-{}", measured))["new_over_old"];
      const auto plane = result(fmt::format("dynamics-benchmark-{}", measured))["benchmarks"];
      const auto times_as_fast = [&](const std::string& name) {
        return ratios.contains(name) ? fmt::format("{:.1f}", 1.0 / ratios[name].get<double>()) : "–";
      };
      for (const int n : {2000, 20000, 200000})
        {
          const auto named = [&](const std::string& of) { return fmt::format("{}/{}/real_time", of, n); };
          const double over_plain = plane[named("plain_step")]["processor_time_ns"].get<double>() /
                                    plane[named("engine_step")]["processor_time_ns"].get<double>();
          const std::string row =
            fmt::format("\n| {} discs | {} | {} | {} | {:.1f} |\n", n, label, times_as_fast(named("engine_step")),
                        times_as_fast(named("engine_step_broken")), over_plain);
          EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
        }
      for (const int n : {5000, 50000, 400000})
        {
          const std::string row = fmt::format("\n| {} spheres | {} | {} | {} | – |\n", n, label,
                                              times_as_fast(fmt::format("space_step/{}", n)),
                                              times_as_fast(fmt::format("space_step_broken/{}", n)));
          EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
        }
    }
}

TEST(Example, BenchmarksShowWholeTestsBesideTheProgramBefore)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string page = content(folder + "README.md");
  for (const char* const file : {"whole-tests-avx2", "packings-avx512"})
    {
      const auto tests = nlohmann::json::parse(content(folder + "results/" + file + ".json"))["tests"];
      for (const auto& [grains, name] : {std::pair("discs", "plane"), {"spheres", "space"}})
        {
          const auto& test = tests[name];
          const double before = test["old_s"], now = test["new_s"];
          const std::string row =
            fmt::format("\n| {} {}, {} joints | {:.1f} | {:.1f} | {:.2f} |\n", test["n_grains"].get<int>(), grains,
                        test["n_joints"].get<int>(), before, now, before / now);
          EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
          EXPECT_EQ(test["old_peak_stress_Pa"], test["new_peak_stress_Pa"]) << file << ", " << name; // as the page says
        }
    }
}

TEST(Example, BenchmarksShowWholeSamplesBesideTheProgramBefore)
{
  const std::string folder = std::string(FELDSPAR_SOURCE_DIR) + "/benchmarks/";
  const std::string page = content(folder + "README.md");
  for (const auto& [label, measured] : {std::pair("AVX2, EPYC", "avx2"), {"AVX-512, Xeon", "avx512"}})
    {
      const auto file = folder + "results/whole-samples-" + measured + ".json";
      const auto tests = nlohmann::json::parse(content(file))["tests"];
      for (const auto& [name, cells] :
           {std::pair("plane", "32 cells of {} discs"), {"section of a cylinder", "16 cells of {} spheres"}})
        {
          const auto& test = tests[name];
          const double before = test["old_s"], now = test["new_s"];
          const std::string row = fmt::format("\n| {}, {} | {} | {:.1f} | {:.1f} | {:.2f} |\n", name,
                                              fmt::format(fmt::runtime(cells), test["n_grains"].get<int>()), label,
                                              before, now, before / now);
          EXPECT_NE(page.find(row), std::string::npos) << "missing: " << row;
          EXPECT_EQ(test["old_n_cracks"], test["new_n_cracks"]) << name; // as the page says
        }
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
} // namespace
} // namespace feldspar::tests
