// Hoek-Brown and Mohr-Coulomb envelopes: compression positive, as in report/fit.h.

#include "base/random.h"
#include "results/fits/strength_envelopes.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace feldspar
{
namespace
{
using tests::has;

constexpr double MPa = 1e6;

struct HoekBrown
{
  double sigma_ci;
  double m;
  double s;
  double a;

  double sigma_1(const double sigma_3) const { return sigma_3 + sigma_ci * std::pow(m * sigma_3 / sigma_ci + s, a); }

  double uniaxial_compressive_strength() const { return sigma_ci * std::pow(s, a); }

  /// sigma_t with sigma_1(-sigma_t) = 0, by bisection: at -sigma_t the envelope falls below zero before its cut-off.
  double tensile_strength() const
  {
    double low = 0.0;
    double high = s * sigma_ci / m;
    for (int i = 0; i < 200; ++i)
      {
        const double middle = 0.5 * (low + high);
        (sigma_1(-middle) > 0.0 ? low : high) = middle;
      }
    return 0.5 * (low + high);
  }
};

struct SyntheticCase
{
  HoekBrownForm form;
  bool with_tension_point;
  HoekBrown truth;
};

void PrintTo(const SyntheticCase& one, std::ostream* out)
{
  *out << name(one.form) << (one.with_tension_point ? " with" : " without") << " tension point";
}

/// The programme of the paper, twice as dense at low confinement.
const std::vector<double> confinements = {0.0,      2.5 * MPa, 5 * MPa,  10 * MPa, 20 * MPa,
                                          30 * MPa, 40 * MPa,  50 * MPa, 60 * MPa};

/// Points of the envelope with normal noise in sigma_1; the measured strengths are the envelope's own.
StrengthData synthetic(const SyntheticCase& one, const double noise, const std::uint64_t seed)
{
  Random random(seed, RandomStream::strengths);
  StrengthData data;
  for (const double sigma_3 : confinements)
    data.points.push_back({sigma_3, random.normal(one.truth.sigma_1(sigma_3), noise)});
  data.uniaxial_compressive_strength =
    one.form == HoekBrownForm::as_paper ? one.truth.sigma_ci : one.truth.uniaxial_compressive_strength();
  if (one.with_tension_point)
    data.tensile_strength = one.truth.tensile_strength();
  return data;
}

class SyntheticPoints : public testing::TestWithParam<SyntheticCase>
{
};

TEST_P(SyntheticPoints, GiveTheirParametersBack)
{
  // Exact points have a residual of zero; the solver stops when a step changes the variables by less than 1e-12 of
  // their size, and m and a are correlated to one part in a thousand.
  const auto& one = GetParam();
  const auto answer = fit_hoek_brown(synthetic(one, 0.0, 1), one.form, one.with_tension_point);
  ASSERT_TRUE(answer.fit) << answer.reason;
  const auto& fit = *answer.fit;
  EXPECT_NEAR(fit.sigma_ci.value, one.truth.sigma_ci, 1e-6 * one.truth.sigma_ci);
  EXPECT_NEAR(fit.m.value, one.truth.m, 1e-6 * one.truth.m);
  EXPECT_NEAR(fit.s.value, one.truth.s, 1e-6 * one.truth.s);
  EXPECT_NEAR(fit.a.value, one.truth.a, 1e-6 * one.truth.a);
  EXPECT_NEAR(fit.uniaxial_compressive_strength.value, one.truth.uniaxial_compressive_strength(), 1.0);
  EXPECT_NEAR(fit.tensile_cut_off.value, -one.truth.s * one.truth.sigma_ci / one.truth.m, 1e2);
  EXPECT_NEAR(*fit.quality.r_squared.value, 1.0, 1e-12);
  EXPECT_LT(fit.quality.root_mean_square, 1.0);
  EXPECT_EQ(fit.quality.residuals.size(), confinements.size() + (one.with_tension_point ? 1 : 0));
  EXPECT_EQ(fit.with_tension_point, one.with_tension_point);
}

TEST_P(SyntheticPoints, WithNoiseLieInTheirConfidenceIntervals)
{
  // 95 % of 200 draws with a standard error of 1.5 %: from 90 to 98 % for every free parameter (5000 draws give 94.5 to
  // 96.7 %). The noise, 2 % of the strength, is small enough for the intervals, which are those of the linearised
  // envelope. The tension point has sigma_1 = 0 by definition and so no noise; the envelope all but goes through it,
  // which spends the degree of freedom that the point brings.
  const auto& one = GetParam();
  constexpr int n_draws = 200;
  std::array<int, 4> inside{};
  for (int draw = 0; draw < n_draws; ++draw)
    {
      const auto answer =
        fit_hoek_brown(synthetic(one, 3.0 * MPa, std::uint64_t(draw) + 1), one.form, one.with_tension_point);
      ASSERT_TRUE(answer.fit) << answer.reason;
      const auto& fit = *answer.fit;
      const std::array<Estimate, 4> estimates{fit.sigma_ci, fit.m, fit.s, fit.a};
      const std::array<double, 4> truths{one.truth.sigma_ci, one.truth.m, one.truth.s, one.truth.a};
      for (std::size_t i = 0; i < estimates.size(); ++i)
        if (const auto half_width = estimates[i].half_width.value)
          inside[i] += std::abs(estimates[i].value - truths[i]) <= *half_width;
    }
  const bool as_paper = one.form == HoekBrownForm::as_paper;
  const std::array<bool, 4> is_free{!as_paper, true, as_paper, one.form != HoekBrownForm::intact};
  const std::array<const char*, 4> names{"sigma_ci", "m", "s", "a"};
  for (std::size_t i = 0; i < inside.size(); ++i)
    {
      SCOPED_TRACE(names[i]);
      if (is_free[i])
        {
          EXPECT_GE(inside[i], 0.90 * n_draws);
          EXPECT_LE(inside[i], 0.98 * n_draws);
        }
      else
        EXPECT_EQ(inside[i], 0);
    }
}

INSTANTIATE_TEST_SUITE_P(EveryForm, SyntheticPoints,
                         testing::Values(SyntheticCase{HoekBrownForm::as_paper, true, {150 * MPa, 25.0, 1.2, 0.45}},
                                         SyntheticCase{HoekBrownForm::as_paper, false, {150 * MPa, 25.0, 0.9, 0.45}},
                                         SyntheticCase{HoekBrownForm::intact, true, {160 * MPa, 15.0, 1.0, 0.5}},
                                         SyntheticCase{HoekBrownForm::intact, false, {160 * MPa, 15.0, 1.0, 0.5}},
                                         SyntheticCase{HoekBrownForm::general, true, {160 * MPa, 20.0, 1.0, 0.42}},
                                         SyntheticCase{HoekBrownForm::general, false, {160 * MPa, 20.0, 1.0, 0.42}}));

/// Strengths that an independent program with the same law gives for this rock.
StrengthData independent_program(const double tensile_strength)
{
  StrengthData data{{{0, 156}, {5, 255}, {10, 313}, {20, 384}, {30, 435}, {40, 463}, {50, 493}, {60, 523}},
                    156 * MPa,
                    tensile_strength};
  for (auto& [sigma_3, sigma_1] : data.points)
    {
      sigma_3 *= MPa;
      sigma_1 *= MPa;
    }
  return data;
}

TEST(IndependentProgram, GivesTheFiguresOfThePhysics)
{
  // Stated: m about 32, s about 1.84, a about 0.42, for a sigma_t of about 9.5 MPa; without the tension point s = 0.97,
  // a = 0.25. Tolerance: half a unit of the last digit, but 6 % for s. The envelope goes through the tension point, so
  // that s is very nearly m sigma_t/sigma_ci, 1.95 for the stated m: s = 1.84 would leave that point beyond the
  // envelope's end. These points give s = 1.94 for every sigma_t from 8.6 to 10.9 MPa (a search of the whole grid of
  // m, a and the bracket finds no better).
  const auto with = *fit_hoek_brown(independent_program(9.5 * MPa), HoekBrownForm::as_paper, true).fit;
  EXPECT_NEAR(with.m.value, 32.0, 0.5);
  EXPECT_NEAR(with.s.value, 1.84, 0.06 * 1.84);
  EXPECT_NEAR(with.a.value, 0.42, 0.01);
  EXPECT_NEAR(with.s.value, with.m.value * 9.5 / 156.0, 0.005);
  EXPECT_GT(with.uniaxial_compressive_strength.value, 1.3 * 156 * MPa);

  const auto without = *fit_hoek_brown(independent_program(9.5 * MPa), HoekBrownForm::as_paper, false).fit;
  EXPECT_NEAR(without.s.value, 0.97, 0.005);
  EXPECT_NEAR(without.a.value, 0.25, 0.005);
}

TEST(IndependentProgram, HasNoBetterEnvelopeNearby)
{
  // The optimum against the definition alone: no step of 1 % in one parameter has smaller squares.
  for (const bool with_tension_point : {true, false})
    {
      const auto fit = *fit_hoek_brown(independent_program(9.5 * MPa), HoekBrownForm::as_paper, with_tension_point).fit;
      const auto squares = [&](const HoekBrown& envelope) {
        double sum = 0.0;
        for (const auto& [point, residual] : fit.quality.residuals)
          sum += std::pow((point.sigma_1 - envelope.sigma_1(point.sigma_3)) / MPa, 2.0);
        return sum;
      };
      const HoekBrown best{fit.sigma_ci.value, fit.m.value, fit.s.value, fit.a.value};
      const double least = squares(best);
      EXPECT_NEAR(std::sqrt(least / double(fit.quality.residuals.size())), fit.quality.root_mean_square / MPa, 1e-9);
      for (const double factor : {0.99, 1.01})
        {
          EXPECT_GT(squares({best.sigma_ci, best.m, best.s, best.a * factor}), least);
          // m and s together: alone, either may leave the tension point outside the envelope.
          EXPECT_GT(squares({best.sigma_ci, best.m * factor, best.s * factor, best.a}), least);
          if (!with_tension_point)
            {
              EXPECT_GT(squares({best.sigma_ci, best.m * factor, best.s, best.a}), least);
              EXPECT_GT(squares({best.sigma_ci, best.m, best.s * factor, best.a}), least);
            }
        }
    }
}

TEST(HoekBrown, HoeksRegressionIsThatOfItsSums)
{
  // Hoek and Brown (1980), with x = σ_3 and y = (σ_1 - σ_3)²:
  // σ_ci² = Σy/n - N Σx/n and m = N/σ_ci, N = (Σxy - Σx Σy/n)/(Σx² - (Σx)²/n).
  const auto data = independent_program(9.5 * MPa);
  double x = 0.0, y = 0.0, xy = 0.0, xx = 0.0;
  for (const auto& [sigma_3, sigma_1] : data.points)
    {
      const double square = std::pow((sigma_1 - sigma_3) / MPa, 2);
      x += sigma_3 / MPa;
      y += square;
      xy += sigma_3 / MPa * square;
      xx += std::pow(sigma_3 / MPa, 2);
    }
  const auto n = double(data.points.size());
  const double slope = (xy - x * y / n) / (xx - x * x / n);
  const double sigma_ci = std::sqrt(y / n - slope * x / n);
  const auto envelopes = fit_strength_envelopes(data);
  ASSERT_TRUE(envelopes.fit(HoekBrownForm::regressed, false));
  const auto& fit = *envelopes.fit(HoekBrownForm::regressed, false);
  EXPECT_NEAR(fit.sigma_ci.value, sigma_ci * MPa, 1e-9 * fit.sigma_ci.value);
  EXPECT_NEAR(fit.m.value, slope / sigma_ci, 1e-9 * fit.m.value);
  EXPECT_NEAR(fit.sigma_1(10 * MPa), (10.0 + std::sqrt(slope * 10.0 + sigma_ci * sigma_ci)) * MPa, 1.0);
  EXPECT_GT(*fit.m.half_width.value, 0.0);
  // The regression weighs the strong points most: another m than least squares in σ_1, whose squares are the least.
  const auto least = *fit_hoek_brown(data, HoekBrownForm::intact, false).fit;
  EXPECT_GT(std::abs(fit.m.value / least.m.value - 1.0), 0.01);
  EXPECT_GT(fit.quality.root_mean_square, least.quality.root_mean_square);
  const std::string text = as_text(envelopes);
  const std::size_t row = text.find("\nintact, regression");
  ASSERT_NE(row, std::string::npos) << text;
  EXPECT_TRUE(
    has(text.substr(row + 1, text.find('\n', row + 1) - row), fmt::format(" {:.1f} ±", fit.sigma_ci.value / MPa)));

  // Points of the criterion itself have one m.
  StrengthData exact;
  for (const double sigma_3 : {-5.0, 0.0, 10.0, 40.0})
    exact.points.push_back({sigma_3 * MPa, (sigma_3 + 100.0 * std::sqrt(12.0 * sigma_3 / 100.0 + 1.0)) * MPa});
  EXPECT_NEAR(regress_hoek_brown(exact).fit->m.value, 12.0, 1e-9);
  EXPECT_NEAR(fit_hoek_brown(exact, HoekBrownForm::intact, false).fit->m.value, 12.0, 1e-4);

  StrengthData weaker; // under confinement
  weaker.points = {{0.0, 100 * MPa}, {10 * MPa, 90 * MPa}};
  EXPECT_TRUE(has(regress_hoek_brown(weaker).reason, "both must be above 0"));
}

TEST(HoekBrown, ConstantsOfARockMassAreThoseOfHoekAndOthers)
{
  // Hoek, Carranza-Torres and Corkum (2002), the example of a tunnel: m_i = 10, GSI = 45, D = 0 give m_b = 1.4, s = 0.0022 and
  // a = 0.508; undisturbed intact rock has its own constants.
  const auto mass = rock_mass_constants(10.0, 45.0, 0.0);
  EXPECT_NEAR(mass.m, 1.40, 0.005);
  EXPECT_NEAR(mass.s, 0.0022, 0.00005);
  EXPECT_NEAR(mass.a, 0.508, 0.0005);
  const auto intact = rock_mass_constants(10.0, 100.0, 1.0);
  EXPECT_EQ(intact.m, 10.0);
  EXPECT_EQ(intact.s, 1.0);
  EXPECT_NEAR(intact.a, 0.5, 1e-15);
  // Disturbance halves the scale of m and takes a third off that of s.
  EXPECT_NEAR(rock_mass_constants(10.0, 45.0, 1.0).m, 10.0 * std::exp(-55.0 / 14.0), 1e-12);
  EXPECT_NEAR(rock_mass_constants(10.0, 45.0, 1.0).s, std::exp(-55.0 / 6.0), 1e-12);
}

TEST(HoekBrown, PaperAndGeneralFormAreOneCurve)
{
  // sigma_ci (m x/sigma_ci + s)^a = sigma_ci' (m' x/sigma_ci' + 1)^a with sigma_ci' = sigma_ci s^a, m' = m s^(a-1).
  for (const bool with_tension_point : {true, false})
    {
      const auto data = independent_program(9.5 * MPa);
      const auto paper = *fit_hoek_brown(data, HoekBrownForm::as_paper, with_tension_point).fit;
      const auto general = *fit_hoek_brown(data, HoekBrownForm::general, with_tension_point).fit;
      EXPECT_NEAR(general.a.value, paper.a.value, 1e-5);
      EXPECT_NEAR(general.sigma_ci.value, paper.uniaxial_compressive_strength.value, 1e-5 * general.sigma_ci.value);
      EXPECT_NEAR(general.m.value, paper.m.value * std::pow(paper.s.value, paper.a.value - 1.0),
                  1e-4 * general.m.value);
      EXPECT_NEAR(general.quality.root_mean_square, paper.quality.root_mean_square, 1.0);
    }
}

TEST(HoekBrown, StaysAdmissibleAtTheTensionPoint)
{
  // Points that would rather have a small tensile strength than the measured one.
  for (const double tensile_strength : {1.0 * MPa, 9.5 * MPa, 60.0 * MPa})
    for (const auto form : {HoekBrownForm::as_paper, HoekBrownForm::intact, HoekBrownForm::general})
      {
        const auto answer = fit_hoek_brown(independent_program(tensile_strength), form, true);
        ASSERT_TRUE(answer.fit) << answer.reason;
        const auto& fit = *answer.fit;
        EXPECT_GT(fit.m.value, 0.0);
        EXPECT_GT(fit.s.value, 0.0);
        EXPECT_GE(fit.a.value, 0.05);
        EXPECT_LE(fit.a.value, 1.0);
        // Round-off of the bracket, a difference of numbers of order one.
        EXPECT_GE(-fit.m.value * tensile_strength / fit.sigma_ci.value + fit.s.value, -1e-14);
        EXPECT_LE(fit.tensile_cut_off.value, -tensile_strength * (1.0 - 1e-14));
        EXPECT_TRUE(std::isnan(fit.sigma_1(1.01 * fit.tensile_cut_off.value)));
      }
}

TEST(HoekBrown, ParameterOnItsBoundHasNoInterval)
{
  // sigma_1 that curves upwards wants a > 1.
  StrengthData data;
  for (const double x : {0.0, 10.0, 20.0, 30.0, 40.0})
    data.points.push_back({x * MPa, (100.0 + 4.0 * x + 0.02 * x * x) * MPa});
  data.uniaxial_compressive_strength = 100 * MPa;
  const auto answer = fit_hoek_brown(data, HoekBrownForm::as_paper, false);
  ASSERT_TRUE(answer.fit) << answer.reason;
  EXPECT_NEAR(answer.fit->a.value, 1.0, 1e-7);
  EXPECT_FALSE(answer.fit->a.half_width.value);
  EXPECT_TRUE(has(answer.fit->a.half_width.reason, "bound"));
  // The others have theirs, with a held: at a = 1 the envelope is the line of Mohr and Coulomb, m = N_phi - 1.
  const auto line = *fit_mohr_coulomb(data).fit;
  EXPECT_NEAR(answer.fit->m.value, line.slope.value - 1.0, 1e-6);
  ASSERT_TRUE(answer.fit->m.half_width.value);
  EXPECT_GT(*answer.fit->m.half_width.value, 0.0);
}

TEST(HoekBrown, AsManyPointsAsParametersGiveNoInterval)
{
  auto data = independent_program(9.5 * MPa);
  data.points.resize(3);
  const auto answer = fit_hoek_brown(data, HoekBrownForm::general, false);
  ASSERT_TRUE(answer.fit) << answer.reason;
  EXPECT_LT(answer.fit->quality.root_mean_square, 1.0); // three points, three parameters
  EXPECT_EQ(answer.fit->quality.degrees_of_freedom, 0);
  EXPECT_FALSE(answer.fit->quality.r_squared.value); // it would be 1 of any points
  for (const auto& estimate : {answer.fit->sigma_ci, answer.fit->m, answer.fit->a})
    {
      EXPECT_FALSE(estimate.half_width.value);
      EXPECT_TRUE(has(estimate.half_width.reason, "no more points than parameters"));
    }
}

struct RefusedCase
{
  std::string what;
  StrengthData data;
  std::string words; ///< that the reason must have
};

void PrintTo(const RefusedCase& one, std::ostream* out) { *out << one.what; }

class RefusedData : public testing::TestWithParam<RefusedCase>
{
};

TEST_P(RefusedData, GivesASentence)
{
  const auto& one = GetParam();
  const auto answer = fit_hoek_brown(one.data, HoekBrownForm::as_paper, true);
  EXPECT_FALSE(answer.fit);
  EXPECT_TRUE(has(answer.reason, one.words));
  // Nothing of it may break what prints or writes all fits.
  const auto envelopes = fit_strength_envelopes(one.data);
  EXPECT_FALSE(as_text(envelopes).empty());
  EXPECT_EQ(records(envelopes).size(), 8U);
}

StrengthData changed(void (*change)(StrengthData&))
{
  auto data = independent_program(9.5 * MPa);
  change(data);
  return data;
}

INSTANTIATE_TEST_SUITE_P(
  TooLittleDegenerateOrNoNumber, RefusedData,
  testing::Values(
    RefusedCase{"nothing measured", {}, "none was measured"},
    RefusedCase{"no tension", changed([](StrengthData& data) { data.tensile_strength.reset(); }),
                "no tensile strength"},
    RefusedCase{"two points with tension", changed([](StrengthData& data) { data.points.resize(1); }), "there are 2"},
    RefusedCase{"one confinement", changed([](StrengthData& data) {
                  for (auto& point : data.points)
                    point = {10 * MPa, 300 * MPa};
                }),
                "different sigma_3"},
    RefusedCase{"not a number",
                changed([](StrengthData& data) { data.points[2].sigma_1 = std::numeric_limits<double>::quiet_NaN(); }),
                "not a finite number"},
    RefusedCase{"infinite confinement",
                changed([](StrengthData& data) { data.points[2].sigma_3 = std::numeric_limits<double>::infinity(); }),
                "not a finite number"},
    RefusedCase{"negative uniaxial strength",
                changed([](StrengthData& data) { data.uniaxial_compressive_strength = -156 * MPa; }),
                "must be a positive number"},
    RefusedCase{"tensile strength of zero", changed([](StrengthData& data) { data.tensile_strength = 0.0; }),
                "must be a positive number"},
    RefusedCase{"weaker than its confinement", changed([](StrengthData& data) { data.points[3].sigma_1 = 10 * MPa; }),
                "lies below sigma_3"}));

TEST(HoekBrown, PublishedTriaxialDataGiveTheirSourcesParameters)
{
  // E. Hoek and E. T. Brown, Practical estimates of rock mass strength, Int. J. Rock Mech. Min. Sci. 34 (1997)
  // 1165-1186, the worked example of triaxial tests on intact rock [MPa]: sigma_ci 37.4 MPa, m_i 15.50, r² 0.997.
  const std::array<EnvelopePoint, 5> tests{{{0.0, 38.3}, {5.0, 72.4}, {7.5, 80.5}, {15.0, 115.6}, {20.0, 134.3}}};

  // The source fits a straight line to (sigma_1 - sigma_3)² = m_i sigma_ci sigma_3 + sigma_ci². With that residual the
  // points give its figures to their last digits, so the points are those of the source.
  double mean_x = 0.0;
  double mean_y = 0.0;
  const auto square = [](const EnvelopePoint& point) { return std::pow(point.sigma_1 - point.sigma_3, 2.0); };
  for (const auto& point : tests)
    {
      mean_x += point.sigma_3 / double(tests.size());
      mean_y += square(point) / double(tests.size());
    }
  double xx = 0.0;
  double xy = 0.0;
  for (const auto& point : tests)
    {
      xx += (point.sigma_3 - mean_x) * (point.sigma_3 - mean_x);
      xy += (point.sigma_3 - mean_x) * (square(point) - mean_y);
    }
  const double sigma_ci = std::sqrt(mean_y - xy / xx * mean_x);
  EXPECT_NEAR(sigma_ci, 37.4, 0.05);
  EXPECT_NEAR(xy / xx / sigma_ci, 15.50, 0.005);

  // Ours is the residual in sigma_1, which weighs the low strengths more: within 10 %.
  StrengthData data;
  for (const auto& point : tests)
    data.points.push_back({point.sigma_3 * MPa, point.sigma_1 * MPa});
  const auto answer = fit_hoek_brown(data, HoekBrownForm::intact, false);
  ASSERT_TRUE(answer.fit) << answer.reason;
  EXPECT_NEAR(answer.fit->sigma_ci.value, 37.4 * MPa, 0.1 * 37.4 * MPa);
  EXPECT_NEAR(answer.fit->m.value, 15.50, 0.1 * 15.50);
  EXPECT_GT(*answer.fit->quality.r_squared.value, 0.99);
}

TEST(MohrCoulomb, GivesFrictionAndCohesionBackFromExactPoints)
{
  const double phi = 40.0 * std::numbers::pi / 180.0;
  const double cohesion = 30 * MPa;
  const double slope = (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
  StrengthData data;
  for (const double sigma_3 : confinements)
    data.points.push_back({sigma_3, 2.0 * cohesion * std::sqrt(slope) + slope * sigma_3});
  data.points.push_back({-5 * MPa, 0.0}); // tension is not of this envelope
  const auto answer = fit_mohr_coulomb(data);
  ASSERT_TRUE(answer.fit) << answer.reason;
  EXPECT_NEAR(answer.fit->friction_angle.value, phi, 1e-12);
  EXPECT_NEAR(answer.fit->cohesion.value, cohesion, 1e-12 * cohesion);
  EXPECT_EQ(answer.fit->quality.residuals.size(), confinements.size());
}

TEST(MohrCoulomb, ConfidenceIntervalsHoldTheTruth)
{
  // Coverage as for Hoek and Brown: 90 to 98 % of 200 draws.
  const double phi = 40.0 * std::numbers::pi / 180.0;
  const double cohesion = 30 * MPa;
  const double slope = (1.0 + std::sin(phi)) / (1.0 - std::sin(phi));
  constexpr int n_draws = 200;
  int phi_inside = 0;
  int cohesion_inside = 0;
  for (int draw = 0; draw < n_draws; ++draw)
    {
      Random random(std::uint64_t(draw) + 1, RandomStream::strengths);
      StrengthData data;
      for (const double sigma_3 : confinements)
        data.points.push_back({sigma_3, random.normal(2.0 * cohesion * std::sqrt(slope) + slope * sigma_3, 3.0 * MPa)});
      const auto fit = *fit_mohr_coulomb(data).fit;
      phi_inside += std::abs(fit.friction_angle.value - phi) <= *fit.friction_angle.half_width.value;
      cohesion_inside += std::abs(fit.cohesion.value - cohesion) <= *fit.cohesion.half_width.value;
    }
  for (const int inside : {phi_inside, cohesion_inside})
    {
      EXPECT_GE(inside, 0.90 * n_draws);
      EXPECT_LE(inside, 0.98 * n_draws);
    }
}

TEST(MohrCoulomb, IntervalIsThatOfTheTextbook)
{
  // Five points, by hand: x = 0…4, y = 1, 3, 4, 8, 9 (times 10 MPa); slope 2.1, intercept 0.8, squares 1.9. Standard
  // error of the slope sqrt(1.9/3/10), t_{0.975, 3} = 3.182446 (any table).
  StrengthData data;
  const std::array<double, 5> y{1, 3, 4, 8, 9};
  for (std::size_t i = 0; i < y.size(); ++i)
    data.points.push_back({double(i) * 10 * MPa, y[i] * 10 * MPa});
  const auto fit = *fit_mohr_coulomb(data).fit;
  EXPECT_NEAR(fit.slope.value, 2.1, 1e-12);
  EXPECT_NEAR(fit.uniaxial_strength.value, 8 * MPa, 1e-3);
  EXPECT_NEAR(*fit.slope.half_width.value, 3.182446 * std::sqrt(1.9 / 3.0 / 10.0), 1e-6);
  EXPECT_NEAR(*fit.quality.r_squared.value, 1.0 - 1.9 / 46.0, 1e-12);
  EXPECT_NEAR(fit.quality.root_mean_square, std::sqrt(1.9 / 5.0) * 10 * MPa, 1e-3);
}

TEST(MohrCoulomb, RefusesStrengthThatDoesNotGrowEnough)
{
  StrengthData data;
  for (const double sigma_3 : confinements)
    data.points.push_back({sigma_3, 200 * MPa + 0.5 * sigma_3});
  const auto answer = fit_mohr_coulomb(data);
  EXPECT_FALSE(answer.fit);
  EXPECT_TRUE(has(answer.reason, "friction angle"));
}

TEST(StrengthEnvelopes, RecordsNameEveryFigureOnceAndGiveAReasonForWhatIsMissing)
{
  auto data = independent_program(9.5 * MPa);
  data.points.resize(3); // leaves intervals out
  std::set<std::string> fits;
  for (const auto& record : records(fit_strength_envelopes(data)))
    {
      EXPECT_TRUE(fits.insert(record.form + '/' + record.variant).second);
      EXPECT_EQ(record.reason.empty(), !record.entries.empty()) << record.form;
      EXPECT_EQ(record.reason.empty(), !record.residuals.empty()) << record.form;
      std::set<std::string> names;
      for (const auto& [name, figure] : record.entries)
        {
          EXPECT_TRUE(names.insert(name).second) << name;
          EXPECT_NE(figure.value.has_value(), !figure.reason.empty()) << record.form << ' ' << name;
        }
    }
  EXPECT_EQ(fits, (std::set<std::string>{"as_paper/with_tension_point", "as_paper/without_tension_point",
                                         "intact/with_tension_point", "intact/without_tension_point",
                                         "general/with_tension_point", "general/without_tension_point",
                                         "intact_by_regression/", "mohr_coulomb/"}));
}

TEST(StrengthEnvelopes, RemarkSaysWhyThePapersFormIsNotAdmissible)
{
  const auto envelopes = fit_strength_envelopes(independent_program(9.5 * MPa));
  const std::string text = remark(envelopes);
  EXPECT_TRUE(has(text, "stronger than intact", "s = 1.94", "156 MPa were measured", "more steeply", "s = 0.97"));
  EXPECT_TRUE(has(as_text(envelopes), text));
}

TEST(StrengthEnvelopes, AreRepresentedByTheIntactFormUnlessItMissesThem)
{
  const auto on_curve = [](const double a) {
    StrengthData data{{}, 150 * MPa, 7.5 * MPa}; // m = 20, s = 1
    for (const double sigma_3 : {0.0, 5 * MPa, 10 * MPa, 20 * MPa, 40 * MPa, 60 * MPa})
      data.points.push_back({sigma_3, hoek_brown_sigma_1(sigma_3, 150 * MPa, 20.0, 1.0, a)});
    return fit_strength_envelopes(data);
  };
  const auto intact = on_curve(0.5);
  ASSERT_TRUE(intact.representative());
  EXPECT_EQ(intact.representative()->form, HoekBrownForm::intact);
  EXPECT_LT(*miss_of_intact_form(intact), 1e-3);
  EXPECT_FALSE(has(remark(intact), "misses"));
  // Steeper, as specimens of clumps are: no curve with a = 0.5 follows it. The general form does but for the tension point,
  // whose σ₁ is 0 where the curve begins at −7.5 MPa.
  const auto steep = on_curve(0.8);
  ASSERT_TRUE(steep.representative());
  EXPECT_EQ(steep.representative()->form, HoekBrownForm::general);
  EXPECT_GT(*miss_of_intact_form(steep), largest_miss);
  EXPECT_TRUE(has(remark(steep), "With a free (a = 0.81) it misses them by 0 %"));
  EXPECT_FALSE(miss_of_intact_form(fit_strength_envelopes({})));
}

TEST(StrengthEnvelopes, AreSilentAndTheSameBitsEveryTime)
{
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const auto first = records(fit_strength_envelopes(independent_program(9.5 * MPa)));
  const auto second = records(fit_strength_envelopes(independent_program(9.5 * MPa)));
  // Points that the solver cannot do much with.
  StrengthData flat;
  for (const double sigma_3 : confinements)
    flat.points.push_back({sigma_3, sigma_3 + 100 * MPa});
  flat.uniaxial_compressive_strength = 100 * MPa;
  flat.tensile_strength = 1e-9;
  (void)fit_strength_envelopes(flat);
  // Strengths that are numbers and of no rock, and one in the middle of them.
  for (const double strength : {5e-324, 1e-300, 1e-30, 0.0, 1e-4, 1e30, 1e300, 1.7e308})
    {
      StrengthData strange = independent_program(9.5 * MPa);
      strange.points.front().sigma_1 = strength;
      strange.uniaxial_compressive_strength = strength;
      for (const auto& record : records(fit_strength_envelopes(strange)))
        EXPECT_FALSE(record.reason.empty()) << record.form << " of " << strength;
      strange.uniaxial_compressive_strength = 150 * MPa;
      strange.points.front().sigma_1 = 150 * MPa;
      strange.tensile_strength = strength;
      (void)fit_strength_envelopes(strange);
      strange.tensile_strength = 9.5 * MPa;
      strange.points.push_back({strength, strength + 200 * MPa});
      (void)fit_strength_envelopes(strange);
    }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t k = 0; k < first[i].entries.size(); ++k)
      EXPECT_EQ(first[i].entries[k].figure.value, second[i].entries[k].figure.value);
}
} // namespace
} // namespace feldspar
