// The committed results hold what their pages claim of the rock.

#include "tests/app/committed_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace feldspar::tests
{
namespace
{
/// A mean over tests.
struct Mean
{
  const char *study, *group, *variant = "", *key = "peak_stress_Pa";

  double value() const { return mean(values_of(tests_of(study, group, variant), key)); }
};

/// A mean within bounds, or its ratio to another.
struct Claim
{
  const char* statement;
  Mean mean;
  double low, high;
  Mean over{};
};

constexpr double any = std::numeric_limits<double>::infinity();
constexpr auto granite = "beishan-granite/ensemble";
constexpr auto pulled = "direct_tension", pressed = "uniaxial_compression", at_5 = "triaxial_compression_5_MPa",
               at_10 = "triaxial_compression_10_MPa", at_20 = "triaxial_compression_20_MPa",
               at_60 = "triaxial_compression_60_MPa";
constexpr auto lac = "calibrate-lac-du-bonnet/best", lac_of_less_friction = "calibrate-lac-du-bonnet/friction-0.1-best";
constexpr auto tangent = "youngs_modulus_tangent_Pa", shear_share = "shear_share_at_peak",
               smooth_share = "smooth_tension_share_at_peak";
constexpr auto bonds = "contact-models/parallel-bond", grains = "contact-models/grain-based",
               clumps = "contact-models/clumped", flat = "contact-models/flat-joint";
constexpr auto of_bonds_that_shear = "contact-models/parallel-bond-shear-only",
               of_bonds_that_open = "contact-models/parallel-bond-tension-only", sizes = "contact-models/clump-size";
constexpr Mean smooth_platens{"beishan-granite/platens", pressed, "= 0"};
constexpr Mean rough_platens{"beishan-granite/platens", pressed, "= 0.2"};
constexpr Mean sample{"multiscale-and-grains/sample", pressed};
constexpr Mean first_sample{"multiscale-and-grains/sample", "uniaxial_compression_seed_1"};
constexpr Mean section_pulled{"multiscale-beishan-cylinder/tension", pulled, "", "youngs_modulus_initial_Pa"};
constexpr Mean whole{"multiscale-beishan-cylinder/cylinder", pulled, "", "youngs_modulus_initial_Pa"};

const std::vector<Claim> claims{
  // The flat-joint law in an independent program over as many seeds, and its triaxial means ± 8 %.
  {"Beishan granite, uniaxial strength", {granite, pressed}, 138e6, 178e6},
  {"Beishan granite, tensile strength", {granite, pulled}, 8.6e6, 10.9e6},
  {"Beishan granite, tensile over uniaxial strength", {granite, pulled}, 0.048, 0.076, {granite, pressed}},
  {"Beishan granite, modulus", {granite, pressed, "", tangent}, 57e9, 66e9},
  {"Beishan granite, at 5 MPa", {granite, at_5}, 0.92 * 255e6, 1.08 * 255e6},
  {"Beishan granite, at 10 MPa", {granite, at_10}, 0.92 * 313e6, 1.08 * 313e6},
  {"Beishan granite, at 20 MPa", {granite, at_20}, 0.92 * 384e6, 1.08 * 384e6},
  {"Beishan granite, at 30 MPa", {granite, "triaxial_compression_30_MPa"}, 0.92 * 435e6, 1.08 * 435e6},
  {"Beishan granite, at 40 MPa", {granite, "triaxial_compression_40_MPa"}, 0.92 * 463e6, 1.08 * 463e6},
  {"Beishan granite, at 50 MPa", {granite, "triaxial_compression_50_MPa"}, 0.92 * 493e6, 1.08 * 493e6},
  {"Beishan granite, at 60 MPa", {granite, at_60}, 0.92 * 523e6, 1.08 * 523e6},
  {"pressure brings shear", {granite, at_60, "", shear_share}, 3.0, any, {granite, at_5, "", shear_share}},
  {"brittle without pressure", {granite, pressed, "", "residual_deviator_ratio"}, 0.0, 0.5},
  {"ductile under pressure", {granite, at_60, "", "residual_deviator_ratio"}, 0.65, any},
  {"friction of platens", rough_platens, 1.41, 1.43, smooth_platens},
  // Held back from the calibration, measured 265 and 330 MPa.
  {"Lac du Bonnet at 5 MPa", {lac, at_5}, 0.92 * 265e6, 1.08 * 265e6},
  {"Lac du Bonnet at 10 MPa", {lac, at_10}, 0.92 * 330e6, 1.08 * 330e6},
  {"Lac du Bonnet at 5 MPa, less friction", {lac_of_less_friction, at_5}, 0.92 * 265e6, 1.08 * 265e6},
  {"Lac du Bonnet at 10 MPa, less friction", {lac_of_less_friction, at_10}, 0.92 * 330e6, 1.08 * 330e6},
  // Like with like: the stiffness and the compressive strength of the rock.
  {"parallel bonds have the rock's strength", {bonds, pressed}, 148e6, 178e6},
  {"clumps have the rock's strength", {clumps, pressed}, 148e6, 178e6},
  {"mineral grains have the rock's strength", {grains, pressed}, 148e6, 178e6},
  {"flat joints have the rock's strength", {flat, pressed}, 148e6, 178e6},
  {"parallel bonds have the rock's modulus", {bonds, pressed, "", tangent}, 58e9, 64e9},
  {"clumps have the rock's modulus", {clumps, pressed, "", tangent}, 58e9, 64e9},
  {"mineral grains have the rock's modulus", {grains, pressed, "", tangent}, 58e9, 64e9},
  {"flat joints have the rock's modulus", {flat, pressed, "", tangent}, 58e9, 64e9},
  // 0.30 to 0.36 is asked of the traditional model at the rock's stiffness and strength, 0.035 to 0.06 of a grain-based one
  // (Potyondy 2010 has 0.047); published clumps lie below the parallel bond's 0.25 to 0.33 and not below 0.07.
  {"ratio of parallel bonds", {bonds, pulled}, 0.30, 0.36, {bonds, pressed}},
  {"ratio of mineral grains", {grains, pulled}, 0.035, 0.06, {grains, pressed}},
  {"ratio of clumps", {clumps, pulled}, 0.07, 0.25, {clumps, pressed}},
  {"boundaries open in tension", {grains, pulled, "", smooth_share}, 1.0, 1.0},
  {"boundaries open in compression", {grains, pressed, "", smooth_share}, 0.6, 1.0},
  {"strong bonds only shear", {of_bonds_that_shear, pressed, "", shear_share}, 0.995, 1.0},
  {"strong bonds only shear at 60 MPa", {of_bonds_that_shear, at_60, "", shear_share}, 0.995, 1.0},
  {"tough bonds only open", {of_bonds_that_open, pressed, "", shear_share}, 0.0, 0.005},
  {"tough bonds only open at 60 MPa", {of_bonds_that_open, at_60, "", shear_share}, 0.0, 0.005},
  {"clumps of 4 mm are the model of the table", {sizes, pulled, "= 4 mm"}, 1.0, 1.0, {clumps, pulled}},
  // The sample of finite elements beside its grains.
  {"whole cylinder is as stiff as its section", whole, 0.98, 1.02, section_pulled},
  {"3 x 6 elements", {"multiscale-and-grains/sample-3-by-6", pressed}, 0.95, 1.05, first_sample},
  {"4 x 8 elements", {"multiscale-and-grains/sample-4-by-8", pressed}, 0.95, 1.05, first_sample},
  {"cells along the axis are stronger", {"multiscale-and-grains/sample-unturned", pressed}, 1.2, 1.6, sample},
};

TEST(Example, MeansLieWhereTheirPagesSay)
{
  for (const auto& [statement, mean, low, high, over] : claims)
    {
      const double value = mean.value() / (over.study ? over.value() : 1.0);
      EXPECT_GE(value, low * (1.0 - 1e-12)) << statement;
      EXPECT_LE(value, high * (1.0 + 1e-12)) << statement;
    }
}

TEST(Example, TestsAreAsAccurateAsTheirPagesSay)
{
  std::vector<std::tuple<const char*, const char*, double>> measures{{granite, "energy_imbalance_over_work", 0.01},
                                                                     {granite, "servo_error", 0.01},
                                                                     {grains, "energy_imbalance_over_work", 5e-5}};
  for (const char* const model : {bonds, clumps, flat})
    measures.emplace_back(model, "energy_imbalance_over_work", 0.01);
  for (const char* const opening : {"0", "1", "2", "5"})
    for (const Json& test : tests_of(fmt::format("multiscale-and-grains/softening-{}-um", opening)))
      {
        EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 2e-4) << opening;
        EXPECT_EQ(test["n_shear_cracks"], 0) << opening;
      }
  for (const auto& [study, key, bound] : measures)
    for (const double value : values_of(tests_of(study), key))
      EXPECT_LT(value, bound) << study << ", " << key;
  // Hill and Mandel within ten times the final tolerance and energy within 0.1 % along every path event by event.
  for (const char* study : {"tension", "break-rules", "uniaxial", "triaxial-20", "triaxial-60", "kinematics",
                            "kinematics-free-sides", "tension-3d", "uniaxial-3d", "triaxial-20-3d", "triaxial-60-3d",
                            "size-12-mm", "size-16-mm", "size-23-mm", "size-32.5-mm", "size-46-mm"})
    for (const Json& rve : tests_of(std::string("rve-beishan/") + study))
      if (rve.value("variant", "").find("Solver = explicit") == std::string::npos)
        {
          EXPECT_LE(rve["hill_mandel_residual"].get<double>(), 1e-5) << study << " " << rve["seed"];
          EXPECT_LE(rve["energy_imbalance"].get<double>(), 1e-3) << study << " " << rve["seed"];
        }
}

TEST(Example, PackingsByDescentAreTheRockOfThoseByMotion)
{
  for (const auto& [group, key] : {std::pair(pulled, "porosity"),
                                   {pulled, "coordination_number_core"},
                                   {pulled, "installation_gap_ratio"},
                                   {pulled, "peak_stress_Pa"},
                                   {pressed, "peak_stress_Pa"},
                                   {at_5, "peak_stress_Pa"},
                                   {at_20, "peak_stress_Pa"},
                                   {at_60, "peak_stress_Pa"},
                                   {pressed, "youngs_modulus_tangent_Pa"},
                                   {pressed, "youngs_modulus_initial_Pa"}})
    {
      double means[2], error = 0.0;
      for (const int k : {0, 1})
        {
          const auto values = values_of(
            tests_of(k == 0 ? "beishan-granite/ensemble-by-motion" : "beishan-granite/ensemble-by-coordination", group),
            key);
          ASSERT_EQ(values.size(), 10u);
          means[k] = mean(values);
          for (const double value : values)
            error += (value - means[k]) * (value - means[k]) / (9.0 * 10.0);
        }
      // Two means of ten differ by more in one of a hundred trials (Student's t, 18 degrees of freedom).
      EXPECT_LT(std::abs(means[1] - means[0]), 2.88 * std::sqrt(error)) << group << ", " << key;
    }
}

// The targets of the small cylinder: figures of the rock over the ratios of two cylinders of Table 1.
TEST(Example, TheTargetsOfTheSmallCylinderAreThoseOfTheRockOverTheRatiosOfTheSizes)
{
  const Json targets = json_of("examples/calibrate-beishan-cylinder/reference.json")["experiment"];
  const Json rock = json_of("examples/beishan-granite/reference.json")["experiment"];
  for (const auto& [group, key, target] : {std::tuple(pulled, "peak_stress_Pa", "tensile_strength_MPa"),
                                           {pressed, "peak_stress_Pa", "uniaxial_compressive_strength_MPa"},
                                           {pressed, tangent, "youngs_modulus_GPa"},
                                           {pressed, "poissons_ratio_secant", "poissons_ratio"}})
    {
      const double ratio = Mean{"beishan-cylinder/full-size-tests", group, "", key}.value() /
                           Mean{"beishan-cylinder/beishan-cylinder", group, "", key}.value();
      const double expected = rock[target]["mean"].get<double>() / ratio;
      EXPECT_NEAR(targets[target]["mean"].get<double>(), expected, 5e-3 * expected) << target; // three figures or more
    }
}

TEST(Example, TheCylinderOf50MmIsPackedInTheTimeThatWasTheAim)
{
  const Json packing = results_of("beishan-cylinder", "full-size");
  EXPECT_LT(packing["processor_time_s"].get<double>(), 2 * 300.0); // five minutes of two cores
  EXPECT_NEAR(packing["radius_multiplier"].get<double>(), 1.0, 0.01);
  for (const char* const study : {"tests", "triaxial-10", "triaxial-40"})
    EXPECT_EQ(tests_of(std::string("beishan-cylinder/full-size-") + study)[0]["n_joints"], packing["n_joints"]);
}

// An unbonded plane slides at τ = 0.6 σ_n and dilates by 8°, less against a normal stiffness; one compliance for all.
TEST(DirectShear, OfASmoothPlaneIsThatOfItsLaw)
{
  constexpr double friction = 0.6, compliance = 0.41e-12; // [m/Pa]
  const double tangent_of_dilation = std::tan(8.0 * M_PI / 180.0);
  std::size_t n = 0;
  for (const Json& test : tests_of("direct-shear/smooth-plane"))
    if (const std::string variant = test["variant"]; variant.find("cohesion") == std::string::npos)
      {
        const double expected = friction * test["confining_pressure_Pa"].get<double>();
        EXPECT_NEAR(test["peak_stress_Pa"].get<double>(), expected, 0.01 * expected) << test["name"];
        if (variant.find("dilation") != std::string::npos)
          {
            EXPECT_NEAR(std::tan(test["dilation_angle_rad"].get<double>()), tangent_of_dilation,
                        0.05 * tangent_of_dilation)
              << test["name"];
          }
        ++n;
      }
  EXPECT_EQ(n, 18u);
  for (const auto& [variant, stiffness] :
       {std::pair("= none", 0.0), {"= 0.05 GPa/mm", 5e10}, {"= 0.2 GPa/mm", 2e11}, {"= 0.8 GPa/mm", 8e11}})
    for (const Json& test : tests_of("direct-shear/stiff-rock", "", variant))
      {
        const double expected = friction * test["normal_stress_at_peak_Pa"].get<double>();
        EXPECT_NEAR(test["peak_stress_Pa"].get<double>(), expected, 0.005 * expected) << test["name"];
        const double slope = tangent_of_dilation / (1.0 + stiffness * compliance);
        EXPECT_NEAR(std::tan(test["dilation_angle_rad"].get<double>()), slope, 0.005 * slope) << test["name"];
      }
}

TEST(ContactModels, AreComparedOnPackingsOfTheSameRadiiInTestsThatEnd)
{
  const auto first = tests_of(bonds);
  ASSERT_EQ(first.size(), 25u);
  for (const char* const model : {clumps, grains, flat})
    {
      const auto tests = tests_of(model);
      ASSERT_EQ(tests.size(), first.size());
      for (std::size_t k = 0; k < tests.size(); ++k)
        {
          EXPECT_EQ(tests[k]["name"], first[k]["name"]);
          EXPECT_EQ(tests[k]["n_grains"], first[k]["n_grains"]);
          EXPECT_FALSE(tests[k].contains("interrupted"));
        }
    }
  const Json ten = results_of("beishan-granite", "ensemble-by-motion");
  for (const Json& test : tests_of(flat))
    {
      const double expected = test_of(ten, test["name"])["peak_stress_Pa"];
      EXPECT_NEAR(test["peak_stress_Pa"].get<double>(), expected, 1e-6 * expected) << test["name"];
    }
}

// A line where bonds shear, a curve where they open; clumps steepen the line more than their bonds do.
TEST(ContactModels, HaveALineOrACurveForAnEnvelope)
{
  const auto fits = [](const std::string& model) { return results_of("contact-models", model)["fits"]; };
  const auto is_a_line = [](const Json& of) {
    return of["mohr_coulomb"]["r_squared"].get<double>() >
           of["intact"]["without_tension_point"]["r_squared"].get<double>();
  };
  EXPECT_TRUE(is_a_line(fits("parallel-bond-shear-only")));
  EXPECT_FALSE(is_a_line(fits("parallel-bond-tension-only")));
  EXPECT_FALSE(is_a_line(fits("clumped-without-clumps")));
  const auto slope = [&](const std::string& model) { return fits(model)["mohr_coulomb"]["slope"].get<double>(); };
  EXPECT_GT(slope("clumped"), 2.0 * slope("clumped-without-clumps"));
  for (const Json& test : tests_of(clumps))
    {
      EXPECT_GT(test["n_clumps"].get<int>(), 0) << test["name"];
      // At 60 MPa the highest stress lies where the tests end.
      if (test["confining_pressure_Pa"] == 60e6 && test.contains("strain_at_peak"))
        {
          EXPECT_GT(test["strain_at_peak"].get<double>(), 0.0195) << test["name"];
        }
    }
}

TEST(ContactModels, TheRatioFallsAsClumpsGrow)
{
  double before = 1.0;
  for (const char* const diameter : {"= none", "= 4 mm", "= 8 mm"})
    {
      const double ratio = Mean{sizes, pulled, diameter}.value() / Mean{sizes, pressed, diameter}.value();
      EXPECT_LT(ratio, 0.7 * before) << diameter;
      before = ratio;
    }
}

double tensile_peak(const Json& rve) { return rve["highest_stress"]["yy"]["stress_Pa"]; }

double dissipated(const Json& rve)
{
  const auto& end = rve["at_end"];
  return end["slip_energy_J"].get<double>() + end["released_energy_J"].get<double>() +
         end["settling_energy_J"].get<double>();
}

std::vector<double> of_rves(const std::string& study, const std::string& variant, double (*figure)(const Json&))
{
  std::vector<double> values;
  for (const Json& rve : tests_of("rve-beishan/" + study, "", variant))
    values.push_back(figure(rve));
  return values;
}

TEST(Example, TheExplicitRveApproachesTheRateFreeOneAndBreakRulesAgree)
{
  const auto by_events = of_rves("break-rules", "= near worst", dissipated);
  const double peak = mean(of_rves("break-rules", "= only worst", tensile_peak));
  const double energy = mean(of_rves("break-rules", "= only worst", dissipated));
  EXPECT_NEAR(mean(of_rves("break-rules", "= near worst", tensile_peak)), peak, 0.02 * peak);
  EXPECT_NEAR(mean(by_events), energy, 0.05 * energy);
  double error = std::numeric_limits<double>::infinity();
  for (const char* const steps : {"= 1000", "= 10000", "= 100000", "= 1000000"})
    {
      if (std::string(steps) != "= 1000")
        {
          EXPECT_NEAR(mean(of_rves("explicit-tension", steps, tensile_peak)), peak, 0.01 * peak) << steps;
        }
      const double smaller = std::abs(mean(of_rves("explicit-tension", steps, dissipated)) - mean(by_events));
      EXPECT_LT(smaller, 0.5 * error) << steps;
      error = smaller;
    }
  // The slowest has as much as the rate-free one for all that five realisations can tell, each of which breaks in an order
  // of its own: the mean of the differences lies within its 95 % confidence interval about zero.
  constexpr double t_of_five = 2.776;
  auto differences = of_rves("explicit-tension", "= 1000000", dissipated);
  ASSERT_EQ(differences.size(), 5u);
  double squares = 0.0;
  for (std::size_t k = 0; k < differences.size(); ++k)
    differences[k] -= by_events.at(k);
  for (const double one : differences)
    squares += std::pow(one - mean(differences), 2);
  EXPECT_LT(std::abs(mean(differences)), t_of_five * std::sqrt(squares / 4.0 / 5.0));
}

TEST(Study, NetworksInSpaceAreThoseOfIndependentPrograms)
{
  // Mean of three packings of more than 800 spheres, gap by gap; benchmarks/networks_in_space.cc.
  const Json networks = json_of("benchmarks/results/networks-in-space.json")["networks"];
  for (const auto& [gap, coordination, modulus] :
       {std::tuple(0.0, 5.9, 0.65), {0.05, 7.15, 0.82}, {0.1, 7.75, 0.92}, {0.3, 9.4, 1.20}})
    {
      std::vector<Json> rows;
      std::copy_if(networks.begin(), networks.end(), std::back_inserter(rows),
                   [gap = gap](const Json& row) { return row["installation_gap_ratio"] == gap; });
      EXPECT_EQ(rows.size(), 3u);
      EXPECT_NEAR(mean(values_of(rows, "coordination_number")), coordination, 0.05 * coordination);
      EXPECT_NEAR(mean(values_of(rows, "youngs_modulus_over_joint_modulus")), modulus, 0.05 * modulus);
      for (const double n_grains : values_of(rows, "n_grains"))
        EXPECT_GT(n_grains, 800);
    }
}

// At equal shares of broken segments, some tenth higher.
TEST(SampleAndGrains, FirstCracksOfTheSampleComeLate)
{
  for (const char* const share : {"0.001", "0.002", "0.005"})
    {
      double means[2];
      for (const int k : {0, 1})
        {
          std::vector<double> stresses;
          for (const Json& test : tests_of(k == 0 ? "multiscale-and-grains/first-cracks-grains"
                                                  : "multiscale-and-grains/first-cracks-sample"))
            stresses.push_back(test["stress_at_broken_share_Pa"][share]);
          means[k] = mean(stresses);
        }
      EXPECT_GT(means[1], 1.05 * means[0]) << share;
      EXPECT_LT(means[1], 1.10 * means[0]) << share;
    }
}

// Cut at the sides only and loaded at the highest rate, in two studies; and bonds that soften over no opening are flat joints.
TEST(SampleAndGrains, TheSameTestsOfTwoStudiesHaveTheSameStrengths)
{
  const auto strengths = [](const char* study, const char* group, const char* variant) {
    std::map<int, double> by_seed;
    for (const Json& test : tests_of(std::string("multiscale-and-grains/") + study, group, variant))
      by_seed[test["seed"]] = test["peak_stress_Pa"];
    return by_seed;
  };
  EXPECT_EQ(strengths("cored", pressed, "sides only"), strengths("rate", pressed, "= 1 1/s"));
  const auto flat_joints = strengths("sample", pulled, "");
  for (const auto& [seed, strength] : strengths("softening-0-um", pulled, ""))
    EXPECT_NEAR(strength, flat_joints.at(seed), 1e-9 * strength) << seed;
}

// The order of the stiffness is a theorem (9.6); of the strengths two of seventy pairs are the other way round.
TEST(SampleAndGrains, MinimalKinematicPeriodicAndAffineCellsAreOrdered)
{
  std::size_t n_compared = 0, n_in_order = 0;
  for (const auto& [way, last] : {std::pair("tension", 4), {"compression", 3}})
    for (int k = 0; k < last; ++k)
      {
        const char* const edges[] = {"12.5", "18", "25", "36"};
        const std::string study = fmt::format("multiscale-and-grains/boundaries-{}-{}-mm", way, edges[k]);
        std::map<std::string, std::map<int, std::pair<double, double>>> cells; // modulus and strength by seed
        for (const Json& rve : tests_of(study))
          cells[rve["boundary"]][rve["seed"]] = {
            rve["youngs_modulus_Pa"],
            way == std::string("tension") ? tensile_peak(rve) : -rve["lowest_stress"]["yy"]["stress_Pa"].get<double>()};
        for (const auto& [below, above] : {std::pair("minimal kinematic", "periodic"), {"periodic", "affine"}})
          for (const auto& [seed, one] : cells[below])
            {
              const auto& other = cells[above].at(seed);
              EXPECT_LE(one.first, other.first) << study << ", " << below << ", " << seed;
              n_in_order += one.second <= other.second;
              ++n_compared;
            }
      }
  EXPECT_EQ(n_compared, 70u);
  EXPECT_GE(n_in_order, 68u);
}

// A cell in tension is torn apart at every angle, as docs/multiscale-and-grains.md has it.
TEST(SampleAndGrains, TurnedCellsBearNothingAtTheEnd)
{
  const Json paths = results_of("multiscale-and-grains", "angles-tension")["after_peak"];
  EXPECT_EQ(paths.size(), 35u);
  for (const Json& path : paths)
    EXPECT_LT(path["stress_at_end_over_peak"].get<double>(), 0.08) << path["variant"];
}

// The line over 1/diameter by least squares through three sizes puts one more cylinder where it was found, within the standard
// deviation of such a prediction.
TEST(SampleAndGrains, ALargeCylinderHasTheStrengthThatSmallerOnesForetell)
{
  for (const char* const kind : {pulled, pressed})
    {
      std::vector<double> x, y;
      for (const auto& [study, diameter] : {std::pair("13.2", 13.2), {"20", 20.0}, {"33", 33.0}})
        for (const double peak :
             values_of(tests_of(fmt::format("multiscale-and-grains/cored-cylinder-{}-mm", study), kind)))
          {
            x.push_back(1.0 / diameter);
            y.push_back(peak);
          }
      double squares = 0.0, products = 0.0, errors = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k)
        {
          squares += std::pow(x[k] - mean(x), 2);
          products += (x[k] - mean(x)) * (y[k] - mean(y));
        }
      const auto line = [&](const double at) { return mean(y) + products / squares * (at - mean(x)); };
      for (std::size_t k = 0; k < x.size(); ++k)
        errors += std::pow(y[k] - line(x[k]), 2);
      const double n = double(x.size()), at = 1.0 / 50.0;
      const double deviation = std::sqrt(errors / (n - 2.0) * (1.0 + 1.0 / n + std::pow(at - mean(x), 2) / squares));
      EXPECT_NEAR(Mean({"multiscale-and-grains/cored-cylinder-50-mm", kind}).value(), line(at), deviation) << kind;
    }
}

