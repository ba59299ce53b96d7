#include "results/varied_columns.h"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar
{
std::string VariedColumn::heading() const
{
  return unit && !unit->empty() ? fmt::format("{} [{}]", entry, *unit) : entry;
}

std::string VariedColumn::cell(const std::vector<VariantSetting>& settings) const
{
  const auto found =
    std::ranges::find_if(settings, [this](const VariantSetting& setting) { return setting.entry == entry; });
  if (found == settings.end())
    return "";
  return unit ? fmt::format("{}", number_of(*found)->value) : found->value;
}

std::vector<VariedColumn> varied_columns(const std::vector<std::vector<VariantSetting>>& of_rows)
{
  std::vector<VariedColumn> columns;
  for (const auto& settings : of_rows)
    for (const VariantSetting& setting : settings)
      {
        const auto number = number_of(setting);
        const std::optional<std::string> unit = number ? std::optional(number->unit) : std::nullopt;
        const auto known = std::ranges::find(columns, setting.entry, &VariedColumn::entry);
        if (known == columns.end())
          columns.push_back({setting.entry, unit});
        else if (known->unit != unit)
          known->unit.reset();
      }
  return columns;
}
} // namespace feldspar
