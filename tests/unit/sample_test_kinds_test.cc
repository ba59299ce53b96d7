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
  EXPECT_THROW(SampleTest({torsion}, {}, {}, ContinuumParameters{}), std::invalid_argument)
    << "a test of any kind was taken for compression";
}
} // namespace
} // namespace feldspar
