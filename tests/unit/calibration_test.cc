// The statistics of a calibration against closed forms, and the whole way from a design to a verdict on a rock whose law is
// known: no specimen is broken here.

#include "base/input_error.h"
#include "base/random.h"
#include "calibration/answer.h"
#include "calibration/fit.h"
#include "calibration/open_turns.h"
#include "calibration/responses.h"
#include "calibration/target_outcomes.h"
#include "dem/lab/protocols/protocols.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace feldspar::calibration
{
namespace
{
TEST(SobolPoints, FillTheCubeEvenlyAndFollowTheirSeed)
{
  const auto points = sobol_points(64, 4, 7);
  ASSERT_EQ(points.size(), 64u);
  for (std::size_t k = 0; k < 4; ++k)
    {
      double mean = 0.0;
      for (const UnitPoint& point : points)
        {
          EXPECT_GE(point[k], 0.0);
          EXPECT_LT(point[k], 1.0);
          mean += point[k] / 64.0;
        }
      // Two points at most fall into each 64th by the net and its shift: the mean is off by two of these at most. That of
      // random points has a standard deviation of 0.036.
      EXPECT_NEAR(mean, 0.5, 2.0 / 64.0);
    }
  EXPECT_EQ(points, sobol_points(64, 4, 7));
  EXPECT_NE(points, sobol_points(64, 4, 8));
}

TEST(SobolIndicesOfAFunction, AreThoseOfItsClosedForm)
{
  // Variances of x_0 + 2 x_1: 1/12 and 4/12. The variance of (x_0 - 1/2)(x_1 - 1/2) is all interaction. The estimator
  // of 2048 points has standard errors of some 0.02.
  const auto sum = sobol_indices([](const UnitPoint& x) { return x[0] + 2.0 * x[1]; }, 3, 2048, 1);
  EXPECT_NEAR(sum.first_order[0], 0.2, 0.06);
  EXPECT_NEAR(sum.first_order[1], 0.8, 0.06);
  EXPECT_NEAR(sum.total[2], 0.0, 0.06);
  const auto product = sobol_indices([](const UnitPoint& x) { return (x[0] - 0.5) * (x[1] - 0.5); }, 2, 2048, 1);
  EXPECT_NEAR(product.first_order[0], 0.0, 0.08);
  EXPECT_NEAR(product.total[0], 1.0, 0.08);
}

TEST(Surrogate, KnowsAFunctionOutOfNoisyValuesAndHowWell)
{
  const auto f = [](const UnitPoint& x) { return 0.5 * x[0] + 0.3 * std::sin(3.0 * x[1]) - 0.2 * x[2] * x[3]; };
  constexpr double noise = 0.02;
  double squared_error = 0.0;
  double squared_score = 0.0;
  std::size_t n = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    {
      Random random(seed, RandomStream::strengths);
      const auto points = sobol_points(32, 4, seed);
      std::vector<double> values;
      for (const UnitPoint& point : points)
        values.push_back(f(point) + random.normal(0.0, noise));
      const Surrogate surrogate(points, values, std::vector<double>(points.size(), noise * noise));
      for (const UnitPoint& point : sobol_points(32, 4, seed + 1000))
        {
          const double error = surrogate.mean(point) - f(point);
          squared_error += error * error;
          squared_score += std::pow(error / surrogate.deviation(point), 2);
          ++n;
        }
    }
  // The function's own standard deviation is 0.19: a surrogate that knew only its mean would have that error. One whose
  // deviations were those of values instead of the function, or ten times too small, would have scores of 0.5 or 10.
  EXPECT_LT(std::sqrt(squared_error / double(n)), 0.035);
  EXPECT_GT(std::sqrt(squared_score / double(n)), 0.6);
  EXPECT_LT(std::sqrt(squared_score / double(n)), 1.8);
}

TEST(Metropolis, DrawsFromANormalDistributionAndKeepsToItsBounds)
{
  // x_0 of variance 1, x_1 = x_0 + 0.1 of another; bounds cut x_0 at 0, which leaves a mean of sqrt(2/π).
  const auto samples =
    metropolis([](const auto& x) { return -0.5 * (x[0] * x[0] + std::pow((x[1] - x[0]) / 0.1, 2)); }, {0.0, -9.0},
               {9.0, 9.0}, {1.0, 1.0}, Eigen::MatrixXd{{1.0, 1.0}, {1.0, 1.01}}, 8000, 3);
  double mean = 0.0;
  double variance = 0.0;
  for (const auto& x : samples)
    {
      EXPECT_GE(x[0], 0.0);
      mean += x[0] / 8000.0;
      variance += std::pow(x[1] - x[0], 2) / 8000.0;
    }
  // 8000 samples of a thinned chain are worth some 1500 independent ones: standard errors of 0.016 and 4 %.
  EXPECT_NEAR(mean, std::sqrt(2.0 / M_PI), 0.06);
  EXPECT_NEAR(variance, 0.01, 0.0015);
}

/// Poisson's ratio of a plane network whose joints point equally in all directions, in affine strain: (κ - 1)/(3κ + 1). A
/// table of cells is about as curved.
double affine_poissons_ratio(const double ratio) { return (ratio - 1.0) / (3.0 * ratio + 1.0); }

ElasticTable affine_table()
{
  constexpr std::size_t n = 17;
  std::vector<double> ratios;
  std::vector<std::vector<ElasticTable::Constants>> constants(1);
  for (std::size_t k = 0; k < n; ++k)
    {
      ratios.push_back(std::pow(4.0, double(k) / double(n - 1)));
      constants[0].push_back({1.0, affine_poissons_ratio(ratios.back())});
    }
  return {ratios, {0.05}, constants};
}

TEST(ElasticTable, InterpolatesFinely)
{
  const ElasticTable table = affine_table();
  for (double ratio = 1.0; ratio <= 4.0; ratio += 0.01)
    // h²/8 of the second derivative over ln κ, which is 0.26 at most, with h = ln 4 / 16.
    EXPECT_NEAR(table.at(ratio, 0.05).poissons_ratio, affine_poissons_ratio(ratio), 2.5e-4);
  EXPECT_DOUBLE_EQ(table.range().first.poissons_ratio, 0.0);
  EXPECT_DOUBLE_EQ(table.range().second.poissons_ratio, 3.0 / 13.0);
}

/// A rock whose law is known: strengths over the bond strength are powers of the cohesion ratio, and friction matters to
/// the confined strength alone.
struct KnownRock
{
  CalibrationParameters wanted = [] {
    CalibrationParameters parameters;
    parameters.bond_friction_angle.reset();
    return parameters;
  }();
  std::vector<Response> all =
    responses(test_cases({direct_tension.kind, uniaxial_compression.kind, triaxial_compression.kind}, {20e6}), wanted);
  std::vector<Unknown> unknown = unknowns(wanted); // stiffness ratio, cohesion ratio, friction
  MicroParameters fixed{80e9, 22e6, 1.25, 18.0, 0.17, 0.5, std::nullopt};

  std::size_t number(const std::string& name) const
  {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Response& one) { return one.name == name; });
    return std::size_t(found - all.begin());
  }

  /// Values of the responses without scatter [SI].
  std::vector<std::optional<double>> truth(const MicroParameters& p) const
  {
    std::vector<std::optional<double>> values(all.size());
    values[number("youngs_modulus")] = 0.9 * p.modulus * std::pow(p.cohesion_ratio / 12.0, 0.05);
    values[number("poissons_ratio")] = affine_poissons_ratio(p.stiffness_ratio) + 0.02;
    values[number("tensile_strength")] = 0.45 * p.bond_tensile_strength * std::pow(p.cohesion_ratio / 12.0, 0.1);
    values[number("uniaxial_compressive_strength")] =
      7.0 * p.bond_tensile_strength * std::pow(p.cohesion_ratio / 12.0, 0.6);
    values[number("strength_at_20_MPa")] =
      12.0 * p.bond_tensile_strength * std::pow(p.cohesion_ratio / 12.0, 0.5) * std::exp(0.5 * (p.friction - 0.7));
    return values;
  }

  /// With what belongs to the packing, and what belongs to the test.
  TestedPoint test(const std::string& stage, const std::size_t n, const std::uint64_t seed, const UnitPoint& point,
                   const MicroParameters& p) const
  {
    TestedPoint tested{stage, n, seed, point, p, truth(p)};
    Random of_packing(seed, RandomStream::radii);
    Random of_test(seed + 1000 * (n + 1) + 77 * stage.size(), RandomStream::strengths);
    for (std::size_t j = 0; j < all.size(); ++j)
      {
        const bool is_strength = all[j].scale == ResponseScale::strength;
        const double scatter =
          of_packing.normal(0.0, is_strength ? 0.05 : 0.01) + of_test.normal(0.0, is_strength ? 0.04 : 0.005);
        if (tested.values[j])
          tested.values[j] = all[j].in_si(all[j].in_model(*tested.values[j]) +
                                          scatter * (all[j].scale == ResponseScale::none ? 0.1 : 1.0));
      }
    return tested;
  }

  ResponseModel learnt() const
  {
    ResponseModel model(all, unknown, fixed, affine_table(), 0.05);
    std::vector<TestedPoint> design;
    const auto points = sobol_points(24, unknown.size(), 1);
    for (std::size_t i = 0; i < points.size(); ++i)
      for (const std::uint64_t seed : {1u, 2u})
        design.push_back(test("design", i, seed, points[i], parameters_at(points[i], unknown, fixed)));
    model.learn(design);
    return model;
  }

  std::vector<Target> targets_of(const MicroParameters& hidden, const std::vector<std::string>& names) const
  {
    std::vector<Target> targets;
    const auto values = truth(hidden);
    for (const std::string& name : names)
      targets.push_back({number(name), *values[number(name)], 0.01 * *values[number(name)], ""});
    return targets;
  }
};

