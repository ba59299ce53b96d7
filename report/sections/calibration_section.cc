#include "base/contains.h"
#include "report/pictures/calibration_pictures.h"
#include "report/sections/sections.h"
#include "report/sections/text.h"
#include "report/sections/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
using namespace text;

std::string shown(const double si_value, const ShownUnit& unit, const int figures = 3)
{
  return significant(si_value / unit.size, figures);
}

std::string shown_interval(const double si_low, const double si_high, const ShownUnit& unit)
{
  return fmt::format("{} to {}", shown(si_low, unit), shown(si_high, unit));
}

/// Returns whether specimens with the answer's parameters were tested. Only then are there medians, even where every
/// test of them failed.
bool was_tested(const CalibrationRecord& record)
{
  return std::ranges::any_of(record.parameters, [](const auto& row) { return row.median.has_value(); });
}

/// The decision on all targets in a sentence.
std::string decision_on(const CalibrationRecord& record)
{
  std::vector<std::string> missed, open;
  for (const auto& row : record.targets)
    if (row.verdict == TargetVerdict::missed)
      missed.push_back(row.title);
    else if (row.verdict == TargetVerdict::not_decided)
      open.push_back(row.title);
  const std::string tolerance = fmt::format("{:g} %", 100.0 * record.tolerance);
  const std::size_t n = record.targets.size();
  const std::size_t n_reached = n - missed.size() - open.size();
  if (missed.empty() && open.empty())
    return fmt::format("Reached. {} within {} of the laboratory's value.",
                       n == 1 ? "The target lies" : fmt::format("All {} targets lie", n), tolerance);
  std::string decision;
  if (!missed.empty())
    decision = fmt::format("Missed. {} more than {} off", subject_of(missed, "is", "are"), tolerance);
  if (!open.empty())
    decision +=
      fmt::format("{}{} more packings", decision.empty() ? "Not decided. " : ". ", subject_of(open, "needs", "need"));
  return decision + fmt::format("; {} of {} targets {} reached.", n_reached, n, n_reached == 1 ? "is" : "are");
}

/// A target as a tile: the mean with its 95 % interval on a bar with the tolerance.
Tile tile_of(const CalibrationRecord::TargetRow& row, const double tolerance)
{
  const ShownUnit unit = shown_unit(row.unit, row.target);
  const std::string behind = (unit.name.empty() ? "" : " ") + unit.name;
  const auto n = std::size_t(row.n_packings > 0.0 ? std::min(row.n_packings, 1e9) : 0.0);
  const double size = std::abs(row.target);
  const TargetMean mean{row.title, row.deviation,
                        row.standard_error ? std::optional(*row.standard_error / size) : std::nullopt, n};
  Tile tile{.property = row.title,
            .value = shown(row.reached, unit, 4) + behind,
            .notes = fmt::format("target {}{}, {}; {}", shown(row.target, unit, 4), behind,
                                 signed_percent(row.deviation), n > 0 ? words(row.verdict) : "predicted, not tested"),
            .n = n,
            .mean = row.reached,
            .deviation = size * mean.half_width().value_or(0.0),
            .low = row.target - tolerance * size,
            .high = row.target + tolerance * size};
  if (row.verdict == TargetVerdict::not_decided)
    tile.mark = n > 0 ? TileMark::not_decided : TileMark::none;
  else
    tile.mark = row.verdict == TargetVerdict::reached ? TileMark::good : TileMark::bad;
  return tile;
}

Table target_table(const CalibrationRecord& record)
{
  const bool tested = was_tested(record);
  Table table{
    "calibration_targets",
    tested ? "Targets, and what the answer reached on packings by which nothing was chosen"
           : "Targets, and what the surrogates predict of the nearest micro-parameters; no specimen tested them",
    {"figure", "target", tested ? "reached" : "predicted", "standard error", "deviation", "packings", "verdict"}};
  for (const auto& row : record.targets)
    {
      const ShownUnit unit = shown_unit(row.unit, row.target);
      const bool is_prediction = tested && !(row.n_packings > 0.0);
      table.rows.push_back({with_unit(row.title, unit.name), shown(row.target, unit, 4),
                            shown(row.reached, unit, 4) + (is_prediction ? " (predicted)" : ""),
                            row.standard_error ? shown(*row.standard_error, unit, 2) : none,
                            signed_percent(row.deviation), row.n_packings > 0.0 ? number(row.n_packings, 0) : none,
                            words(row.verdict)});
    }
  return table;
}

