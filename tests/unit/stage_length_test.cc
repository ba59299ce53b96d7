#include "app/screen/expected_length.h"

#include "laboratory/compression.h"
#include "tests/unit/staged_runs.h"

#include <gtest/gtest.h>

namespace feldspar
{
namespace
{
constexpr double modulus = 60e9;

CurveSample row(const double time, const double strain, const double stress)
{
  CurveSample result;
  result.time = time;
  result.axial_strain = -strain;
  result.axial_stress = -stress;
  return result;
}

// Pressed to 0.002, unloaded to no stress, held for 10 µs, pressed to 0.004 at twice the rate of 1/s: beforehand by the
// modulus, then by where the test stands.
TEST(StageLength, IsThatOfWaysHoldsAndStressesFromWhereTheTestStands)
{
  TestParameters parameters = tests::following(
    {{.axial_strain = 0.002}, {.axial_stress = 0.0}, {.duration = 1e-5}, {.axial_strain = 0.004, .strain_rate = 2.0}});
  parameters.of<CompressionParameters>().strain_rate = 1.0;
  StageLength length(parameters, modulus);
  constexpr double rounding = 1e-15;
  EXPECT_NEAR(length.left(), 0.002 + 0.002 + 1e-5 + 0.002, rounding);

  length.follow(row(0.0, 0.0, 0.0));
  length.follow(row(0.001, 0.001, 50e6)); // softer than thought
  EXPECT_NEAR(length.gone(), 0.001, rounding);
  EXPECT_NEAR(length.left(), 0.001 + 110e6 / modulus + 1e-5 + 0.5 * (0.004 - 0.002 + 110e6 / modulus), rounding);

  length.follow(row(0.002, 0.002, 100e6)); // the first stage ends
  EXPECT_NEAR(length.left(), 100e6 / modulus + 1e-5 + 0.5 * (0.004 - 0.002 + 100e6 / modulus), rounding);
  length.follow(row(0.0036, 0.0004, 0.0)); // the second
  EXPECT_NEAR(length.left(), 1e-5 + 0.5 * 0.0036, rounding);
  length.follow(row(0.003604, 0.0004, 0.0)); // within the hold
  EXPECT_NEAR(length.left(), 6e-6 + 0.5 * 0.0036, rounding);
  length.follow(row(0.00361, 0.0004, 0.0));
  EXPECT_NEAR(length.left(), 0.5 * 0.0036, rounding);
  length.follow(row(0.00541, 0.004, 200e6));
  EXPECT_EQ(length.left(), 0.0);
  EXPECT_NEAR(length.gone(), 0.00541, rounding);
}

// From the confinement of the first stage on, and by the widening of one that prescribes the lateral strain.
TEST(StageLength, BeginsAtTheConfinement)
{
  TestParameters parameters =
    tests::following({{.axial_stress = 70e6, .confining_pressure = 10e6},
                      {.lateral_strain = -0.001, .confining_pressure = 10e6, .strain_rate = 0.5}});
  parameters.of<CompressionParameters>().strain_rate = 1.0;
  // To 70 MPa it is shortened by 0.001, of which it widens by a quarter.
  EXPECT_NEAR(StageLength(parameters, modulus).left(), 0.001 + (0.001 - 0.00025) / 0.5, 1e-15);
}
} // namespace
} // namespace feldspar