const std::vector<std::string> three_tests{"youngs_modulus", "poissons_ratio", "tensile_strength",
                                           "uniaxial_compressive_strength"};

TEST(ResponseModel, LearnsTheLawAndIsCorrectedByPackings)
{
  const KnownRock rock;
  ResponseModel model = rock.learnt();
  const std::size_t strength = rock.number("uniaxial_compressive_strength");
  EXPECT_NEAR(model.learnt(strength).noise, 0.04, 0.012); // by 23 degrees of freedom: 15 %
  const Place place{{0.3, 0.6, 0.5}, std::log(75e9), std::log(20e6)};
  std::vector<TestedPoint> tests;
  for (std::uint64_t seed = 11; seed < 51; ++seed)
    tests.push_back(rock.test("step", 0, seed, place.point, model.parameters(place)));
  model.correct(tests);
  const double truth = *rock.truth(model.parameters(place))[strength];
  // 40 packings of a scatter of 0.064: a standard error of 0.01.
  EXPECT_NEAR(model.predict(strength, place), std::log(truth), 0.03);
  EXPECT_NEAR(*model.learnt(strength).scatter, std::hypot(0.05, 0.04), 0.02);
  EXPECT_FALSE(model.knows(rock.number("crack_damage_stress"))) << "no value of it was ever given";
}

