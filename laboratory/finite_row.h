#pragma once

#include "laboratory/curve.h"

#include <cmath>
#include <string_view>

namespace feldspar
{
/// The name of a column whose number in this row is infinite, or no number where every body has one; empty: none.
inline std::string_view not_finite_in(const CurveSample& row)
{
  for (const Column<CurveSample>& column : curve_columns)
    if (const double value = column.get(row); !std::isfinite(value) && !(std::isnan(value) && column.is(perhaps_nan)))
      return column.name;
  return {};
}
} // namespace feldspar
