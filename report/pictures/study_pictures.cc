#include "base/append.h"
#include "report/chart/gnuplot_writer.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "results/folder/result_folder.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
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

/// A result over which a study is shown.
struct Property
{
  std::string_view name; ///< of files
  std::string_view title;
  std::string_view unit;
  double scale;
  Figure TestResults::*figure;
};

constexpr std::size_t most_lines = 6;

/// The numbers that an entry takes, in one unit.
struct VariedEntry
{
  std::string entry;
  std::string unit;
  std::set<double> values;
};

/// Entries that take two numbers or more; an entry with other values, or with several units, is left out.
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

/// Returns whether another entry has one value for each number of this one and rises or falls with it: a picture over
/// this entry is then over both. A name that comes with a number goes along, too.
bool goes_along(const std::vector<Series>& all, const VariedEntry& entry, const std::string& other)
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
  return numbers.size() != companion.size() || std::is_sorted(numbers.begin(), numbers.end()) ||
         std::is_sorted(numbers.rbegin(), numbers.rend());
}

/// An entry to draw over, with those that go along with it.
struct Abscissa
{
  VariedEntry varied;
  std::set<std::string> along;
};

/// Abscissas of the pictures of a study; of entries that go along with each other, the first.
std::vector<Abscissa> abscissas(const std::vector<Series>& all)
{
  const std::vector<VariedEntry> varied = varied_entries(all);
  std::set<std::string> entries;
  for (const Series& series : all)
    for (const FinishedTest& test : series.tests)
      for (const VariantSetting& setting : test.settings)
        entries.insert(setting.entry);
  std::vector<Abscissa> result;
  for (const VariedEntry& entry : varied)
    {
      Abscissa one{entry, {}};
      for (const std::string& other : entries)
        if (other != entry.entry && goes_along(all, entry, other))
          one.along.insert(other);
      const bool is_known = std::any_of(result.begin(), result.end(), [&](const Abscissa& before) {
        return before.along.contains(entry.entry) && one.along.contains(before.varied.entry);
      });
      if (!is_known)
        result.push_back(std::move(one));
    }
  return result;
}

/// The results of one test of the programme and one combination of the entries that do not go along.
struct Line
{
  TestKind kind;
  std::string title;  ///< of the test
  std::string others; ///< the combination in words; empty: none
  std::map<double, std::vector<double>> results;

  std::string label() const { return others.empty() ? title : title + ", " + others; }
};

std::vector<Line> lines_of(const std::vector<Series>& all, const Abscissa& over, const Property& property,
                           const bool with_others)
{
  std::vector<Line> lines;
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
            if (setting.entry == over.varied.entry)
              value = number_of(setting)->value;
            else if (with_others && !over.along.contains(setting.entry))
              others += fmt::format("{}{} = {}", others.empty() ? "" : ", ",
                                    setting.entry.substr(setting.entry.find('/') + 1), setting.value);
          if (!value)
            continue;
          auto line = std::find_if(lines.begin(), lines.end(),
                                   [&](const Line& one) { return one.title == group.title() && one.others == others; });
          if (line == lines.end())
            line = lines.insert(lines.end(), {group.kind, group.title(), others, {}});
          line->results[*value].push_back(*figure.value / property.scale);
        }
  std::erase_if(lines, [](const Line& line) { return line.results.size() < 2; });
  return lines;
}

/// Selection of lines that a picture of a result shows.
struct Selection
{
  std::vector<Line> lines;
  std::string ending = {}; ///< of the name of its files
  std::string remark = {}; ///< for its caption
  bool joined = true;      ///< the means, by lines
};

/// Returns so many of the lines, the first and the last among them.
std::vector<Line> spread(const std::vector<Line>& lines, const std::size_t n)
{
  std::vector<Line> result;
  for (std::size_t k = 0; k < n; ++k)
    result.push_back(lines[k * (lines.size() - 1) / (n - 1)]);
  return result;
}

