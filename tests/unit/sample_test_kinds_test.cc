#include "coupling/sample/sample_run.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace feldspar
{
namespace
{
TEST(SampleTest, RefusesAKindThatDoesNotSayItRunsOnFiniteElements)
{
  const TestKind torsion{.name = "torsion", .title = "Torsion", .sign = -1.0};
  try
    {
      SampleTest({torsion}, {}, {}, ContinuumParameters{});
      FAIL() << "a test of any kind was taken for compression";
    }
  catch (const InputError& error)
    {
      EXPECT_EQ(error.what(), std::string("TestKind: torsion: the sample stands between platens; it makes "
                                          "direct_tension, uniaxial_compression, triaxial_compression, own_loading"));
    }
}
} // namespace
} // namespace feldspar