TEST(BestFit, ReachesItsTargetsAndLeavesTheRestInTheMiddle)
{
  const KnownRock rock;
  const ResponseModel model = rock.learnt();
  MicroParameters hidden = rock.fixed;
  hidden.stiffness_ratio = 2.0;
  hidden.cohesion_ratio = 15.0;
  const auto targets = rock.targets_of(hidden, three_tests);
  const Place start{{0.5, 0.5, 0.5}, std::log(60e9), std::log(15e6)};
  const Fit fit = best_fit(model, targets, 0.03, {true, true, {0.5, 0.5, 0.5}, 0.5}, start);
  for (const double deviation : fit.deviations)
    EXPECT_NEAR(deviation, 0.0, 0.01);
  EXPECT_NEAR(fit.place.point[2], 0.5, 0.1) << "friction has no part in these tests";
  // Contradiction: a tenfold tension at the same compression. Nothing is reached then, and the fit says so.
  auto contradiction = targets;
  contradiction[2].value *= 10.0;
  const Fit none = best_fit(model, contradiction, 0.03, {true, true, {0.5, 0.5, 0.5}, 0.5}, start);
  EXPECT_GT(std::sqrt(none.misfit), 10.0);
  // Nothing is nearer, here at a corner of the bounds: compared with other ratios, each with the best scales for it.
  const auto cost = [&](const Place& place) {
    double sum = 0.0;
    for (const Target& target : contradiction)
      {
        const Response& response = model.response(target.response);
        const double width =
          std::hypot(0.03 * response.per_share(target.value), model.deviation(target.response, start.point));
        sum += std::pow((model.predict(target.response, place) - response.in_model(target.value)) / width, 2);
      }
    for (const double x : place.point)
      sum += 0.01 * (x - 0.5) * (x - 0.5);
    return sum;
  };
  const double nearest = cost(none.place);
  constexpr double held = 1e-9; // the ratios stay
  for (const UnitPoint& point : sobol_points(200, 3, 7))
    EXPECT_GT(cost(best_fit(model, contradiction, 0.03, {true, true, point, held}, start).place),
              nearest * (1.0 - 1e-6));
  EXPECT_TRUE(std::any_of(none.place.point.begin(), none.place.point.end(),
                          [](const double x) { return x < 1e-6 || x > 1.0 - 1e-6; }));
  // Stiffness has a scale of its own, which no strength contradicts.
  ASSERT_EQ(model.response(contradiction[0].response).scale, ResponseScale::modulus);
  EXPECT_NEAR(none.deviations[0], 0.0, 1e-9); // round-off
}

