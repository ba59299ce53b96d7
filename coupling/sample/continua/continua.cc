#include "coupling/sample/continua/continua.h"

#include <stdexcept>

namespace feldspar
{
const Continuum& continuum_of(const SampleMaterial material)
{
  switch (material) // without a default: the compiler names the material that is missing here
    {
    case SampleMaterial::linear_elasticity:
      return continua::linear_elasticity;
    case SampleMaterial::mohr_coulomb:
      return continua::mohr_coulomb;
    case SampleMaterial::grains:
      break;
    }
  throw std::invalid_argument("a sample of grains is no continuum");
}
} // namespace feldspar