// Energies balance on every mesh: the platens' work is what the RVEs store and lose and what the elements set free between
// cascades. Three meshes: the peak within 3 %, what follows it within 10 % where softening is scaled, and not where it is not.
// The work of the cylinder is left out: it falls in one avalanche, and one row of the curve before that is half of its work.
TEST(Study, WhatFollowsThePeakDoesNotDependOnTheMesh)
{
  const Json study = results_of("multiscale-beishan", "mesh-study");
  for (const std::string geometry : {"plane", "axisymmetric"})
    {
      std::vector<Json> runs; // the coarsest first, which both ways of softening share
      for (const Json& run : study["runs"])
        if (run["geometry"] == geometry)
          runs.push_back(run);
      ASSERT_EQ(runs.size(), 5u);
      for (const Json& run : runs)
        for (const Json& test : run["tests"])
          EXPECT_LT(test["energy_imbalance_over_work"].get<double>(), 2.5e-4) << geometry << run["elements"];
      for (const std::string softening : {"scaled", "as it is"})
        for (const char* const key : {"peak_stress_Pa", "work_after_peak_J_per_m2", "loss_after_peak_J_per_m2"})
          for (std::size_t k = 0; k < runs.front()["tests"].size(); ++k)
            {
              double largest = 0.0;
              for (std::size_t r = 1; r < runs.size(); ++r)
                if (runs[r]["softening"] == softening)
                  largest = std::max(largest, std::abs(runs[r]["tests"][k][key].get<double>() /
                                                         runs.front()["tests"][k][key].get<double>() -
                                                       1.0));
              const bool is_work_of_cylinder = geometry != "plane" && key == std::string("work_after_peak_J_per_m2");
              const bool is_within = largest < (key == std::string("peak_stress_Pa") ? 0.03 : 0.1);
              EXPECT_TRUE(is_work_of_cylinder ||
                          is_within == (softening == "scaled" || key == std::string("peak_stress_Pa")))
                << geometry << ", " << softening << ", " << key << ": " << largest;
            }
    }
}

