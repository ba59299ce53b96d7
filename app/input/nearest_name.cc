#include "app/input/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>

namespace feldspar
{
namespace
{
/// Levenshtein's distance, capital or small alike.
std::size_t edit_distance(const std::string_view a, const std::string_view b)
{
  const auto same = [](const unsigned char x, const unsigned char y) { return std::tolower(x) == std::tolower(y); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i)
    {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < b.size(); ++j)
        {
          const std::size_t replaced = diagonal + (same(a[i], b[j]) ? 0 : 1);
          diagonal = row[j + 1];
          row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
        }
    }
  return row.back();
}
} // namespace

std::string nearest_name(const std::string_view text, const std::vector<std::string_view>& names)
{
  const std::string_view found = text.substr(0, 100); // no name is longer, and the effort grows with it
  const auto nearest = std::ranges::min_element(names, {}, [&](const auto name) { return edit_distance(found, name); });
  const std::size_t distance = edit_distance(found, *nearest);
  if (2 * distance > nearest->size())
    return "";
  return fmt::format("; did you mean \"{}\"{}?", *nearest,
                     distance == 0 ? " (capital and small letters are told apart)" : "");
}

std::string suggestion(const std::string_view text, const std::vector<std::string_view>& names)
{
  const std::string nearest = nearest_name(text, names);
  return nearest.empty() ? fmt::format("; there are {}", fmt::join(names, ", ")) : nearest;
}
} // namespace feldspar
