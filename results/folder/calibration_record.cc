#include "results/folder/calibration_record.h"

#include "base/input_error.h"
#include "base/json_text.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/table/csv.h"
#include "laboratory/named_entries.h"
#include "results/folder/provenance_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

std::string text(const Json& json, const char* key) { return printable(json.at(key).get<std::string>()); }

double number(const Json& json, const char* key) { return json.at(key).get<double>(); }

std::optional<double> number_if_any(const Json& json, const char* key)
{
  return json.contains(key) ? std::optional(number(json, key)) : std::nullopt;
}

ElasticFigures elastic_figures(const Provenance& made_by)
{
  ElasticFigures figures;
  if (const std::string given = made_by.value_of(input_entries::elastic_modulus); !given.empty())
    figures.youngs_modulus = given;
  if (const std::string given = made_by.value_of(input_entries::lateral_ratio); !given.empty())
    figures.poissons_ratio = given;
  return figures;
}

/// The mean of a target's packings. A file may hold any number of them.
TargetMean mean_of(const CalibrationRecord::TargetRow& row)
{
  constexpr double most = 1e9;
  const std::size_t n = row.n_packings > 0.0 ? std::size_t(std::min(row.n_packings, most)) : 0;
  return {row.title, row.deviation,
          row.standard_error ? std::optional(std::abs(*row.standard_error / row.target)) : std::nullopt, n};
}

/// Verdicts, and the statement, of a file that has none.
void judge(CalibrationRecord& record)
{
  const auto means = mapped<TargetMean>(record.targets, [&](const auto& row) { return mean_of(row); });
  const bool was_tested = std::ranges::any_of(means, [](const TargetMean& mean) { return mean.n > 0; });
  std::vector<TargetVerdict> verdicts;
  for (std::size_t t = 0; t < means.size(); ++t)
    {
      // A calibration without tests of its answer had found its targets out of reach.
      const bool is_out_of_reach = !was_tested && std::abs(means[t].deviation) > record.tolerance;
      record.targets[t].verdict = is_out_of_reach ? TargetVerdict::missed : verdict_on(means[t], record.tolerance);
      verdicts.push_back(record.targets[t].verdict);
    }
  record.verdict = verdict_on(verdicts);
  if (was_tested)
    record.statement = statement_on(means, record.tolerance);
}

TargetVerdict verdict(const Json& json, const std::string& file)
{
  const std::string given = json.at("verdict").get<std::string>();
  if (const auto found = verdict_of_name(given))
    return *found;
  throw InputError("{}: the verdict {} is none of reached, missed and not_decided", file, in_quotes(given));
}

CalibrationRecord from_json(const Json& json, const std::string& file)
{
  CalibrationRecord record;
  record.rock = printable(text_of(json, "rock"));
  record.statement = text(json, "statement");
  record.made_by = read_provenance(json);
  record.elastic = elastic_figures(record.made_by);
  record.tolerance = number(json, "tolerance");
  const bool has_verdicts = json.contains("verdict");
  for (const auto& [name, row] : json.at("targets").items())
    record.targets.push_back(
      {printable(name), text(row, "title"), text(row, "unit"), number(row, "target"),
       number(row, "target_standard_deviation"), number(row, "reached"),
       row.at("standard_error").is_null() ? std::nullopt : std::optional(number(row, "standard_error")),
       number(row, "deviation"), number(row, "n_packings"),
       has_verdicts ? verdict(row, file) : TargetVerdict::not_decided});
  if (has_verdicts)
    record.verdict = verdict(json, file);
  else
    judge(record);
  for (const auto& [name, row] : json.at("parameters").items())
    record.parameters.push_back({printable(name), text(row, "title"), text(row, "unit"), number(row, "best"),
                                 number_if_any(row, "median"), number_if_any(row, "lower_90"),
                                 number_if_any(row, "upper_90"), printable(text_of(row, "verdict")),
                                 printable(text_of(row, "sentence"))});
  for (const auto& [name, row] : json.at("predictions").items())
    record.predictions.push_back({printable(name), text(row, "title"), text(row, "unit"), number(row, "median"),
                                  number(row, "lower_90"), number(row, "upper_90")});
  for (const auto& [response, of_response] : json.at("sensitivities").items())
    for (const auto& [parameter, row] : of_response.items())
      record.sensitivities.push_back(
        {printable(response), printable(parameter), number(row, "first_order"), number(row, "total")});
  return record;
}

void read_samples(CalibrationRecord& record, const std::filesystem::path& file)
{
  CsvReader reader(file);
  for (const std::string_view column : reader.header())
    record.sampled.push_back(printable(column));
  record.samples.resize(record.sampled.size());
  while (reader.next())
    for (std::size_t c = 0; c < record.samples.size(); ++c)
      record.samples[c].push_back(reader.number(c));
}
} // namespace

std::optional<CalibrationRecord> read_calibration(const std::filesystem::path& folder)
{
  const auto file = folder / "calibration.json";
  if (!std::filesystem::exists(file))
    return std::nullopt;
  CalibrationRecord record;
  try
    {
      record = from_json(parse_json(file.string(), content_of(file)), file.string());
    }
  catch (const Json::exception&)
    {
      throw InputError("{}: not as {} writes it", file.string(), input_entries::calibrate);
    }
  if (std::ranges::any_of(record.parameters, [](const auto& parameter) { return parameter.median.has_value(); }))
    read_samples(record, folder / "posterior.csv");
  return record;
}
} // namespace feldspar
