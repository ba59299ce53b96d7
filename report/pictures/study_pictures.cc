#include "report/pictures/study_pictures.h"

#include "base/append.h"
#include "report/pictures/plane_plot.h"
#include "results/folder/result_folder.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

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

/// A result over which a study is looked at.
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

/// Whether another entry has one value for each number of this one, and the more the more, or the less: a picture over this
/// one is then over both. A name that comes with a number goes along, too.
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

/// Of entries that go along with each other the first.
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

/// What a picture shows of a result.
struct Selection
{
  std::vector<Line> lines;
  std::string ending = {}; ///< of the name of its files
  std::string remark = {}; ///< for its caption
  bool joined = true;      ///< the means, by lines
};

/// So many of them, the first and the last among them.
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
  PlanePlot plotted(
    {.x_label = with_unit(entry, over.varied.unit), .y_label = with_unit(property.title, property.unit)});
  for (std::size_t n = 0; n < shown.lines.size(); ++n)
    {
      const std::string label = shown.lines[n].label();
      const std::string of_colour = colour({}, n);
      ChartLine means{.label = label, .colour = of_colour, .width = 2.0};
      ChartLine marks{.kind = ChartLine::Kind::marks, .label = label, .goes_with = label, .colour = of_colour};
      ChartLine bars{.kind = ChartLine::Kind::bars,
                     .label = label,
                     .goes_with = label,
                     .colour = of_colour,
                     .width = 1.4};
      for (const auto& [value, results] : shown.lines[n].results)
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
      if (shown.joined)
        plotted.add(std::move(means));
      else
        marks.goes_with.clear();
      plotted.add(std::move(marks));
      plotted.add(std::move(bars));
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
          .height = 420 + plotted.columns().further_height(width),
          .script = plotted.script("set yrange [0:*]\nset offsets graph 0.04, graph 0.04, 0, 0\n" +
                                   plotted.columns().set_up(width) + "\n"),
          .live = plotted.json()};
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
  std::string rows;
  for (const auto& [place, results] : cells)
    {
      const auto [left, right] = cell_about(place[0], values[0]);
      const auto [bottom, top] = cell_about(place[1], values[1]);
      rows += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.5g} {:.4g}\n", place[0], place[1], left, right,
                          bottom, top, statistics(results)->mean, statistics(results)->mean);
    }
  const std::string& x = over[0].varied.entry;
  const std::string& y = over[1].varied.entry;
  std::string plots = is_grid ? "plot $map using 1:2:3:4:5:6:7 with boxxyerror fill solid noborder lc palette notitle"
                              : "plot $map using 1:2:7 with points pt 7 ps 2.4 lc palette notitle";
  if (cells.size() <= most_labels)
    plots += fmt::format(", $map using 1:2:8 with labels{} font ',11' notitle", is_grid ? "" : " offset 0,1");
  return Picture{
    .name = fmt::format("study_map_{}_{}_{}_{}", file_name(x), file_name(y), property.name, group.name()),
    .caption = fmt::format("{}{}, {}, over {} and {}: mean over the seeds", char(std::toupper(property.title.front())),
                           property.title.substr(1), group.title(), x, y),
    .alternative = fmt::format("A map of the {} over {} and {}; the numbers are in the table of the comparison.",
                               property.title, x, y),
    .width = 660,
    .height = 480,
    .script = fmt::format("$map << EOD\n{}EOD\n", rows) +
              frame(with_unit(x, over[0].varied.unit), with_unit(y, over[1].varied.unit)) +
              "unset grid\nset palette defined (0 '#deebf7', 1 '#9ecae1', 2 '#4292c6')\nset offsets graph 0.01, graph "
              "0.01, graph 0.01, graph 0.01\n" +
              fmt::format("set cblabel {}\n", gnuplot_text(with_unit(property.title, property.unit))) + plots + "\n"};
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
