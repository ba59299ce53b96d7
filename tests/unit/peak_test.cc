// The peak of a curve, and the end of a test by it.

#include "dem/lab/protocols/protocols.h"
#include "laboratory/loading_stages.h"
#include "laboratory/stage_walk.h"
#include "laboratory/stop_rule.h"
#include "results/evaluation.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
using tests::has;

constexpr double unit_of_strain = 1e-3;
constexpr double unit_of_time = 1e-3; // of a strain of 1e-3 at 1/s [s]

using Corners = std::vector<std::pair<double, double>>; ///< strain [1e-3] and stress [MPa]

/// Straight between corners, a row a hundredth of a thousandth; in the sense of the kind.
TestRecord curve_through(const Corners& corners, const TestKind& kind = uniaxial_compression.kind)
{
  TestRecord record;
  record.kind = kind;
  record.size = {0.015, 0.03, 0.0};
  record.bulk_density = 2700.0;
  double way = 0.0;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k)
    {
      const auto [e0, s0] = corners[k];
      const auto [e1, s1] = corners[k + 1];
      const int n = std::max(1, int(std::lround(std::abs(e1 - e0) / 0.01)));
      for (int i = record.curve.empty() ? 0 : 1; i <= n; ++i)
        {
          CurveSample row;
          row.step = record.curve.size();
          row.axial_strain = kind.sign * unit_of_strain * (e0 + (e1 - e0) * i / n);
          row.axial_stress = kind.sign * 1e6 * (s0 + (s1 - s0) * i / n);
          row.time = unit_of_time * (way + std::abs(e1 - e0) * i / n);
          row.energies.strain = 1.0;
          record.curve.push_back(row);
        }
      way += std::abs(e1 - e0);
    }
  return record;
}

/// Strain [1e-3] and stress [MPa] of the peak of a finished curve; zeros without.
std::pair<double, double> peak_of(const TestRecord& record)
{
  const auto row = peak_row(record);
  if (!row)
    return {0.0, 0.0};
  return {record.kind.strain(record.curve[*row]) / unit_of_strain, record.kind.stress(record.curve[*row]) / 1e6};
}

/// Strain [1e-3] at which a running test with this curve ends by itself; 0 where it does not.
double end_of(const TestRecord& record, const PeakDemands& demands = {})
{
  StopRule rule(record.kind, 0.0, demands);
  for (const CurveSample& row : record.curve)
    {
      rule.add(row);
      if (rule.is_met_by(row, {}))
        return record.kind.strain(row) / unit_of_strain;
    }
  return 0.0;
}

/// A first maximum of 71 MPa at 1e-3, which falls by 30 %, and the strength of 138 MPa at 2.5e-3.
const Corners two_maxima{{0.0, 0.0}, {1.0, 71.0}, {1.1, 50.0}, {2.5, 138.0}, {2.7, 40.0}, {6.0, 30.0}};

TEST(Peak, IsNotAFirstMaximumWhileTheStressRises)
{
  // At 1.6 times the strain of the first maximum the stress is 81 MPa and rising; the test ends at 1.6 times 2.5e-3.
  const TestRecord whole = curve_through(two_maxima);
  EXPECT_NEAR(end_of(whole), 4.0, 0.011);
  EXPECT_NEAR(peak_of(whole).second, 138.0, 1e-9);
  // Below the first maximum too: 50 + 0.4/1.4 · 88 = 75 MPa is reached at 1.5e-3; a test that ends at 1.35e-3 stands at 66.
  TestRecord cut = whole;
  cut.curve.resize(136);
  ASSERT_LT(cut.kind.stress(cut.curve.back()), 71e6);
  EXPECT_FALSE(peak_row(cut));
  EXPECT_EQ(evaluate(cut).peak_stress.reason,
            "the stress never peaked: it was still rising when the test ended; the highest was 71 MPa");
}

