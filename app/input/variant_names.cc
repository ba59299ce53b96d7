#include "app/input/variant_names.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace feldspar
{
namespace
{
/// Length of a name that leaves room for the name of a test, its pressure, a seed and what a picture shows.
constexpr std::size_t most_characters = 80;

bool is_letter_or_digit(const char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Words with one `_` between them. A minus and a point stay where a digit follows; in an amount a fraction is read as it
/// is spoken, elsewhere a slash parts folders.
std::string in_words(const std::string_view text)
{
  std::string words;
  const auto is_digit = [&](const std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
  const bool is_amount = is_digit(text.find_first_not_of("+-."));
  const auto part = [&] {
    if (!words.empty() && words.back() != '_')
      words += '_';
  };
  for (std::size_t at = 0; at < text.size(); ++at)
    {
      const char c = text[at];
      const bool begins_word = at == 0 || text[at - 1] == ' ';
      if (is_amount && ((c == '/' && !begins_word) || (begins_word && text.substr(at, 2) == "1/")))
        {
          part();
          words += "per_";
          at += c == '/' ? 0 : 1;
        }
      else if (c == '%')
        words += "percent";
      else if (is_letter_or_digit(c) || ((c == '.' || c == '-') && is_digit(at + 1)))
        words += c;
      else if (c != '+' || !is_digit(at + 1)) // 1e+3
        part();
    }
  while (!words.empty() && words.back() == '_')
    words.pop_back();
  return words;
}

/// The beginning of a name, not cut within a word.
std::string cut_between_words(const std::string& name)
{
  if (name.size() <= most_characters)
    return name;
  const std::size_t end = name.rfind('_', most_characters);
  return name.substr(0, end == std::string::npos ? most_characters : end);
}

/// An entry without its section, unless another section varies one of the same name.
std::string name_of_entry(const std::string& entry, const std::vector<VariantSetting>& settings)
{
  const auto short_name = [](const std::string& full) { return full.substr(full.find('/') + 1); };
  const bool is_alone = std::ranges::count_if(settings, [&](const VariantSetting& other) {
                          return short_name(other.entry) == short_name(entry);
                        }) == 1;
  std::string name = is_alone ? short_name(entry) : entry;
  std::ranges::replace(name, '/', ' ');
  return in_small_letters(in_words(name));
}
} // namespace

std::vector<std::string> names_in_files(const std::vector<std::vector<VariantSetting>>& variants)
{
  std::vector<std::string> names;
  for (const auto& settings : variants)
    {
      std::string name;
      for (const auto& [entry, value] : settings)
        name += fmt::format("{}{}_{}", name.empty() ? "" : "_", name_of_entry(entry, settings), in_words(value));
      names.push_back(name);
    }
  std::map<std::string, unsigned int> n_alike;
  for (const std::string& name : names)
    ++n_alike[in_small_letters(cut_between_words(name))];
  for (std::size_t v = 0; v < names.size(); ++v)
    {
      const bool is_long = names[v].size() > most_characters;
      names[v] = cut_between_words(names[v]);
      if (is_long || n_alike[in_small_letters(names[v])] > 1)
        names[v] += fmt::format("_variant_{}", v + 1);
    }
  return names;
}
} // namespace feldspar
