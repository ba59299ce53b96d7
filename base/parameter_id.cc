#include "base/parameter_id.h"

#include <fmt/format.h>

#include <utility>

namespace feldspar
{
namespace
{
InputWords& words_in_use()
{
  static InputWords words{[](const ParameterId& parameter) {
                            return InputPlace{"", std::string(parameter.name)};
                          },
                          [](Work) { return std::string("Feldspar"); }};
  return words;
}
} // namespace

void use_words_of_input(const InputWords& words) { words_in_use() = words; }

std::string in_words(const ParameterId& parameter)
{
  const auto [section, entry] = words_in_use().place(parameter);
  return section.empty() || entry.empty() ? section + entry : fmt::format("{}/{}", section, entry);
}

std::string entry_in_words(const ParameterId& parameter) { return words_in_use().place(parameter).entry; }

std::string in_words(const Work work) { return words_in_use().command(work); }

ParameterError::ParameterError(const ParameterId& which, std::string found, std::string why)
  : InputError("{}{}{}: {}", in_words(which), found.empty() ? "" : " = ", found, why)
  , parameter(which)
  , value(std::move(found))
  , reason(std::move(why))
{
}

ParameterError::ParameterError(const ParameterId& which, std::string why)
  : ParameterError(which, "", std::move(why))
{
}
} // namespace feldspar
