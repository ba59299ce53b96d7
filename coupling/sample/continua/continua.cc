#include "coupling/sample/continua/continua.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace feldspar
{
const Continuum& continuum_of(const std::string_view name)
{
  static const std::array<const Continuum*, continuum_names.size()> all{&continua::linear_elasticity,
                                                                        &continua::mohr_coulomb};
  const auto found = std::ranges::find_if(all, [&](const Continuum* one) { return one->name == name; });
  if (found == all.end())
    throw std::invalid_argument("\"" + std::string(name) + "\" is in no list of materials without grains");
  return **found;
}
} // namespace feldspar
