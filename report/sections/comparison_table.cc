#include "report/sections/tables.h"

#include "base/append.h"
#include "base/contains.h"
#include "report/pictures/plot_style.h"
#include "report/sections/text.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
namespace
{
using namespace text;

const std::string note_on_ranges =
  "Range: does our mean lie in that of the experiments? Not decided: it lies outside, but "
  "its 95 % interval reaches into the range, or there is one specimen.";

std::string against_experiment(const ComparisonRow& row)
{
  if (!row.ours || !row.experiment)
    return none;
  const std::string deviation =
    row.deviation() ? signed_percent(*row.deviation()) : ""; // none where only a range is known
  const auto found = row.against_range();
  if (!found)
    return "no range given" + (deviation.empty() ? "" : ", " + deviation);
  return (found == RangeVerdict::within    ? "✓ "
          : found == RangeVerdict::outside ? "✗ "
                                           : "? ") +
         (deviation.empty() ? "" : deviation + ", ") +
         (found == RangeVerdict::within    ? "in range"
          : found == RangeVerdict::outside ? "out of range"
                                           : "not decided");
}

/// A line of the comparison: heading, model, experiment, model against experiment and so on of one series; of several
/// the experiment before them and the reference's model behind them.
std::vector<std::string> arranged(const std::string& heading, const std::vector<std::string>& rock,
                                  const std::vector<std::string>& ours, const bool one)
{
  std::vector<std::string> line{heading};
  if (one && !rock.empty())
    append(line, {ours[0], rock[0], ours[1], ours[2], rock[1]});
  else
    {
      if (!rock.empty())
        line.push_back(rock[0]);
      append(line, ours);
      if (!rock.empty())
        line.push_back(rock[1]);
    }
  return line;
}

/// Ours: mean, standard deviation and the number of specimens, or the values of two.
std::string as_text(const ComparisonRow& row)
{
  if (!row.ours)
    return none;
  const std::string text = mean_and_deviation(*row.ours, 1.0, row.decimals);
  return row.ours->n == 2 ? text : fmt::format("{} (n = {})", text, row.ours->n);
}

/// A property of these series with the cells of the reference.
struct ComparedProperty
{
  std::string name;
  std::string heading = {};
  std::vector<std::string> experiment_and_model = {none, none};
  std::vector<const ComparisonRow*> rows = {}; ///< of each series; an empty row where it has none
};

/// Properties of these series in the order in which they come.
std::vector<ComparedProperty> compared_properties(const Findings& findings, const std::vector<std::size_t>& compared)
{
  static const ComparisonRow nothing{};
  std::vector<ComparedProperty> properties;
  for (const std::size_t n : compared)
    for (const auto& row : findings.comparisons[n])
      if ((row.ours || row.experiment || row.model) && !contains(properties, row.property, &ComparedProperty::name))
        properties.push_back({row.property});
  for (auto& [name, heading, experiment_and_model, rows] : properties)
    for (const std::size_t n : compared)
      {
        const auto found = std::ranges::find(findings.comparisons[n], name, &ComparisonRow::property);
        rows.push_back(found == findings.comparisons[n].end() ? &nothing : &*found);
        const ComparisonRow& row = *rows.back();
        if (&row != &nothing)
          heading = with_unit(row.property, row.unit);
        if (row.experiment)
          experiment_and_model[0] = as_text(row, row.experiment);
        if (row.model)
          experiment_and_model[1] = as_text(row, row.model);
      }
  return properties;
}

/// Grains and time of a specimen.
std::array<std::string, 2> cost_cells(const Series& series)
{
  const auto cost = cost_of(series);
  return {cost ? mean_and_deviation(cost->grains, 1.0, 0) : none, cost ? mean_and_deviation(cost->time, 1.0, 0) : none};
}

constexpr std::array cost_headings{"grains of a specimen",
                                   "time that passed in all tests of a specimen, each on one core [s]"};

/// A sentence on how sure the standard deviations are, by the fewest specimens of any; empty where no result has one.
std::string deviation_note(const Findings& findings, const std::vector<std::size_t>& compared)
{
  std::optional<std::size_t> fewest;
  for (const std::size_t k : compared)
    for (const auto& row : findings.comparisons[k])
      if (row.ours && row.ours->n > 2 && (!fewest || row.ours->n < *fewest))
        fewest = row.ours->n;
  if (!fewest)
    return "";
  const Interval over_shown = deviation_interval_95(*fewest);
  return fmt::format(
    "; of {} specimens it is itself uncertain: with 95 % the rock's is {:.2f} to {:.2f} times as large", *fewest,
    over_shown.low, over_shown.high);
}

/// Measured curves of one kind and pressure beside the model's tests; the table has no name yet.
Table measured_table(const Findings& findings, const TestGroup& curve, const std::string& label)
{
  const PropertySource source = curve.envelope_role() == EnvelopeRole::tension ? PropertySource::tension
                                : curve.envelope_role() == EnvelopeRole::indirect_tension
                                  ? PropertySource::indirect_tension
                                  : PropertySource::compression;
  Table table{"",
              curve.title() + ": measured and model, mean ± standard deviation over the seeds",
              {"property", label}};
  // The model was hardly pressed with just the pressure of the laboratory.
  const auto is_alike = [&](const TestGroup& group) {
    return group.kind == curve.kind && group.intermediate_stress == curve.intermediate_stress &&
           std::abs(group.confining_pressure - curve.confining_pressure) <=
             0.05 * std::max(group.confining_pressure, curve.confining_pressure);
  };
  std::vector<TestGroup> beside;
  for (const auto& series : findings.all)
    if (series.kind != SeriesKind::laboratory_curve)
      for (const auto& group : groups_of(series))
        if (is_alike(group))
          {
            beside.push_back(group);
            table.header.push_back(group.confining_pressure == curve.confining_pressure
                                     ? series.label
                                     : series.label + ", " + group.title());
          }
  for (const RockProperty& property : rock_properties)
    if (property.source == source && !property.choice.hidden_otherwise)
      {
        const auto& [unit, scale, decimals] = quantity_of(property.figure).shown;
        const auto over_curves = statistics(values(curve, property.figure));
        const Figure& first = curve.tests.front()->results.*property.figure;
        std::vector<std::string> row{with_unit(quantity_of(property.figure).title, unit),
                                     curve.tests.size() == 1 && first.value ? number(first, scale, decimals)
                                     : over_curves ? mean_and_deviation(over_curves, scale, decimals)
                                                   : fmt::format("{} ({})", none, first.reason)};
        for (const auto& group : beside)
          row.push_back(mean_and_deviation(statistics(values(group, property.figure)), scale, decimals));
        table.rows.push_back(row);
      }
  if (beside.empty())
    table.caption += "; the model was not tested so";
  return table;
}
} // namespace

