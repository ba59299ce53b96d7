#include "results/folder/tests_table.h"

#include "base/whole_file.h"
#include "results/runs/result_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace feldspar
{
namespace
{
/// With quotes where a reader of CSV needs them.
std::string cell(const std::string& text)
{
  if (text.find_first_of(",\"\n\r") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}

/// The unit in which all tests have an entry; none where they differ, or where it is no number.
std::optional<std::string> common_unit(const std::vector<FinishedTest>& tests, const std::size_t entry)
{
  std::optional<std::string> unit;
  for (const auto& test : tests)
    {
      const auto number = number_of(test.settings.at(entry));
      if (!number || (unit && *unit != number->unit))
        return std::nullopt;
      unit = number->unit;
    }
  return unit;
}
} // namespace

void write_tests(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  const std::size_t n_entries = tests.empty() ? 0 : tests.front().settings.size();
  std::vector<std::optional<std::string>> units;
  std::string text = "name,kind,seed";
  for (std::size_t k = 0; k < n_entries; ++k)
    {
      units.push_back(common_unit(tests, k));
      const std::string& entry = tests.front().settings[k].entry;
      text +=
        fmt::format(",{}", cell(units[k] && !units[k]->empty() ? fmt::format("{} [{}]", entry, *units[k]) : entry));
    }
  for (const ResultEntry& entry : result_table())
    text += fmt::format(",{}", entry.name);
  text += "\n";
  for (const auto& test : tests)
    {
      text += fmt::format("{},{},{}", cell(test.name), test.record.kind.name, test.record.seed);
      for (std::size_t k = 0; k < n_entries; ++k)
        text += units[k] ? fmt::format(",{}", number_of(test.settings[k])->value)
                         : fmt::format(",{}", cell(test.settings[k].value));
      for (const ResultEntry& entry : result_table())
        {
          const Figure figure = entry.value(test);
          text += figure.value && std::isfinite(*figure.value) ? fmt::format(",{:.10g}", *figure.value) : ",";
        }
      text += "\n";
    }
  write_whole_file(file, text);
}
} // namespace feldspar