// The claim of the whole: hidden sets of parameters are found again, or said not to be determined. Nine of ten intervals of
// 90 % should hold the truth; of ten, seven or fewer happen once in fourteen times, and with these seeds it does not.
TEST(Posterior, HoldsHiddenParametersAndKnowsWhatItDoesNotKnow)
{
  const KnownRock rock;
  std::size_t n_held_strength = 0;
  std::size_t n_held_cohesion = 0;
  std::size_t n_held_friction = 0;
  const auto hidden_points = sobol_points(10, 3, 99);
  const ResponseModel of_design = rock.learnt();
  for (std::size_t k = 0; k < hidden_points.size(); ++k)
    {
      const MicroParameters hidden = parameters_at(hidden_points[k], rock.unknown, rock.fixed);
      const auto targets = rock.targets_of(hidden, three_tests);
      ResponseModel model = of_design;
      const FitFreedom freedom{true, true, {0.5, 0.5, 0.5}, 0.5};
      Fit fit = best_fit(model, targets, 0.03, freedom, {{0.5, 0.5, 0.5}, std::log(60e9), std::log(15e6)});
      std::vector<TestedPoint> tests;
      for (std::uint64_t seed = 100 * (k + 1); seed < 100 * (k + 1) + 12; ++seed)
        tests.push_back(rock.test("answer", 0, seed, fit.place.point, model.parameters(fit.place)));
      model.correct(tests);
      fit = best_fit(model, targets, 0.03, freedom, fit.place);
      const Posterior found = posterior(model, targets, freedom, fit.place, 1000, 5);
      for (const ParameterAnswer& answer : found.parameters)
        {
          const auto holds = [&](const double truth) { return answer.lower_90 <= truth && truth <= answer.upper_90; };
          if (answer.name == "bond_tensile_strength")
            {
              n_held_strength += holds(hidden.bond_tensile_strength);
              EXPECT_EQ(answer.verdict, Determination::determined) << answer.sentence;
            }
          if (answer.name == "bond_cohesion")
            n_held_cohesion += holds(hidden.cohesion_ratio * hidden.bond_tensile_strength);
          if (answer.name == "friction")
            {
              n_held_friction += holds(hidden.friction);
              EXPECT_EQ(answer.verdict, Determination::not_determined) << answer.sentence;
              // The one response that friction has a part in.
              EXPECT_EQ(answer.helpful_test, "strength_at_20_MPa") << answer.sentence;
            }
        }
    }
  EXPECT_GE(n_held_strength, 8u);
  EXPECT_GE(n_held_cohesion, 8u);
  EXPECT_GE(n_held_friction, 8u);
}

TEST(TargetOutcomes, AreNearlyMetWithinHalfOfTheTolerance)
{
  const auto of_values = [](const std::vector<double>& values) {
    return TargetOutcome{{0, 100.0, 3.0, ""}, statistics(values), 100.0};
  };
  EXPECT_FALSE(is_nearly_met(of_values({101.9, 102.1}), 0.03)) << "half of the tolerance is left for others";
  EXPECT_TRUE(is_nearly_met(of_values({101.3, 101.5}), 0.03));
}