TEST(Peak, IsAMaximumWhoseRestOnlyWavers)
{
  // Left with 30 % of its strength, which wavers by 10 MPa as pieces stick and slip: the last rows rise, and lead to 50 MPa in
  // another 0.6 of the strain at the peak, not to 100.
  const TestRecord record =
    curve_through({{0.0, 0.0}, {2.0, 100.0}, {2.2, 25.0}, {2.6, 35.0}, {2.9, 25.0}, {3.3, 35.0}});
  EXPECT_NEAR(peak_of(record).second, 100.0, 1e-9);
  EXPECT_NEAR(end_of(record), 3.2, 0.011);
}

TEST(Peak, OfATestThatEndsInAFallIsBeforeIt)
{
  // End by Stop stress over peak, or by a Stop strain: two rows before the end the curve still rose.
  EXPECT_NEAR(peak_of(curve_through({{0.0, 0.0}, {8.30, 102.0}, {8.32, 70.0}})).second, 102.0, 1e-9);
  // Behind an earlier maximum, on its way up again.
  EXPECT_EQ(peak_of(curve_through({{0.0, 0.0}, {2.0, 71.0}, {2.1, 50.0}, {2.5, 65.0}})).second, 0.0);
}

TEST(Peak, NeedsAFall)
{
  const auto fallen_to = [](const double stress) { return curve_through({{0.0, 0.0}, {2.0, 100.0}, {2.4, stress}}); };
  EXPECT_EQ(peak_of(fallen_to(96.0)).second, 0.0);
  EXPECT_NEAR(peak_of(fallen_to(94.0)).second, 100.0, 1e-9);
  EXPECT_TRUE(has(evaluate(fallen_to(96.0)).peak_stress.reason, "had not fallen by 5 % from its highest, 100 MPa"));
  TestRecord record = fallen_to(96.0);
  record.peak_demands.least_fall = 0.03;
  EXPECT_NEAR(peak_of(record).second, 100.0, 1e-9);
}

TEST(Peak, OfABodyThatYieldsIsWhereItsLevelBegins)
{
  const auto level_to = [](const double strain) { return curve_through({{0.0, 0.0}, {2.0, 100.0}, {strain, 100.0}}); };
  EXPECT_NEAR(peak_of(level_to(3.3)).first, 2.0, 1e-9);
  EXPECT_EQ(peak_of(level_to(3.1)).second,
            0.0); // 1.6 times 2e-3 are 3.2e-3, and 1.6 times 1.98e-3, where 99 % are reached, 3.17e-3
  EXPECT_NEAR(end_of(level_to(5.0)), 3.2, 0.011);
  // One that hardens by a tenth of its stiffness is not level.
  const TestRecord hardens = curve_through({{0.0, 0.0}, {2.0, 100.0}, {6.0, 120.0}});
  EXPECT_EQ(end_of(hardens), 0.0);
  EXPECT_EQ(peak_of(hardens).second, 0.0);
}

/// A body that slides under the friction 100 MPa from a strain of 1e-3 on, where sticking and slipping move the stress by a
/// share of it, in waves of this length [1e-3].
Corners stick_and_slip(const double share, const double wave, const double end, const double hardening = 0.0)
{
  Corners corners{{0.0, 0.0}, {1.0, 100.0}};
  for (double e = 1.01; e < end + 0.001; e += 0.01)
    corners.push_back(
      {e, 100.0 * (1.0 + share * std::sin(2.0 * std::numbers::pi * (e - 1.0) / wave)) + hardening * (e - 1.0)});
  return corners;
}

