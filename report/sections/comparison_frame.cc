#include "report/sections/tables.h"

#include "base/append.h"
#include "base/mapped.h"
#include "base/text.h"
#include "results/variant_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

using FrameRow = std::vector<std::string>;

/// Lower and upper ends of the interval of a mean, then of the range; none where they are not known.
using Ends = std::array<std::optional<double>, 4>;

/// A row behind `source`, which has the source, its kind and its varied entries. A unit of the page that is a power of ten
/// goes into the numbers. `against_rock` has the last three cells.
template <typename Of>
FrameRow row_of(const FrameRow& source, const std::string& property, const std::string& unit, const Of& figure,
                const Ends& ends, const FrameRow& against_rock)
{
  const bool is_power = is_decimal_number(unit);
  const double scale = is_power ? parse_number(unit) : 1.0;
  const auto scaled = [&](const std::optional<double>& value) {
    return cell(value ? std::optional(*value * scale) : std::nullopt);
  };
  const std::optional<std::size_t> n = figure.n;
  FrameRow row = source;
  append(row, {property, is_power ? "" : unit, scaled(figure.mean), scaled(figure.standard_deviation),
               n ? fmt::format("{}", *n) : ""});
  append(row, mapped<std::string>(ends, scaled));
  append(row, against_rock);
  return row;
}

FrameRow row_of(const FrameRow& source, const std::string& property, const std::string& unit, const Statistics& ours,
                const FrameRow& against_rock = {"", "", ""})
{
  const auto& half = ours.confidence_95;
  const Ends ends{half ? std::optional(ours.mean - *half) : std::nullopt,
                  half ? std::optional(ours.mean + *half) : std::nullopt};
  return row_of(source, property, unit, ours, ends, against_rock);
}

/// Adds the reference's values of all properties in which the series are compared.
void add_reference(DataFrame& frame, const Findings& findings, const FrameRow& source,
                   std::optional<ReferenceValue> ComparisonRow::*member)
{
  std::set<std::string> known;
  for (const std::size_t n : compared_series(findings))
    for (const ComparisonRow& row : findings.comparisons[n])
      if (const auto& value = row.*member; value && known.insert(row.property).second)
        frame.rows.push_back(row_of(source, row.property, row.unit, *value,
                                    {std::nullopt, std::nullopt, value->low, value->high}, {"", "", ""}));
}

void add_series(DataFrame& frame, const Series& series, const std::vector<ComparisonRow>& comparison,
                const FrameRow& source)
{
  for (const ComparisonRow& row : comparison)
    if (row.ours)
      {
        const auto verdict = row.against_range();
        frame.rows.push_back(row_of(source, row.property, row.unit, *row.ours,
                                    {cell(row.deviation()), cell(row.in_range()), verdict ? name(*verdict) : ""}));
      }
  if (const auto cost = cost_of(series))
    {
      frame.rows.push_back(row_of(source, "grains of a specimen", "", cost->grains));
      frame.rows.push_back(
        row_of(source, "time that passed in all tests of a specimen, each on one core", "s", cost->time));
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

  DataFrame frame{{"source", "kind"}};
  for (const VariedColumn& column : varied)
    frame.header.push_back(column.heading());
  append(frame.header, {"property", "unit", "mean", "standard_deviation", "n", "mean_95_low", "mean_95_high",
                        "range_low", "range_high", "deviation_from_experiment", "in_experiment_range", "verdict"});

  const auto beginning = [&](const std::string& source, const std::string& kind,
                             const std::vector<VariantSetting>& of_source) {
    FrameRow cells{source, kind};
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