/// All in one picture if they have room there; else a picture for each kind of test, of which many lines are thinned out.
std::vector<Selection> selections(const std::vector<Series>& all, const Abscissa& over, const Property& property)
{
  Selection whole{lines_of(all, over, property, true)};
  if (whole.lines.empty()) // no two tests differ in this entry alone
    {
      whole = {lines_of(all, over, property, false), "", "; other entries differ, too", false};
      if (whole.lines.empty())
        return {};
    }
  if (whole.lines.size() <= most_lines)
    return {whole};
  std::vector<Selection> result;
  for (const Line& line : whole.lines)
    {
      const auto same = std::find_if(result.begin(), result.end(),
                                     [&](const Selection& one) { return one.lines.front().kind == line.kind; });
      if (same == result.end())
        result.push_back({{line}, fmt::format("_{}", line.kind.name), whole.remark, whole.joined});
      else
        same->lines.push_back(line);
    }
  for (Selection& one : result)
    if (const std::size_t n = one.lines.size(); n > most_lines)
      {
        one.lines = spread(one.lines, most_lines);
        one.remark += fmt::format("; {} of {} lines, all are in {}", most_lines, n, result_file::tests);
      }
  return result;
}

Picture picture_of(const Selection& shown, const Abscissa& over, const Property& property)
{
  constexpr int width = 660; // [px]
  const std::string& entry = over.varied.entry;
  Chart chart{.x = {.label = with_unit(entry, over.varied.unit), .room = 0.04},
              .y = {.label = with_unit(property.title, property.unit), .from = 0.0}};
  for (std::size_t n = 0; n < shown.lines.size(); ++n)
    {
      ChartSeries means{.kind = shown.joined ? ChartSeries::Kind::marked_line : ChartSeries::Kind::marks,
                        .label = shown.lines[n].label(),
                        .colour = colour({}, n),
                        .bars = ChartSeries::Bars::along_y,
                        .width = shown.joined ? 2.0 : 1.4};
      for (const auto& [value, results] : shown.lines[n].results)
        {
          const Statistics of = *statistics(results);
          const double deviation = of.standard_deviation.value_or(0.0);
          means.points.push_back({value, of.mean, of.mean - deviation, of.mean + deviation});
        }
      chart.series.push_back(std::move(means));
    }
  std::string along;
  for (const std::string& other : over.along)
    along += fmt::format("{}{}", along.empty() ? "; along with it goes " : ", ", other);
  return {.name = fmt::format("study_{}_{}{}", file_name(entry), property.name, shown.ending),
          .caption = fmt::format("{}{} over {}: mean ± standard deviation over the seeds{}{}",
                                 char(std::toupper(property.title.front())), property.title.substr(1), entry, along,
                                 shown.remark),
          .alternative = fmt::format("The {} over the values of {}; the numbers are in the table of the comparison.",
                                     property.title, entry),
          .width = width,
          .height = 420 + further_height(chart, width),
          .panels = {std::move(chart)}};
}

/// Results over two entries.
using Cells = std::map<std::array<double, 2>, std::vector<double>>;

/// The results of the tests of one kind and pressure, by the values of the two entries.
Cells cells_of(const std::vector<Series>& all, const std::vector<Abscissa>& over, const Property& property,
               const TestGroup& wanted)
{
  Cells cells;
  for (const Series& series : all)
    for (const FinishedTest& test : series.tests)
      {
        const Figure& figure = test.results.*property.figure;
        if (!test.counts() || !figure.value || !same_conditions(group_of(test.record), wanted))
          continue;
        std::array<std::optional<double>, 2> place;
        for (const VariantSetting& setting : test.settings)
          for (std::size_t c = 0; c < 2; ++c)
            if (setting.entry == over[c].varied.entry)
              place[c] = number_of(setting)->value;
        if (place[0] && place[1])
          cells[{*place[0], *place[1]}].push_back(*figure.value / property.scale);
      }
  return cells;
}

/// Lower and upper end of the cell of a value: halfway to the values beside it; at the ends as far outwards as inwards.
std::array<double, 2> cell_about(const double value, const std::set<double>& values)
{
  const auto at = values.find(value);
  const auto next = std::next(at);
  const double below = at == values.begin() ? *next - value : value - *std::prev(at);
  const double above = next == values.end() ? below : *next - value;
  return {value - 0.5 * below, value + 0.5 * above};
}

