// Materials without grains are found by the names that an input may give.

#include "coupling/sample/continua/continua.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace feldspar
{
TEST(Continua, AreListedByTheNamesOfTheInputAndSayAll)
{
  for (const std::string_view name : continuum_names)
    {
      const Continuum& material = continuum_of(name);
      EXPECT_EQ(material.name, name);
      EXPECT_NE(material.in_plane, nullptr) << name;
      EXPECT_NE(material.in_space, nullptr) << name;
    }
  EXPECT_THROW(continuum_of("grains"), std::invalid_argument);
  EXPECT_THROW(continuum_of("linear_elasticity"), std::invalid_argument);
}
} // namespace feldspar
