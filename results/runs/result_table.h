#pragma once

#include "results/runs/run.h"

#include <functional>
#include <string_view>
#include <vector>

namespace feldspar
{
/// A result of a test by its name in summary.json, which ends in its SI unit.
struct ResultEntry
{
  std::string_view name;
  std::function<Figure(const FinishedTest&)> value;
  std::function<void(FinishedTest&, const Figure&)> set; ///< puts back what `value` gave
  bool of_model = false;                                 ///< a curve measured on rock has none
};

/// Every figure that summary.json gives for a test, in its order there. Whoever writes, reads, averages or compares
/// results walks this.
const std::vector<ResultEntry>& result_table();
} // namespace feldspar
