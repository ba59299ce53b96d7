#include "base/append.h"
#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "report/pictures/study_lines.h"
#include "results/folder/result_folder.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

constexpr std::size_t most_lines = 6;

/// Selection of lines that a picture of a result shows.
struct Selection
{
  std::vector<StudyLine> lines;
  std::string ending = {}; ///< of the name of its files
  std::string remark = {}; ///< for its caption
  bool joined = true;      ///< the means, by lines
};

/// Returns so many of the lines, the first and the last among them.
std::vector<StudyLine> spread(const std::vector<StudyLine>& lines, const std::size_t n)
{
  std::vector<StudyLine> result;
  for (std::size_t k = 0; k < n; ++k)
    result.push_back(lines[k * (lines.size() - 1) / (n - 1)]);
  return result;
}

/// All in one picture if they have room there; else a picture for each kind of test, of which many lines are thinned out.
std::vector<Selection> selections(const std::vector<Series>& all, const Abscissa& over, const StudiedResult& property)
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
  for (const StudyLine& line : whole.lines)
    {
      const auto same =
        std::ranges::find_if(result, [&](const Selection& one) { return one.lines.front().kind == line.kind; });
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

Pictures lines_picture(const Selection& shown, const Abscissa& over, const StudiedResult& property)
{
  const std::string& entry = over.entry;
  Chart chart{.x = {.label = with_unit(entry, over.unit), .room = 0.04},
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
  return picture_of(std::move(chart), 660, 420,
                    fmt::format("study_{}_{}{}", file_name(entry), property.name, shown.ending),
                    fmt::format("{} over {}: mean ± standard deviation over the seeds{}{}",
                                with_capital(property.title), entry, along, shown.remark),
                    fmt::format("The {} over the values of {}; the numbers are in the table of the comparison.",
                                property.title, entry));
}

/// Results over two entries.
using Cells = std::map<std::array<double, 2>, std::vector<double>>;

/// The results of the tests of one kind and pressure, by the values of the two entries.
Cells cells_of(const std::vector<Series>& all, const std::vector<Abscissa>& over, const StudiedResult& property,
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
            if (setting.entry == over[c].entry)
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
                              const StudiedResult& property, const TestGroup& group)
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
  const std::array<std::string, 2> names{over[0].entry, over[1].entry};
  std::array<ChartAxis, 2> axes;
  for (std::size_t c = 0; c < 2; ++c)
    {
      axes[c] = {.label = with_unit(names[c], over[c].unit), .room = is_grid ? 0.0 : 0.04};
      if (is_grid) // its fields reach beyond the values
        {
          axes[c].from = cell_about(*values[c].begin(), values[c])[0];
          axes[c].to = cell_about(*values[c].rbegin(), values[c])[1];
        }
    }
  return Picture{
    .name = fmt::format("study_map_{}_{}_{}_{}", file_name(names[0]), file_name(names[1]), property.name, group.name()),
    .caption = fmt::format("{}, {}, over {} and {}: mean over the seeds", with_capital(property.title), group.title(),
                           names[0], names[1]),
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
} // namespace

std::vector<Picture> study_pictures(const std::vector<Series>& all)
{
  std::vector<Picture> pictures;
  const std::vector<StudiedResult> properties = studied_results(all);
  const std::vector<Abscissa> over_all = abscissas(all);
  for (const Abscissa& over : over_all)
    for (const StudiedResult& property : properties)
      for (const Selection& selection : selections(all, over, property))
        append(pictures, lines_picture(selection, over, property));
  if (over_all.size() != 2)
    return pictures;
  std::vector<TestGroup> groups;
  for (const Series& series : all)
    for (const TestGroup& group : groups_of(series))
      if (std::ranges::none_of(groups, [&](const TestGroup& one) { return same_conditions(one, group); }))
        groups.push_back(group);
  for (const StudiedResult& property : properties)
    for (const TestGroup& group : shown(groups))
      if (auto map = map_of(all, over_all, property, group))
        pictures.push_back(std::move(*map));
  return pictures;
}
} // namespace feldspar
