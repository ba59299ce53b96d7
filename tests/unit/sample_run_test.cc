// A sample that is asked to end does so before its round over the points is over, and loses nothing but the step that was on
// its way.

#include "coupling/sample/sample_run.h"
#include "dem/lab/protocols/protocols.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <exception>

namespace feldspar
{
namespace
{
struct Asked : std::exception
{
};

SampleTest pressed()
{
  SampleParameters sample;
  sample.geometry = SampleGeometry::plane;
  sample.material = "linear elasticity";
  sample.elements_across = 2;
  sample.elements_along = 4; // of four points each
  sample.compression_step = 1e-4;
  TestParameters wanted;
  wanted.stop_strain = 5e-4;
  return {{uniaxial_compression.kind}, sample, wanted, {50e9, 0.2}};
}

constexpr std::size_t n_points = 32;

void go_to_the_end(SampleTest& test)
{
  while (!test.has_ended())
    test.advance([](const SampleStanding&) {}, [] {});
}
} // namespace

TEST(SampleTest, IsLeftAmidARoundOverItsPointsAndGoesOnToTheSameBits)
{
  SampleTest whole = pressed();
  go_to_the_end(whole);

  SampleTest left = pressed();
  std::atomic<std::size_t> n_asked = 0;
  const std::size_t enough = 2 * n_points + n_points / 2; // in the third round
  std::size_t n_watched = 0;
  const auto watch = [&](const SampleStanding&) {
    ++n_watched;
    if (n_asked >= enough)
      throw Asked();
  };
  EXPECT_THROW(
    {
      while (!left.has_ended())
        left.advance(
          watch, [] {}, [&] { return ++n_asked >= enough; });
    },
    Asked);
  EXPECT_LT(n_asked, 3 * n_points); // the rest of the round was not gone through
  EXPECT_GT(n_watched, 0u);
  go_to_the_end(left);

  const auto& expected = whole.finish(false).record.curve;
  const auto& found = left.finish(false).record.curve;
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    {
      EXPECT_EQ(found[k].axial_strain, expected[k].axial_strain) << k;
      EXPECT_EQ(found[k].axial_stress, expected[k].axial_stress) << k;
    }
}

// σ_1 = q_u + k σ_3 in whatever geometry, and as much above as below. To Newton's tolerance, of which the forces of all nodes
// take their share.
TEST(SampleTest, MohrCoulombHoldsTheStressOfItsClosedFormInEachGeometry)
{
  const ContinuumParameters rock;
  const double k = (1.0 + std::sin(rock.friction_angle)) / (1.0 - std::sin(rock.friction_angle));
  const double q_u = 2.0 * rock.cohesion * std::sqrt(k);
  for (const SampleGeometry geometry :
       {SampleGeometry::plane, SampleGeometry::plane_strain, SampleGeometry::axisymmetric, SampleGeometry::cylinder})
    for (const double pressure : {0.0, 10e6, 60e6})
      for (const double step : {4e-4, 1e-4})
        {
          if (step == 1e-4 && pressure != 10e6)
            continue; // more of the same
          SampleParameters sample;
          sample.geometry = geometry;
          sample.material = "Mohr-Coulomb";
          sample.elements_across = 3;
          sample.elements_along = 2;
          sample.compression_step = step;
          const double strain_at_yield = (q_u + (k - 1.0) * pressure) / rock.modulus;
          TestParameters wanted;
          const double last_strain = strain_at_yield + 6.0 * step;
          wanted.stop_strain = last_strain;
          const auto& kind = pressure > 0.0 ? triaxial_compression.kind : uniaxial_compression.kind;
          SampleTest test({kind, pressure}, sample, wanted, rock);
          go_to_the_end(test);
          const TestRecord record = test.finish(false).record;
          SCOPED_TRACE(testing::Message() << int(geometry) << ", " << pressure << ", " << step << record.ended_early);
          EXPECT_GE(-record.curve.back().axial_strain, last_strain * (1.0 - 1e-9));
          const double exact = q_u + k * pressure;
          EXPECT_NEAR(-record.curve.back().axial_stress, exact, sample.newton_tolerance * exact);
          for (const CurveSample& row : record.curve)
            {
              EXPECT_LE(std::abs(row.end_stress_difference), sample.newton_tolerance * std::abs(row.axial_stress));
              EXPECT_LE(-row.axial_stress, exact * (1.0 + 2.0 * sample.newton_tolerance));
            }
        }
}
} // namespace feldspar
