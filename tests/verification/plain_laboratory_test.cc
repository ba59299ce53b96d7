// Whole laboratory tests by the engine beside plain scalar code, which shares with it nothing but the equations.

#include "benchmarks/plain_laboratory.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace feldspar::tests
{
namespace
{
struct BothTests
{
  TestRecord engine;
  plain::Body body;
  std::vector<plain::Row> rows;
};

BothTests run_both(const bool pulls, const double stop_strain, const double damping)
{
  const Specimen<2> specimen = small_specimen();
  TestParameters wanted;
  wanted.stop_strain = stop_strain;
  LabTest<2> test({pulls ? direct_tension : uniaxial_compression}, specimen, wanted, {.damping = damping});
  while (test.advance())
    ;
  const double rate =
    pulls ? wanted.of<TensionParameters>().strain_rate : wanted.of<CompressionParameters>().strain_rate;
  const double between_rows =
    pulls ? wanted.of<TensionParameters>().sampling_strain : wanted.of<CompressionParameters>().sampling_strain;
  plain::Body body(specimen, pulls ? plain::Loading::tension : plain::Loading::compression, rate, damping);
  std::vector<plain::Row> rows = body.run(test.n_steps(), between_rows);
  return {test.finish(false).record, std::move(body), std::move(rows)};
}

/// Largest difference between two columns of the curves over the largest value.
template <typename Of, typename PlainOf>
double largest_difference(const BothTests& both, const Of& of, const PlainOf& plain_of)
{
  double difference = 0.0, largest = 0.0;
  for (std::size_t k = 0; k < both.rows.size(); ++k)
    {
      difference = std::max(difference, std::abs(of(both.engine.curve[k]) - plain_of(both.rows[k])));
      largest = std::max(largest, std::abs(plain_of(both.rows[k])));
    }
  return difference / largest;
}

void expect_equal_curves(const BothTests& both, const double sign)
{
  ASSERT_EQ(both.engine.curve.size(), both.rows.size());
  for (std::size_t k = 0; k < both.rows.size(); ++k)
    EXPECT_EQ(both.engine.curve[k].step, both.rows[k].step);
  const auto differs = [&](const auto& of, const auto& plain_of) { return largest_difference(both, of, plain_of); };
  EXPECT_LT(
    differs([=](const auto& row) { return sign * row.axial_stress; }, [](const auto& row) { return row.stress; }),
    1e-8);
  EXPECT_LT(differs([](const auto& row) { return row.energies.boundary_work; },
                    [](const auto& row) { return row.boundary_work; }),
            1e-10);
  EXPECT_LT(
    differs([](const auto& row) { return row.energies.strain; }, [](const auto& row) { return row.strain_energy; }),
    1e-10);
  // A ten-thousandth of the strain energy, in waves.
  EXPECT_LT(differs([](const auto& row) { return row.energies.kinetic; }, [](const auto& row) { return row.kinetic; }),
            1e-6);
}

// Sums in another order leave round-off, which grows over some thousand steps. Local damping would make more of it: it goes by the
// sign of velocities, which round-off decides where they are nearly zero.
TEST(PlainLaboratory, HasTheSameCurvesWithoutDamping)
{
  expect_equal_curves(run_both(true, 5e-5, 0.0), 1.0);
  expect_equal_curves(run_both(false, 2e-4, 0.0), -1.0);
}

TEST(PlainLaboratory, BreaksTheSameBondsFirstAndHasTheSamePeak)
{
  BothTests both = run_both(false, 6e-3, 0.7);
  const auto& cracks = both.engine.cracks;
  auto& plain_cracks = both.body.cracks;
  std::sort(plain_cracks.begin(), plain_cracks.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.step, a.joint, a.segment) < std::tuple(b.step, b.joint, b.segment);
  });
  constexpr std::size_t n_first = 10;
  ASSERT_GE(std::min(cracks.size(), plain_cracks.size()), n_first);
  for (std::size_t k = 0; k < n_first; ++k)
    {
      EXPECT_EQ(cracks[k].joint, plain_cracks[k].joint);
      EXPECT_EQ(cracks[k].segment, plain_cracks[k].segment);
      EXPECT_EQ(cracks[k].kind == CrackKind::tension, plain_cracks[k].in_tension);
    }
  double peak = 0.0, plain_peak = 0.0;
  for (const CurveSample& row : both.engine.curve)
    peak = std::max(peak, -row.axial_stress);
  for (const plain::Row& row : both.rows)
    plain_peak = std::max(plain_peak, row.stress);
  EXPECT_NEAR(plain_peak, peak, 0.03 * peak); // another order of cracks near the peak

  // The works miss as little of the work of the platens as those of the engine.
  const plain::Row& end = both.rows.back();
  EXPECT_LT(std::abs(end.boundary_work + both.rows.front().kinetic - end.kinetic - end.strain_energy - end.slip -
                     end.released - end.damping_work),
            5e-3 * end.boundary_work);
}
} // namespace
} // namespace feldspar::tests