TEST(Peak, OfABodyThatSlidesIsItsFrictionThoughItSticksAndSlips)
{
  // A Stop strain ends it on its way up in a wave: the last tenth of the curve, half a wave long, leads far above. The
  // line through 5/8 of the curve rises by at most 6/π of the amplitude over the number of waves in it.
  for (const double share : {0.0, 0.01, 0.03})
    for (const double end : {3.6, 4.2, 4.35, 5.0})
      {
        const auto [strain, stress] = peak_of(curve_through(stick_and_slip(share, 0.8, end)));
        EXPECT_NEAR(stress, 100.0 * (1.0 + share), 0.01) << share << " " << end;
        EXPECT_NEAR(strain, share > 0.0 ? 1.2 : 1.0, 1e-6);
      }
  EXPECT_NEAR(end_of(curve_through(stick_and_slip(0.03, 0.8, 5.0))), 1.6 * 1.2, 0.011);
  // One that hardens by more than it wavers is still rising, and one that has slid for less than 0.6 of the way too.
  EXPECT_EQ(peak_of(curve_through(stick_and_slip(0.005, 0.8, 4.2, 2.0))).second, 0.0);
  EXPECT_EQ(peak_of(curve_through(stick_and_slip(0.01, 0.8, 1.5))).second, 0.0);
}

TEST(Peak, UnderLoadControlIsTheLoadUpToWhichTheBodyFollows)
{
  // The machine asks 50 MPa per strain of 1e-3. At 100 MPa the body gives way: the load stays behind, and is regained and
  // exceeded only at three times the strain.
  const auto pressed = [](const Corners& corners) {
    TestRecord record = curve_through(corners);
    record.peak_demands.stress_rate = 50e6 / unit_of_time;
    return record;
  };
  const Corners gives_way{{0.0, 0.0}, {2.0, 100.0}, {3.0, 99.0}, {6.0, 140.0}};
  EXPECT_NEAR(peak_of(pressed(gives_way)).second, 100.0, 1e-9);
  EXPECT_NEAR(end_of(pressed(gives_way), pressed(gives_way).peak_demands), 3.2, 0.011);
  EXPECT_EQ(peak_of(curve_through(gives_way)).second, 0.0); // still rising
  // A small fall that the machine makes good is none: 96 MPa where it asks 100.
  EXPECT_NEAR(peak_of(pressed({{0.0, 0.0}, {1.95, 97.5}, {2.0, 96.0}, {2.1, 105.0}, {2.4, 20.0}})).second, 105.0, 1e-9);
  // A body too soft for the pump never follows; its peak is where it falls.
  EXPECT_NEAR(peak_of(pressed({{0.0, 0.0}, {2.0, 60.0}, {2.2, 20.0}})).second, 60.0, 1e-9);
}

TEST(Peak, NeedsALeastStressAndTimeForItsWaves)
{
  // Nothing holds the body at first: waves of 0.2 MPa come and go. Held from 1e-3 on, it carries 67 MPa.
  const Corners gap{{0.0, 0.0}, {0.01, 0.2}, {0.02, 0.1}, {0.03, 0.2}, {0.1, 0.0},
                    {1.0, 0.0}, {2.0, 67.0}, {2.2, 10.0}, {4.0, 8.0}};
  PeakDemands demands;
  demands.least_stress = 0.8e6;
  demands.least_time = 25e-6;
  EXPECT_NEAR(end_of(curve_through(gap), demands), 3.2, 0.011);
  TestRecord never_held = curve_through({gap.begin(), gap.begin() + 6});
  never_held.peak_demands = demands;
  EXPECT_EQ(peak_of(never_held).second, 0.0);
  EXPECT_TRUE(has(evaluate(never_held).peak_stress.reason, "the highest stress, 0.2 MPa, is below 0.8 MPa"));

  // A test so fast that it breaks within one travel of a wave ends, and has no strength.
  TestRecord fast = curve_through({{0.0, 0.0}, {0.02, 67.0}, {0.04, 10.0}, {0.2, 8.0}});
  fast.peak_demands = demands;
  EXPECT_NEAR(end_of(fast, demands), 1.6 * 0.025, 0.011);
  EXPECT_TRUE(has(evaluate(fast).peak_stress.reason, "came after 20 µs"));
}