/// A map of a result over two entries: a grid as fields with their means, other designs as points.
std::optional<Picture> map_of(const std::vector<Series>& all, const std::vector<Abscissa>& over,
                              const Property& property, const TestGroup& group)
{
  constexpr std::size_t fewest = 4;       // less is no map
  constexpr std::size_t most_labels = 80; // beyond them numbers run into each other
  const Cells cells = cells_of(all, over, property, group);
  std::array<std::set<double>, 2> values;
  for (const auto& [place, results] : cells)
    for (std::size_t c = 0; c < 2; ++c)
      values[c].insert(place[c]);
  if (cells.size() < fewest || values[0].size() < 2 || values[1].size() < 2)
    return std::nullopt;
  const bool is_grid = cells.size() == values[0].size() * values[1].size();
  ChartSeries fields{.kind = is_grid ? ChartSeries::Kind::area : ChartSeries::Kind::marks,
                     .colours = ChartSeries::Colours::by_value,
                     .width = 1.0,
                     .size = 2.4};
  ChartSeries numbers{.kind = ChartSeries::Kind::texts, .colour = black, .size = 11.0};
  // Numbers stand on fields, but above points.
  const double above = is_grid ? 0.0 : 0.04 * (*values[1].rbegin() - *values[1].begin());
  for (const auto& [place, results] : cells)
    {
      const auto& [x, y] = place;
      const auto [left, right] = cell_about(x, values[0]);
      const auto [bottom, top] = cell_about(y, values[1]);
      const double mean = statistics(results)->mean;
      if (is_grid)
        append(fields.points, {{left, bottom, 0.0, mean},
                               {right, bottom, 0.0, mean},
                               {right, top, 0.0, mean},
                               {left, top, 0.0, mean},
                               gap});
      else
        fields.points.push_back({x, y, 0.0, mean});
      numbers.points.push_back({x, y + above});
      numbers.texts.push_back(fmt::format("{:.4g}", mean));
    }
  if (cells.size() > most_labels)
    numbers = {};
  const std::array<std::string, 2> names{over[0].varied.entry, over[1].varied.entry};
  std::array<ChartAxis, 2> axes;
  for (std::size_t c = 0; c < 2; ++c)
    {
      axes[c] = {.label = with_unit(names[c], over[c].varied.unit), .room = is_grid ? 0.0 : 0.04};
      if (is_grid) // its fields reach beyond the values
        {
          axes[c].from = cell_about(*values[c].begin(), values[c])[0];
          axes[c].to = cell_about(*values[c].rbegin(), values[c])[1];
        }
    }
  return Picture{
    .name = fmt::format("study_map_{}_{}_{}_{}", file_name(names[0]), file_name(names[1]), property.name, group.name()),
    .caption = fmt::format("{}{}, {}, over {} and {}: mean over the seeds", char(std::toupper(property.title.front())),
                           property.title.substr(1), group.title(), names[0], names[1]),
    .alternative = fmt::format("A map of the {} over {} and {}; the numbers are in the table of the comparison.",
                               property.title, names[0], names[1]),
    .width = 660,
    .height = 480,
    .panels = {{.x = axes[0],
                .y = axes[1],
                .colour = {.label = with_unit(property.title, property.unit)},
                .palette = {"#deebf7", "#9ecae1", "#4292c6"},
                .key_columns = 1,
                .series = {std::move(fields), std::move(numbers)}}}};
}

/// The quantities that studies show. Named for what they are: of a body with flaws the highest stress is a nominal one.
std::vector<Property> properties_of(const std::vector<Series>& all)
{
  std::vector<Property> named;
  for (const auto& one : test_quantities)
    if (!one.studies.picture.empty())
      named.push_back({one.studies.picture, one.title, one.shown.unit, one.shown.scale, one.figure()});
  if (any_has_flaws(all))
    named.front().title = "highest nominal stress";
  return named;
}

std::vector<Picture> maps(const std::vector<Series>& all, const std::vector<Abscissa>& over)
{
  if (over.size() != 2)
    return {};
  std::vector<TestGroup> groups;
  for (const Series& series : all)
    for (const TestGroup& group : groups_of(series))
      if (std::none_of(groups.begin(), groups.end(), [&](const TestGroup& one) { return same_conditions(one, group); }))
        groups.push_back(group);
  std::vector<Picture> pictures;
  for (const Property& property : properties_of(all))
    for (const TestGroup& group : shown(groups))
      if (auto map = map_of(all, over, property, group))
        pictures.push_back(std::move(*map));
  return pictures;
}
} // namespace

std::vector<Picture> study_pictures(const std::vector<Series>& all)
{
  std::vector<Picture> pictures;
  const std::vector<Abscissa> over_all = abscissas(all);
  for (const Abscissa& over : over_all)
    for (const Property& property : properties_of(all))
      for (const Selection& selection : selections(all, over, property))
        pictures.push_back(picture_of(selection, over, property));
  append(pictures, maps(all, over_all));
  return pictures;
}
} // namespace feldspar