Json benchmark(const std::string& name) { return json_of("benchmarks/results/" + name + ".json"); }

TEST(Benchmark, ALongRunKeepsItsStress)
{
  EXPECT_LE(benchmark("soak")["largest_deviation_from_mean"].get<double>(), 0.01);
}

// A program that is faster gives what it gave before, on any number of ranks, and what a killed run gives once it is resumed.
TEST(Benchmark, OfASpeedIsOfTheSameResults)
{
  for (const char* const file : {"whole-tests-avx2", "packings-avx512"})
    for (const char* const body : {"plane", "space"})
      {
        const Json test = benchmark(file)["tests"][body];
        EXPECT_EQ(test["old_peak_stress_Pa"], test["new_peak_stress_Pa"]) << file << ", " << body;
      }
  const Json by_coordination = results_of("beishan-granite", "ensemble-by-coordination");
  for (const std::string processor : {"avx2", "avx512"})
    {
      const Json samples = benchmark("whole-samples-" + processor)["tests"];
      for (const Json& test : samples)
        EXPECT_EQ(test["old_n_cracks"], test["new_n_cracks"]) << processor;
      const Json nine = benchmark("nine-tests-" + processor)["peak_stress_Pa"];
      EXPECT_EQ(nine.size(), 9u);
      for (const auto& [name, peak] : nine.items()) // instructions do not change a bit
        EXPECT_EQ(peak, test_of(by_coordination, name)["peak_stress_Pa"]) << name;
    }
  const Json runs = benchmark("many-ranks")["runs"];
  for (const Json& run : runs)
    EXPECT_TRUE(run["same_events"]);
  const Json kills = benchmark("kill-study")["kills"];
  EXPECT_EQ(kills.size(), 10u);
  for (const Json& kill : kills)
    for (const Json& resumed : kill["resumed"])
      {
        EXPECT_TRUE(resumed["same_events"]);
        EXPECT_LE(resumed["curve_difference"], 1e-8);
        EXPECT_LE(resumed["field_difference"], 1e-8);
      }
}
} // namespace
} // namespace feldspar::tests
