#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace feldspar
{
/// The user's mistake, reported in one line: what, where, what is allowed. The command ends with exit code 2.
struct InputError : std::runtime_error
{
  using std::runtime_error::runtime_error;

  /// A text with values, as fmt::format() writes it.
  template <typename First, typename... More>
  InputError(fmt::format_string<First, More...> text, First&& first, More&&... more)
    : runtime_error(fmt::format(text, std::forward<First>(first), std::forward<More>(more)...))
  {
  }
};

/// The result of `work`. An InputError of it becomes the one that `rephrase` makes of its text, with the place in front.
template <typename Work, typename Rephrase>
decltype(auto) rephrased(const Work& work, const Rephrase& rephrase)
{
  try
    {
      return work();
    }
  catch (const InputError& error)
    {
      throw rephrase(std::string(error.what()));
    }
}
} // namespace feldspar
