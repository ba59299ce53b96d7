#include "report/pictures/study_lines.h"

#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace feldspar
{
namespace
{
/// Entries that take two numbers or more; an entry with other values, or with several units, is left out.
std::vector<Abscissa> varied_entries(const std::vector<Series>& all)
{
  std::map<std::string, std::optional<Abscissa>> found;
  for (const Series& series : all)
    for (const FinishedTest& test : series.tests)
      for (const VariantSetting& setting : test.settings)
        {
          const auto number = number_of(setting);
          auto& entry =
            found.try_emplace(setting.entry, Abscissa{setting.entry, number ? number->unit : "", {}}).first->second;
          if (!number || (entry && entry->unit != number->unit))
            entry.reset();
          else if (entry)
            entry->values.insert(number->value);
        }
  std::vector<Abscissa> result;
  for (auto& [name, entry] : found)
    if (entry && entry->values.size() > 1)
      result.push_back(std::move(*entry));
  return result;
}

/// Returns whether another entry has one value for each number of this one and rises or falls with it: a picture over
/// this entry is then over both. A name that comes with a number goes along, too.
bool goes_along(const std::vector<Series>& all, const Abscissa& entry, const std::string& other)
{
  std::map<double, std::string> companion;
  for (const Series& series : all)
    for (const FinishedTest& test : series.tests)
      {
        std::optional<double> number;
        std::string value;
        for (const VariantSetting& setting : test.settings)
          if (setting.entry == entry.entry)
            number = number_of(setting)->value;
          else if (setting.entry == other)
            value = setting.value;
        if (number && companion.try_emplace(*number, value).first->second != value)
          return false;
      }
  std::vector<double> numbers;
  for (const auto& [number, value] : companion)
    if (const auto of_other = number_of({other, value}))
      numbers.push_back(of_other->value);
  return numbers.size() != companion.size() || std::ranges::is_sorted(numbers) ||
         std::is_sorted(numbers.rbegin(), numbers.rend());
}

} // namespace

std::vector<StudiedResult> studied_results(const std::vector<Series>& all)
{
  std::vector<StudiedResult> named;
  for (const auto& one : test_quantities)
    if (!one.studies.picture.empty())
      named.push_back({one.studies.picture, one.title, one.shown.unit, one.shown.scale, one.figure()});
  if (any_has_flaws(all))
    named.front().title = "highest nominal stress";
  return named;
}

std::vector<Abscissa> abscissas(const std::vector<Series>& all)
{
  std::set<std::string> entries;
  for (const Series& series : all)
    for (const FinishedTest& test : series.tests)
      for (const VariantSetting& setting : test.settings)
        entries.insert(setting.entry);
  std::vector<Abscissa> result;
  for (Abscissa& one : varied_entries(all))
    {
      for (const std::string& other : entries)
        if (other != one.entry && goes_along(all, one, other))
          one.along.insert(other);
      const bool is_known = std::ranges::any_of(result, [&](const Abscissa& before) {
        return before.along.contains(one.entry) && one.along.contains(before.entry);
      });
      if (!is_known)
        result.push_back(std::move(one));
    }
  return result;
}

std::vector<StudyLine> lines_of(const std::vector<Series>& all, const Abscissa& over, const StudiedResult& property,
                                const bool with_others)
{
  std::vector<StudyLine> lines;
  for (const Series& series : all)
    for (const TestGroup& group : groups_of(series))
      for (const FinishedTest* const test : group.tests)
        {
          const Figure& figure = test->results.*property.figure;
          if (!test->counts() || !figure.value)
            continue;
          std::optional<double> value;
          std::string others;
          for (const VariantSetting& setting : test->settings)
            if (setting.entry == over.entry)
              value = number_of(setting)->value;
            else if (with_others && !over.along.contains(setting.entry))
              others += fmt::format("{}{} = {}", others.empty() ? "" : ", ",
                                    setting.entry.substr(setting.entry.find('/') + 1), setting.value);
          if (!value)
            continue;
          auto line = std::ranges::find_if(
            lines, [&](const StudyLine& one) { return one.title == group.title() && one.others == others; });
          if (line == lines.end())
            line = lines.insert(lines.end(), {group.kind, group.title(), others, {}});
          line->results[*value].push_back(*figure.value / property.scale);
        }
  std::erase_if(lines, [](const StudyLine& line) { return line.results.size() < 2; });
  return lines;
}

std::vector<StudyEffect> effects_of(const std::vector<Series>& all, const Abscissa& over)
{
  std::vector<StudyEffect> effects;
  for (const StudiedResult& result : studied_results(all))
    {
      std::vector<StudyEffect> of_tests;
      std::map<std::string, std::map<double, std::vector<double>>> means; // of each line, by test and value
      for (const StudyLine& line : lines_of(all, over, result, true))
        if (line.results.size() == over.values.size())
          {
            if (!means.contains(line.title))
              of_tests.push_back({result, line.title, {}});
            for (const auto& [value, results] : line.results)
              means[line.title][value].push_back(statistics(results)->mean);
          }
      for (StudyEffect& effect : of_tests)
        {
          for (const auto& [value, of_lines] : means[effect.test])
            effect.means[value] = statistics(of_lines)->mean;
          effects.push_back(std::move(effect));
        }
    }
  return effects;
}

double StudyEffect::change() const
{
  const double first = means.begin()->second;
  return first == 0.0 ? 0.0 : means.rbegin()->second / first - 1.0;
}

double StudyEffect::reach() const
{
  const auto [least, most] = extremes();
  const double larger = std::max(std::abs(least->second), std::abs(most->second));
  return larger > 0.0 ? (most->second - least->second) / larger : 0.0;
}
} // namespace feldspar