// Scatter by the design of the known rock: 5 % of a packing and 4 % of a test are 6.4 % of a strength, by two packings.
// The part that the tests of a packing have in common has one degree of freedom, so that a scatter between 4 and 11 %
// is all that can be asked.
TEST(ResponseModel, TellsTheScatterOfASpecimenByItsDesign)
{
  const KnownRock rock;
  const ResponseModel model = rock.learnt();
  const double scatter = *model.learnt(rock.number("uniaxial_compressive_strength")).scatter_of_design;
  EXPECT_GT(scatter, 0.04);
  EXPECT_LT(scatter, 0.11);
  EXPECT_FALSE(ResponseModel(rock.all, rock.unknown, rock.fixed, affine_table(), 0.05).learnt(0).scatter_of_design);
}

FinishedTest crushed(const TestKind& kind, const double confining_pressure, const double strength)
{
  FinishedTest test;
  test.record.kind = kind;
  test.record.confining_pressure = confining_pressure;
  test.results.peak_stress = {strength, ""};
  return test;
}

TEST(Responses, GiveTheRockConstantOfHoekAndBrown)
{
  // Strength of a specimen with a uniaxial strength of 160 MPa and m_i = 25: 20 + sqrt(25 * 160 * 20 + 160^2) at 20
  // MPa.
  const KnownRock rock;
  const Response& response = rock.all[rock.number("m_i")];
  const double at_20 = 20e6 + std::sqrt(25.0 * 160e6 * 20e6 + 160e6 * 160e6);
  const std::vector<FinishedTest> of_specimen{crushed(uniaxial_compression.kind, 0.0, 160e6),
                                              crushed(triaxial_compression.kind, 20e6, at_20)};
  EXPECT_NEAR(*response.value(of_specimen), 25.0, 1e-4);
  EXPECT_FALSE(response.value({of_specimen[0]})) << "no confined test";
  EXPECT_FALSE(response.value({of_specimen[1]})) << "no uniaxial test";
  EXPECT_FALSE(response.value({of_specimen[0], crushed(triaxial_compression.kind, 20e6, 178e6)}))
    << "the deviator falls with the pressure: no m_i";
  // m_i goes with no scale: a rock of twice the bond strength has twice the strengths and the same m_i under twice the
  // pressure.
  EXPECT_EQ(response.scale, ResponseScale::ratio);
  EXPECT_NEAR(response.in_model(*response.value(of_specimen)), std::log(25.0), 1e-5);
  const CalibrationParameters wanted;
  for (const Response& one : responses(test_cases({triaxial_compression.kind}, {20e6}), wanted))
    EXPECT_NE(one.name, "m_i") << "without a uniaxial test there is none";
}

TEST(Targets, AreThoseThatTheTestsGiveWithTheDeviationOfTheRocksMean)
{
  const KnownRock rock;
  Reference reference;
  reference.experiment.values["uniaxial_compressive_strength_MPa"] = {200.0, 150.0, 250.0, 22.0, 4u};
  reference.experiment.values["tensile_strength_MPa"] = {9.0, 7.0, 11.0};
  reference.experiment.values["youngs_modulus_GPa"] = {69.0, std::nullopt, std::nullopt};
  reference.experiment.values["brazilian_strength_MPa"] = {10.0, std::nullopt, std::nullopt}; // no such test is made
  const auto found = targets(rock.all, reference, rock.wanted);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(rock.all[found[0].response].name, "tensile_strength");
  EXPECT_DOUBLE_EQ(found[0].deviation, 1e6); // a quarter of the range
  EXPECT_EQ(rock.all[found[1].response].name, "youngs_modulus");
  EXPECT_DOUBLE_EQ(found[1].deviation, 0.03 * 69e9); // the tolerance
  EXPECT_DOUBLE_EQ(found[2].deviation, 11e6);        // 22 / sqrt(4)
  CalibrationParameters named = rock.wanted;
  named.targets = {"brazilian_strength"};
  EXPECT_THROW(targets(rock.all, reference, named), InputError);
  named.targets = {"poissons_ratio"};
  EXPECT_THROW(targets(rock.all, reference, named), InputError);
}
} // namespace
} // namespace feldspar::calibration
