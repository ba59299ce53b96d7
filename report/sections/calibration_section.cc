#include "report/pictures/calibration_pictures.h"
#include "report/sections/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace feldspar
{
namespace
{
/// To so many figures in the unit of tables.
std::string shown(const double si_value, const ShownUnit& unit, const int figures = 3)
{
  return fmt::format("{:#.{}g}", si_value / unit.size, figures);
}

std::string heading(const std::string& title, const ShownUnit& unit)
{
  return unit.name.empty() ? title : fmt::format("{} [{}]", title, unit.name);
}

Table target_table(const CalibrationRecord& record)
{
  Table table{"calibration_targets",
              "Targets, and what the answer reached on packings by which nothing was chosen",
              {"figure", "target", "reached", "standard error", "deviation", "packings"},
              {}};
  for (const auto& row : record.targets)
    {
      const ShownUnit unit = shown_unit(row.unit, row.target);
      table.rows.push_back({heading(row.title, unit), shown(row.target, unit, 4), shown(row.reached, unit, 4),
                            row.standard_error ? shown(*row.standard_error, unit, 2) : "-",
                            fmt::format("{:+.1f} %", 100.0 * row.deviation), fmt::format("{:.0f}", row.n_packings)});
    }
  return table;
}

Table parameter_table_of(const CalibrationRecord& record)
{
  Table table{"calibration_parameters",
              "Micro-parameters: those of the answer, and what else agrees with the tests",
              {"parameter", "answer", "median", "90 % interval", "verdict"},
              {}};
  for (const auto& row : record.parameters)
    {
      const ShownUnit unit = shown_unit(row.unit, row.best);
      table.rows.push_back({heading(row.title, unit), shown(row.best, unit), shown(row.median, unit),
                            fmt::format("{} to {}", shown(row.lower_90, unit), shown(row.upper_90, unit)),
                            row.verdict});
    }
  return table;
}

Table prediction_table(const CalibrationRecord& record)
{
  Table table{"calibration_predictions",
              "Figures of the tests that were no targets: the band in which 90 % of what agrees with the targets lies",
              {"figure", "median", "90 % interval"},
              {}};
  for (const auto& row : record.predictions)
    {
      const bool is_target = std::any_of(record.targets.begin(), record.targets.end(),
                                         [&](const auto& target) { return target.name == row.name; });
      const ShownUnit unit = shown_unit(row.unit, row.median);
      if (!is_target)
        table.rows.push_back({heading(row.title, unit), shown(row.median, unit),
                              fmt::format("{} to {}", shown(row.lower_90, unit), shown(row.upper_90, unit))});
    }
  return table;
}

Table sensitivity_table(const CalibrationRecord& record)
{
  Table table{
    "calibration_sensitivities",
    "Sobol indices: the share of a figure's variance between the bounds that a ratio alone explains, and with "
    "its interactions; stresses over the bond strength, moduli over the intact rock's",
    {"figure", "ratio", "alone", "in all"},
    {}};
  for (const auto& row : record.sensitivities)
    table.rows.push_back(
      {row.response, row.parameter, fmt::format("{:.2f}", row.first_order), fmt::format("{:.2f}", row.total)});
  return table;
}
} // namespace

PageSection calibration_section(const CalibrationRecord& record, PictureBook& book)
{
  PageSection section{"calibration", "Calibration", "How the micro-parameters were found", {}};
  PageBlock block;
  block.headline = record.statement;
  block.tables.push_back(target_table(record));
  block.tables.push_back(parameter_table_of(record));
  for (const auto& row : record.parameters)
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
