// A sample that is asked to end does so before its round over the points is over, and loses nothing but the step that was on
// its way.

#include "coupling/sample/sample_run.h"
#include "dem/lab/protocols/protocols.h"
#include "tests/unit/small_rve.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <numeric>
#include <vector>

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

// An element between rough platens has the strain of the platens at its four points. Another volume led over the same strains
// tells by how much each step's breaks lower the stress at a held strain: that times the quarter of the element, as thick as it
// is wide, is the moment.
TEST(SampleTest, EmissionOfAVolumeHasTheMomentByWhichItsStressFalls)
{
  EquilibriumParameters tight;
  tight.event_tolerance = tight.final_tolerance = 1e-10;
  const auto network = std::make_shared<const Network<2>>(periodic_specimen());
  SampleParameters sample;
  sample.width = sample.height = 0.05;
  sample.elements_across = sample.elements_along = 1;
  sample.rough_platens = true;
  sample.random_orientation = false;
  sample.most_broken_share = 1.0;
  sample.tension_step = 5e-6;
  TestParameters wanted;
  wanted.stop_strain = 3e-4;
  SampleTest test({direct_tension.kind}, sample, wanted, tight, std::vector{Realisation<2>(network)}, {}, 1);
  go_to_the_end(test);
  const TestRecord record = test.finish(false).record;

  RepresentativeVolume<2> alone(network, tight);
  auto event = record.events.begin();
  std::uint64_t n_events = 0;
  for (std::size_t k = 1; k < record.curve.size(); ++k)
    {
      const Voigt<2> strain = axial<2>(record.curve[k].axial_strain);
      const Voigt<2> before = alone.trial(strain, Bonds::frozen).state.stress;
      auto after = alone.trial(strain);
      const Voigt<2> fall = before - after.state.stress;
      const bool breaks = !after.breaks.empty();
      alone.accept(std::move(after));
      for (int point = 0; breaks && point < 4; ++point, ++event)
        {
          ASSERT_NE(event, record.events.end());
          EXPECT_EQ(event->number, ++n_events);
          EXPECT_EQ(event->step, record.curve[k].step);
          const double volume = 0.25 * 0.05 * 0.05 * 0.05;
          const Voigt<2> moment(event->moment[0], event->moment[3], event->moment[1]);
          EXPECT_LT(relative(moment, volume * fall), 1e-5) << k; // Newton's tolerance of the sample
        }
    }
  EXPECT_EQ(event, record.events.end());
  EXPECT_GT(n_events, 20u);

  std::map<std::uint64_t, std::uint64_t> n_breaks;
  for (const Crack& crack : record.cracks)
    ++n_breaks[crack.event];
  for (const EmissionEvent& one : record.events)
    EXPECT_EQ(one.n_breaks(), n_breaks[one.number]);
  EXPECT_EQ(n_breaks.size(), record.events.size());
  const double released = std::accumulate(record.events.begin(), record.events.end(), 0.0,
                                          [](const double sum, const auto& one) { return sum + one.released_energy; });
  const double expected = 0.05 * record.curve.back().energies.released; // the curve's is that of a metre
  EXPECT_NEAR(released, expected, 1e-12 * expected);
}
} // namespace feldspar
