#include "app/programme/usual_ranges.h"

#include "app/input/parameter_table.h"
#include "base/table/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace feldspar
{
namespace
{
/// Some ten times wider than what rock, cement, soil and their laboratories have: beyond it a unit is wrong.
struct UsualRange
{
  std::string_view entry; ///< in whichever section it stands
  const Dimension& dimension;
  double low; ///< in SI; 0 passes, where the entry allows it
  double high;
};

constexpr UsualRange usual_ranges[] = {{"Width", length, 1e-3, 10.0},
                                       {"Height", length, 1e-3, 10.0},
                                       {"Minimum radius", length, 1e-6, 0.5},
                                       {"Density", density, 500.0, 2e4},
                                       {"Modulus", stress, 1e8, 2e12},
                                       {"Bond tensile strength", stress, 1e3, 2e9},
                                       {"Tensile strength", stress, 1e3, 2e9},
                                       {"Bond cohesion", stress, 1e3, 1e10},
                                       {"Cohesion", stress, 1e3, 1e10},
                                       {"Confinements", stress, 1e3, 2e9},
                                       {"Intermediate stress", stress, 1e3, 2e9},
                                       {"Confining pressure", stress, 1e3, 2e9}};

/// A sentence on the first value of an entry that is far outside; empty: none.
std::string unusual_value(const Input& input, const Parameter& parameter)
{
  const auto* const usual = std::ranges::find(usual_ranges, parameter.entry, &UsualRange::entry);
  if (usual == std::end(usual_ranges) || !has_use_for(input, parameter))
    return "";
  const std::string text = parameter.write(input);
  if (text == none)
    return "";
  const auto in_its_unit = [&](const double value) { return format_quantity(value, parameter.unit, usual->dimension); };
  for (const double value : parse_quantities(text, usual->dimension))
    if (value != 0.0 && (value < usual->low || value > usual->high))
      return fmt::format("{}: {} lies far outside {} to {}, the range of rocks and laboratories; is the unit meant?",
                         parameter.name(), in_its_unit(value), in_its_unit(usual->low), in_its_unit(usual->high));
  return "";
}
} // namespace

std::vector<std::string> unusual_values(const std::vector<Variant>& variants)
{
  return sentences_on(variants, unusual_value);
}
} // namespace feldspar
