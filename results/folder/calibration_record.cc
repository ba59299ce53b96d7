#include "results/folder/calibration_record.h"

#include "base/csv.h"
#include "base/input_error.h"
#include "base/json_text.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/text.h"
#include "results/folder/provenance_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

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
  for (const InputEntry& one : made_by.input)
    if (one.section == "Calibration" && one.entry == "Youngs modulus")
      figures.youngs_modulus = one.value;
    else if (one.section == "Calibration" && one.entry == "Poissons ratio")
      figures.poissons_ratio = one.value;
  return figures;
}

CalibrationRecord from_json(const Json& json)
{
  CalibrationRecord record;
  record.rock = printable(text_of(json, "rock"));
  record.statement = text(json, "statement");
  record.elastic = elastic_figures(read_provenance(json));
  record.tolerance = number(json, "tolerance");
  for (const auto& [name, row] : json.at("targets").items())
    record.targets.push_back(
      {printable(name), text(row, "title"), text(row, "unit"), number(row, "target"),
       number(row, "target_standard_deviation"), number(row, "reached"),
       row.at("standard_error").is_null() ? std::nullopt : std::optional(number(row, "standard_error")),
       number(row, "deviation"), number(row, "n_packings")});
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
  for (const std::string_view column : split_at_commas(reader.header()))
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
      record = from_json(parse_json(file.string(), content_of(file)));
    }
  catch (const Json::exception&)
    {
      throw InputError(fmt::format("{}: not as feldspar calibrate writes it", file.string()));
    }
  if (std::any_of(record.parameters.begin(), record.parameters.end(),
                  [](const auto& parameter) { return parameter.median.has_value(); }))
    read_samples(record, folder / "posterior.csv");
  return record;
}
} // namespace feldspar
