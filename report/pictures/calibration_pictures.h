#pragma once

#include <string>

namespace feldspar
{
/// An SI value in the unit of tables: GPa, MPa, deg.
struct ShownUnit
{
  std::string name;
  double size;
};

/// The unit for figures of this size; `Pa`, `rad` and `1` are known.
ShownUnit shown_unit(const std::string& si_unit, double size);
} // namespace feldspar
