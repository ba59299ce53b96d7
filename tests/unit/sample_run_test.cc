// A sample that is asked to end does so before its round over the points is over, and loses nothing but the step that was on
// its way.

#include "coupling/sample/sample_run.h"
#include "dem/lab/protocols/protocols.h"

#include <gtest/gtest.h>

#include <atomic>
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
} // namespace feldspar