TEST(Peak, OfADiscIsNoRipple)
{
  // The first fall by 5 % is one of waves; the disc splits at 5 MPa, and its halves carry 9.
  TestRecord record =
    curve_through({{0.0, 0.0}, {0.01, 0.2}, {0.02, 0.0}, {0.5, 5.0}, {0.55, 4.0}, {1.0, 9.0}}, brazilian.kind);
  EXPECT_NEAR(peak_of(record).second, 0.2, 1e-9); // without demands
  record.peak_demands.least_stress = 0.8e6;
  EXPECT_NEAR(peak_of(record).second, 5.0, 1e-9);
  EXPECT_NEAR(end_of(record, record.peak_demands), 0.8, 0.011); // its rise does not matter
}

TEST(Peak, OfAClassIICurveLiesBeforeItGoesBack)
{
  // Stress and strain go back together: the curve falls, although its slope is that of a rise.
  const TestRecord record = curve_through({{0.0, 0.0}, {2.0, 100.0}, {1.5, 40.0}, {1.6, 5.0}});
  EXPECT_NEAR(peak_of(record).second, 100.0, 1e-9);
}

TEST(Peak, OfATableOfStagesIsItsHighestStress)
{
  // Loaded, unloaded and loaded again: the table ends where it likes. The same of a measured curve.
  const Corners cycle{{0.0, 0.0}, {2.0, 60.0}, {1.0, 30.0}, {1.8, 55.0}};
  const TestRecord staged = curve_through(cycle, own_loading.kind);
  EXPECT_NEAR(peak_of(staged).second, 60.0, 1e-9);
  EXPECT_TRUE(ends_rising(staged));
  EXPECT_EQ(peak_of(curve_through(cycle)).second, 0.0);
  TestRecord measured = curve_through({{0.0, 0.0}, {2.0, 60.0}, {2.01, 59.0}});
  EXPECT_EQ(peak_of(measured).second, 0.0);
  measured.peak_demands = {.least_fall = 0.0, .may_end_rising = true};
  EXPECT_NEAR(peak_of(measured).second, 60.0, 1e-9);
}

TEST(StopRules, GiveUpAStageWhereItsStressNoLongerRises)
{
  // A stage towards 200 MPa: it goes on behind the first maximum, and is given up behind the second, when half of it is lost.
  TestRecord record = curve_through(two_maxima, own_loading.kind);
  for (CurveSample& row : record.curve)
    row.n_tension_cracks = row.step; // it cracks
  TestParameters wanted;
  wanted.of<LoadingTable>().stages = {{.axial_stress = 200e6}};
  StageWalk walk(wanted);
  walk.begin({0.0, 0.0, 0.0});
  std::vector<CurveSample> curve{record.curve.front()};
  for (std::size_t k = 1; k < record.curve.size(); ++k)
    {
      const CurveSample& row = record.curve[k];
      curve.push_back(row);
      if (walk.is_over(curve, {row.time, -row.axial_strain, -row.axial_stress}))
        break;
    }
  EXPECT_NEAR(-curve.back().axial_strain, 2.64e-3,
              0.02e-3); // 138 MPa fall by 98 over 0.2e-3, and 69 come after 0.14e-3
  EXPECT_TRUE(has(walk.ended_early(), "rose to 138.0 MPa and no further"));
}

TEST(StopRules, EndATestThatNothingHolds)
{
  PeakDemands demands;
  demands.least_stress = 0.8e6;
  // Pressed to 5 %, pulled to 1 %: rock has broken long before.
  const Corners nothing{{0.0, 0.0}, {0.1, 0.2}, {100.0, 0.2}};
  EXPECT_NEAR(end_of(curve_through(nothing), demands), 50.0, 0.011);
  EXPECT_NEAR(end_of(curve_through(nothing, direct_tension.kind), demands), 10.0, 0.011);
}
} // namespace
} // namespace feldspar
