#include "results/variant_setting.h"

#include "base/text.h"

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
} // namespace feldspar
