#pragma once

#include "coupling/rve/path_sample.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace feldspar
{
/// Returns whether all numbers of a row are finite.
template <int dim>
bool is_finite(const PathSample<dim>& row)
{
  const auto all = [](const auto& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](const double one) { return std::isfinite(one); });
  };
  return all(row.strain) && all(row.stress) &&
         std::all_of(std::begin(path_columns<dim>), std::end(path_columns<dim>),
                     [&](const PathColumn<dim>& column) { return std::isfinite(column.value(row)); });
}
} // namespace feldspar