Table comparison_of_many(const Findings& findings)
{
  const std::vector<std::size_t> compared = compared_series(findings);
  Table table{"comparison",
              "Model and rock. ± is the standard deviation over the seeds" + deviation_note(findings, compared) + ". " +
                note_on_ranges,
              {"series"},
              {},
              comparison_frame(findings)};
  std::vector<std::vector<std::string>> of_reference; // experiment and model
  if (findings.reference)
    of_reference = {{findings.reference->experiment.label + ", mean (range)"}, {findings.reference->model.label}};
  for (const std::size_t n : compared)
    table.rows.push_back({findings.all[n].label});
  for (const ComparedProperty& property : compared_properties(findings, compared))
    {
      append(table.header, {property.heading, property.name + " against experiment"});
      for (std::size_t k = 0; k < compared.size(); ++k)
        append(table.rows[k], {as_text(*property.rows[k]), against_experiment(*property.rows[k])});
      for (std::size_t k = 0; k < of_reference.size(); ++k)
        append(of_reference[k], {property.experiment_and_model[k], none});
    }
  for (std::size_t c = 0; c < cost_headings.size(); ++c)
    {
      table.header.emplace_back(cost_headings[c]);
      for (std::size_t k = 0; k < compared.size(); ++k)
        table.rows[k].push_back(cost_cells(findings.all[compared[k]])[c]);
    }
  table.rows.insert(table.rows.begin(), of_reference.begin(), of_reference.end());
  return table;
}

Table comparison_table(const Findings& findings)
{
  const std::vector<std::size_t> compared = compared_series(findings);
  const bool any_model = findings.all[compared.front()].kind != SeriesKind::laboratory_curve;
  const bool one = compared.size() == 1;

  Table table{
    "comparison",
    "Model and rock. ± is the standard deviation over the seeds" + deviation_note(findings, compared) +
      ". The interval is that of the mean, 95 %, by Student's t, from three specimens on and where it does not reach 0. " +
      note_on_ranges,
    {},
    {},
    comparison_frame(findings)};
  // With one series the model stands beside the rock; with several, each is compared with the rock, which comes first.
  std::vector<std::string> rock;
  if (findings.reference)
    rock = {findings.reference->experiment.label + ", mean (range)", findings.reference->model.label};
  std::vector<std::string> of_series;
  for (const std::size_t n : compared)
    append(of_series,
           {one && any_model ? "model" : findings.all[n].label, "against experiment", "95 % interval of the mean"});
  table.header = arranged("property", rock, of_series, one);
  for (const ComparedProperty& property : compared_properties(findings, compared))
    {
      std::vector<std::string> ours;
      for (const ComparisonRow* const row : property.rows)
        append(ours, {as_text(*row), against_experiment(*row), interval(row->ours, 1.0, row->decimals)});
      if (findings.reference)
        rock = property.experiment_and_model;
      table.rows.push_back(arranged(property.heading, rock, ours, one));
    }
  rock.assign(rock.size(), none);
  // Series of one rock are also told apart by what they cost.
  for (std::size_t c = 0; c < cost_headings.size() && !one; ++c)
    {
      std::vector<std::string> ours;
      for (const std::size_t n : compared)
        append(ours, {cost_cells(findings.all[n])[c], none, none});
      table.rows.push_back(arranged(cost_headings[c], rock, ours, one));
    }
  return table;
}

std::vector<Table> measured_tables(const Findings& findings, const std::size_t n)
{
  const Series& measured = findings.all[n];
  const auto groups = groups_of(measured);
  std::vector<Table> tables;
  for (const TestGroup& group : groups)
    {
      tables.push_back(measured_table(findings, group, measured.label));
      tables.back().name = fmt::format("measured_{}_{}", n + 1, plot::file_name(measured.label)) +
                           (groups.size() > 1 ? "_" + group.name() : "");
    }
  return tables;
}
} // namespace feldspar