Table parameter_table_of(const CalibrationRecord& record)
{
  const bool tested = was_tested(record);
  Table table{"calibration_parameters",
              tested ? "Micro-parameters: those of the answer, and what else agrees with the tests"
                     : "Micro-parameters that come nearest to the targets",
              {"parameter", tested ? "answer" : "nearest", "median", "90 % interval", "verdict"}};
  for (const auto& row : record.parameters)
    {
      const ShownUnit unit = shown_unit(row.unit, row.best);
      table.rows.push_back(
        {with_unit(row.title, unit.name), shown(row.best, unit), row.median ? shown(*row.median, unit) : none,
         row.lower_90 && row.upper_90 ? shown_interval(*row.lower_90, *row.upper_90, unit) : none, row.verdict});
    }
  return table;
}

Table prediction_table(const CalibrationRecord& record)
{
  Table table{"calibration_predictions",
              "Figures of the tests that were no targets: the band in which 90 % of what agrees with the targets lies",
              {"figure", "median", "90 % interval"}};
  for (const auto& row : record.predictions)
    if (!contains(record.targets, row.name, &CalibrationRecord::TargetRow::name))
      {
        const ShownUnit unit = shown_unit(row.unit, row.median);
        table.rows.push_back(
          {with_unit(row.title, unit.name), shown(row.median, unit), shown_interval(row.lower_90, row.upper_90, unit)});
      }
  return table;
}

/// Title of a figure or a parameter in tables.
template <typename Row>
std::string title_in(const std::vector<Row>& rows, const std::string& name, const std::string& otherwise)
{
  const auto found = std::ranges::find(rows, name, &Row::name);
  return found == rows.end() ? otherwise : found->title;
}

std::string words_of_name(std::string name)
{
  std::ranges::replace(name, '_', ' ');
  return name;
}

Table sensitivity_table(const CalibrationRecord& record)
{
  Table table{
    "calibration_sensitivities",
    "Sobol indices: the share of a figure's variance between the bounds that a ratio alone explains, and with "
    "its interactions. They are of what is left beside the scales and the intact rock: strengths over the "
    "bond strength, Young's modulus over that of intact cells, Poisson's ratio less that of intact cells",
    {"figure", "ratio", "alone", "in all"}};
  for (const auto& row : record.sensitivities)
    table.rows.push_back(
      {title_in(record.targets, row.response, title_in(record.predictions, row.response, words_of_name(row.response))),
       title_in(record.parameters, row.parameter, words_of_name(row.parameter)), number(row.first_order, 2),
       number(row.total, 2)});
  return table;
}
} // namespace

PageSection calibration_section(const CalibrationRecord& record, PictureBook& book)
{
  const bool tested = was_tested(record);
  PageSection section{"calibration", "Calibration",
                      tested ? "Were the targets reached?" : "Which micro-parameters come nearest to the targets?"};
  PageBlock block;
  block.headline = tested ? decision_on(record) : sentence(record.statement);
  for (const auto& row : record.targets)
    block.tiles.push_back(tile_of(row, record.tolerance));
  if (!tested)
    block.paragraphs.push_back("The answer was not tested, because the surrogates of the design already tell this. "
                               "nearest.prm has the nearest micro-parameters, design.csv every test of the design.");
  else
    {
      if (record.verdict != TargetVerdict::reached)
        block.paragraphs.push_back(sentence(record.statement));
      block.paragraphs.push_back(fmt::format(
        "A target is reached if the 95 % interval of its mean over packings lies within the tolerance of {:g} %, "
        "missed if the interval lies beyond it, and else not decided.",
        100.0 * record.tolerance));
    }
  block.tables.push_back(target_table(record));
  if (!record.parameters.empty())
    block.tables.push_back(parameter_table_of(record));
  for (const auto& row : record.parameters)
    if (!row.sentence.empty())
      block.points.push_back(row.sentence);
  block.pictures = book.keep(pair_picture(record));
  section.blocks.push_back(block);
  PageBlock more;
  if (Table table = prediction_table(record); !table.rows.empty())
    more.tables.push_back(std::move(table));
  if (!record.sensitivities.empty())
    more.tables.push_back(sensitivity_table(record));
  if (!more.tables.empty())
    section.blocks.push_back(more);
  return section;
}
} // namespace feldspar
