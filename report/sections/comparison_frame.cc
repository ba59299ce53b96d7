#include "report/sections/comparison_frame.h"

#include "base/append.h"
#include "base/text.h"
#include "results/varied_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace feldspar
{
namespace
{
std::string cell(const std::optional<double>& value)
{
  return value && std::isfinite(*value) ? fmt::format("{:.10g}", *value) : "";
}

std::string cell(const std::optional<bool>& value) { return value ? (*value ? "true" : "false") : ""; }

const char* name_of(const SeriesKind kind)
{
  return kind == SeriesKind::specimens         ? "specimens"
         : kind == SeriesKind::finite_elements ? "finite elements"
                                               : "laboratory curve";
}

/// A figure as a series has it or a reference gives it.
struct FrameFigure
{
  std::optional<double> mean = std::nullopt;
  std::optional<double> standard_deviation = std::nullopt;
  std::optional<std::size_t> n = std::nullopt;
  std::optional<double> mean_95_low = std::nullopt;
  std::optional<double> mean_95_high = std::nullopt;
  std::optional<double> range_low = std::nullopt;
  std::optional<double> range_high = std::nullopt;
  std::optional<double> deviation = std::nullopt;
  std::optional<bool> in_range = std::nullopt;
  std::optional<RangeVerdict> verdict = std::nullopt;
};

FrameFigure figure_of(const Statistics& ours)
{
  FrameFigure figure{.mean = ours.mean, .standard_deviation = ours.standard_deviation, .n = ours.n};
  if (ours.confidence_95)
    {
      figure.mean_95_low = ours.mean - *ours.confidence_95;
      figure.mean_95_high = ours.mean + *ours.confidence_95;
    }
  return figure;
}

FrameFigure figure_of(const ReferenceValue& value)
{
  return {.mean = value.mean,
          .standard_deviation = value.standard_deviation,
          .n = value.n,
          .range_low = value.low,
          .range_high = value.high};
}

/// Source, its kind and its varied entries: the first cells of its rows.
using Beginning = std::vector<std::string>;

/// A unit of the page that is a power of ten goes into the numbers.
std::vector<std::string> row_of(const Beginning& source, const std::string& property, const std::string& unit,
                                const FrameFigure& figure)
{
  const bool is_power = is_decimal_number(unit);
  const double scale = is_power ? parse_number(unit) : 1.0;
  const auto scaled = [&](const std::optional<double>& value) {
    return cell(value ? std::optional(*value * scale) : std::nullopt);
  };
  std::vector<std::string> row = source;
  append(row, {property, is_power ? "" : unit, scaled(figure.mean), scaled(figure.standard_deviation),
               figure.n ? fmt::format("{}", *figure.n) : "", scaled(figure.mean_95_low), scaled(figure.mean_95_high),
               scaled(figure.range_low), scaled(figure.range_high), cell(figure.deviation), cell(figure.in_range),
               figure.verdict ? name(*figure.verdict) : ""});
  return row;
}

/// Adds the reference's values of all properties in which the series are compared.
void add_reference(DataFrame& frame, const Findings& findings, const Beginning& source,
                   std::optional<ReferenceValue> ComparisonRow::*value)
{
  std::set<std::string> known;
  for (const std::size_t n : compared_series(findings))
    for (const ComparisonRow& row : findings.comparisons[n])
      if (row.*value && known.insert(row.property).second)
        frame.rows.push_back(row_of(source, row.property, row.unit, figure_of(*(row.*value))));
}

void add_series(DataFrame& frame, const Series& series, const std::vector<ComparisonRow>& comparison,
                const Beginning& source)
{
  for (const ComparisonRow& row : comparison)
    if (row.ours)
      {
        FrameFigure figure = figure_of(*row.ours);
        figure.deviation = row.deviation();
        figure.in_range = row.in_range();
        figure.verdict = row.against_range();
        frame.rows.push_back(row_of(source, row.property, row.unit, figure));
      }
  if (const auto cost = cost_of(series))
    {
      frame.rows.push_back(row_of(source, "grains of a specimen", "", figure_of(cost->grains)));
      frame.rows.push_back(
        row_of(source, "time that passed in all tests of a specimen, each on one core", "s", figure_of(cost->time)));
    }
}
} // namespace

std::vector<std::size_t> compared_series(const Findings& findings)
{
  const bool any_model =
    std::ranges::any_of(findings.all, [](const Series& series) { return series.kind != SeriesKind::laboratory_curve; });
  std::vector<std::size_t> compared;
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    // A single curve is a series of figures of its own; several are the rock beside which the model stands.
    if (!any_model || findings.all[n].kind != SeriesKind::laboratory_curve || findings.all[n].tests.size() > 1)
      compared.push_back(n);
  return compared;
}

std::optional<Cost> cost_of(const Series& series)
{
  std::map<std::uint64_t, std::pair<double, double>> of_seed;
  for (const auto& test : series.tests)
    if (test.record.specimen.n_grains > 0)
      {
        auto& [grains, time] = of_seed[test.record.seed];
        grains = double(test.record.specimen.n_grains);
        time += test.bookkeeping.wall_time;
      }
  std::vector<double> grains, times;
  for (const auto& [seed, cost] : of_seed)
    {
      grains.push_back(cost.first);
      times.push_back(cost.second);
    }
  const auto of_grains = statistics(grains);
  const auto of_times = statistics(times);
  if (!of_grains || !of_times)
    return std::nullopt;
  return Cost{*of_grains, *of_times};
}

DataFrame comparison_frame(const Findings& findings)
{
  const std::vector<std::size_t> compared = compared_series(findings);
  std::vector<std::vector<VariantSetting>> settings;
  for (const std::size_t n : compared)
    settings.push_back(findings.all[n].tests.front().settings);
  const std::vector<VariedColumn> varied = varied_columns(settings);

  DataFrame frame{{"source", "kind"}, {}};
  for (const VariedColumn& column : varied)
    frame.header.push_back(column.heading());
  append(frame.header, {"property", "unit", "mean", "standard_deviation", "n", "mean_95_low", "mean_95_high",
                        "range_low", "range_high", "deviation_from_experiment", "in_experiment_range", "verdict"});

  const auto beginning = [&](const std::string& source, const std::string& kind,
                             const std::vector<VariantSetting>& of_source) {
    Beginning cells{source, kind};
    for (const VariedColumn& column : varied)
      cells.push_back(column.cell(of_source));
    return cells;
  };
  if (findings.reference)
    {
      add_reference(frame, findings, beginning(findings.reference->experiment.label, "experiment", {}),
                    &ComparisonRow::experiment);
      add_reference(frame, findings, beginning(findings.reference->model.label, "reference model", {}),
                    &ComparisonRow::model);
    }
  for (std::size_t k = 0; k < compared.size(); ++k)
    {
      const Series& series = findings.all[compared[k]];
      add_series(frame, series, findings.comparisons[compared[k]],
                 beginning(series.label, name_of(series.kind), settings[k]));
    }
  return frame;
}
} // namespace feldspar
