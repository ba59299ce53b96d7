#include "report/pictures/study_pictures.h"

#include "report/pictures/plane_plot.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

/// A result over which a study is looked at.
struct Property
{
  std::string_view name; ///< of files
  std::string_view title;
  std::string_view unit;
  double scale;
  Figure TestResults::*figure;
};

constexpr std::array properties{
  Property{"strength", "strength", "MPa", mega, &TestResults::peak_stress},
  Property{"youngs_modulus", "Young's modulus, initial", "GPa", giga, &TestResults::youngs_modulus_initial},
  Property{"poissons_ratio", "Poisson's ratio, initial", "", 1.0, &TestResults::poissons_ratio_initial},
  Property{"strain_at_peak", "strain at the peak", "10⁻³", milli, &TestResults::strain_at_peak},
  Property{"crack_initiation", "crack initiation stress", "MPa", mega, &TestResults::crack_initiation_stress},
  Property{"crack_damage", "crack damage stress", "MPa", mega, &TestResults::crack_damage_stress},
  Property{"toughness", "fracture toughness", "MPa √m", mega, &TestResults::fracture_toughness},
  Property{"work_of_fracture", "work of fracture", "J/m²", 1.0, &TestResults::fracture_energy}};

constexpr std::size_t most_lines = 6;

/// The numbers that an entry takes, in one unit.
struct VariedEntry
{
  std::string entry;
  std::string unit;
  std::set<double> values;
};

/// Those with two numbers or more; of other values, or of several units, none.
std::vector<VariedEntry> varied_entries(const std::vector<Series>& all)
{
  std::map<std::string, std::optional<VariedEntry>> found;
  for (const Series& series : all)
    for (const FinishedTest& test : series.tests)
      for (const VariantSetting& setting : test.settings)
        {
          const auto number = number_of(setting);
          auto& entry =
            found.try_emplace(setting.entry, VariedEntry{setting.entry, number ? number->unit : "", {}}).first->second;
          if (!number || (entry && entry->unit != number->unit))
            entry.reset();
          else if (entry)
            entry->values.insert(number->value);
        }
  std::vector<VariedEntry> result;
  for (auto& [name, entry] : found)
    if (entry && entry->values.size() > 1)
      result.push_back(std::move(*entry));
  return result;
}

/// Where a test stands in a picture over an entry: the number there, and all other settings in words.
std::optional<std::pair<double, std::string>> place_of(const FinishedTest& test, const VariedEntry& entry)
{
  std::optional<double> value;
  std::string others;
  for (const VariantSetting& setting : test.settings)
    if (setting.entry == entry.entry)
      value = number_of(setting)->value;
    else
      others += fmt::format(", {} = {}", setting.entry.substr(setting.entry.find('/') + 1), setting.value);
  return value ? std::optional(std::pair(*value, others)) : std::nullopt;
}

/// The results of one line, by the number of the entry.
using Line = std::map<double, std::vector<double>>;

std::vector<std::pair<std::string, Line>> lines_of(const std::vector<Series>& all, const VariedEntry& entry,
                                                   const Property& property)
{
  std::vector<std::pair<std::string, Line>> lines;
  for (const Series& series : all)
    for (const TestGroup& group : groups_of(series))
      for (const FinishedTest* const test : group.tests)
        {
          const auto place = place_of(*test, entry);
          const Figure& figure = test->results.*property.figure;
          if (!place || !test->was_made() || !figure.value)
            continue;
          const std::string label = group.title() + place->second;
          auto line = std::find_if(lines.begin(), lines.end(), [&](const auto& one) { return one.first == label; });
          if (line == lines.end())
            line = lines.insert(lines.end(), {label, {}});
          line->second[place->first].push_back(*figure.value / property.scale);
        }
  std::erase_if(lines, [](const auto& line) { return line.second.size() < 2; });
  return lines;
}

std::string with_unit(const std::string_view name, const std::string_view unit)
{
  return unit.empty() ? std::string(name) : fmt::format("{} [{}]", name, unit);
}
} // namespace

std::vector<Picture> study_pictures(const std::vector<Series>& all)
{
  constexpr int width = 660; // [px]
  std::vector<Picture> pictures;
  for (const VariedEntry& entry : varied_entries(all))
    for (const Property& property : properties)
      {
        const auto lines = lines_of(all, entry, property);
        if (lines.empty() || lines.size() > most_lines)
          continue;
        PlanePlot plotted(
          {.x_label = with_unit(entry.entry, entry.unit), .y_label = with_unit(property.title, property.unit)});
        for (std::size_t n = 0; n < lines.size(); ++n)
          {
            const auto& [label, of_line] = lines[n];
            const std::string of_colour = colour({}, n);
            ChartLine means{.label = label, .colour = of_colour, .width = 2.0};
            ChartLine marks{.kind = ChartLine::Kind::marks, .label = label, .goes_with = label, .colour = of_colour};
            ChartLine bars{.kind = ChartLine::Kind::bars,
                           .label = label,
                           .goes_with = label,
                           .colour = of_colour,
                           .width = 1.4};
            for (const auto& [value, results] : of_line)
              {
                const Statistics of = *statistics(results);
                means.points.push_back({value, of.mean});
                if (!of.standard_deviation)
                  continue;
                for (const double sign : {-1.0, 1.0})
                  bars.points.push_back({value, of.mean + sign * *of.standard_deviation});
                bars.points.push_back(gap);
              }
            marks.points = means.points;
            plotted.add(std::move(means));
            plotted.add(std::move(marks));
            plotted.add(std::move(bars));
          }
        pictures.push_back(
          {.name = fmt::format("study_{}_{}", file_name(entry.entry), property.name),
           .caption = fmt::format("{}{} over {}: mean ± standard deviation over the seeds",
                                  char(std::toupper(property.title.front())), property.title.substr(1), entry.entry),
           .alternative = fmt::format("The {} over the values of {}; the numbers are in the table of the comparison.",
                                      property.title, entry.entry),
           .width = width,
           .height = 420 + plotted.columns().further_height(width),
           .script = plotted.script("set yrange [0:*]\nset offsets graph 0.04, graph 0.04, 0, 0\n" +
                                    plotted.columns().set_up(width) + "\n"),
           .live = plotted.json()});
      }
  return pictures;
}
} // namespace feldspar
