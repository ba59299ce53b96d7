#pragma once

#include "base/input_error.h"

#include <gtest/gtest.h>

#include <concepts>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar::tests
{
/// Holds where a text has all these words in it; a failure shows the first that it has not, and the text.
testing::AssertionResult has(const std::string_view text, const std::convertible_to<std::string_view> auto&... words)
{
  const std::string_view all[]{words...};
  for (const std::string_view one : all)
    if (text.find(one) == std::string_view::npos)
      return testing::AssertionFailure() << '"' << one << "\" is not in \"" << text << '"';
  return testing::AssertionSuccess() << '"' << all[0] << "\" is in \"" << text << '"';
}

/// Number of times that a text has these words in it.
inline std::size_t times(const std::string_view text, const std::string_view words)
{
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(words, at)) != std::string_view::npos; at += words.size())
    ++n;
  return n;
}

/// Sentences as lines.
inline std::string joined(const std::vector<std::string>& sentences)
{
  std::string text;
  for (const std::string& sentence : sentences)
    text += sentence + "\n";
  return text;
}

/// The message of the error that a call throws; empty where it throws none.
template <typename Error = InputError>
std::string refusal(const std::invocable auto& call)
{
  try
    {
      call();
    }
  catch (const Error& error)
    {
      return error.what();
    }
  return "";
}
} // namespace feldspar::tests
