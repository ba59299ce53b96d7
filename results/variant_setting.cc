#include "results/variant_setting.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace feldspar
{
std::optional<WrittenNumber> number_of(const VariantSetting& setting)
{
  const std::string_view text = trim(setting.value);
  const std::size_t space = text.find(' ');
  const std::string_view number = text.substr(0, space);
  if (!is_decimal_number(number))
    return std::nullopt;
  return WrittenNumber{parse_number(number),
                       space == std::string_view::npos ? std::string() : std::string(trim(text.substr(space)))};
}

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
