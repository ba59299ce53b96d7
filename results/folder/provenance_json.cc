#include "results/folder/provenance_json.h"

#include "base/quoted.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace feldspar
{
namespace
{
bool is_number_of_json(const nlohmann::ordered_json& value)
{
  return !value.is_number_float() || std::isfinite(value.get<double>());
}

nlohmann::ordered_json with_reasons(const nlohmann::ordered_json& json)
{
  if (!json.is_structured())
    return is_number_of_json(json) ? json : nlohmann::ordered_json();
  nlohmann::ordered_json result = json.is_array() ? nlohmann::ordered_json::array() : nlohmann::ordered_json::object();
  for (const auto& [key, value] : json.items())
    if (json.is_array())
      result.push_back(with_reasons(value));
    else
      {
        result[key] = with_reasons(value);
        if (!is_number_of_json(value))
          result[key + "_reason"] = "it is no finite number";
      }
  return result;
}
} // namespace

std::string json_text(const nlohmann::ordered_json& json)
{
  return with_reasons(json).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

nlohmann::ordered_json as_json(const Provenance& provenance)
{
  nlohmann::ordered_json json;
  json["schema_version"] = summary_schema_version;
  json["feldspar_version"] = provenance.version;
  json["commit"] = provenance.commit;
  // JSON is UTF-8; names of files and values of the input need not be.
  json["input"]["file"] = printable(provenance.input_file);
  for (const auto& entry : provenance.input)
    json["input"]["parameters"][entry.section][entry.entry] = printable(entry.value);
  json["host"]["processor"] = provenance.processor;
  if (provenance.n_processes > 1)
    json["host"]["processes"] = provenance.n_processes;
  json["host"]["threads"] = provenance.n_threads;
  return json;
}

Provenance read_provenance(const nlohmann::ordered_json& summary)
{
  Provenance made_by;
  made_by.version = text_of(summary, "feldspar_version");
  made_by.commit = text_of(summary, "commit");
  if (const auto input = summary.find("input"); input != summary.end() && input->is_object())
    {
      made_by.input_file = text_of(*input, "file");
      if (const auto parameters = input->find("parameters"); parameters != input->end() && parameters->is_object())
        for (const auto& [section, entries] : parameters->items())
          if (entries.is_object())
            for (const auto& [entry, value] : entries.items())
              made_by.input.push_back({section, entry, value.is_string() ? value.get<std::string>() : value.dump()});
    }
  if (const auto host = summary.find("host"); host != summary.end() && host->is_object())
    {
      made_by.processor = text_of(*host, "processor");
      const auto read = [&](const char* const name, unsigned int& number) {
        if (const auto found = host->find(name); found != host->end() && found->is_number_unsigned())
          number = found->get<unsigned int>();
      };
      read("processes", made_by.n_processes);
      read("threads", made_by.n_threads);
    }
  return made_by;
}

nlohmann::ordered_json json_number(const double value)
{
  if (std::abs(value) < 0x1p53 && value == std::floor(value) && std::abs(value) < 1e15)
    return std::int64_t(value);
  return value;
}

nlohmann::ordered_json as_json(const std::vector<VariantSetting>& settings)
{
  nlohmann::ordered_json json;
  for (const VariantSetting& setting : settings)
    {
      nlohmann::ordered_json& out = json[setting.entry];
      const auto written = number_of(setting);
      if (!written)
        {
          out["value"] = setting.value;
          continue;
        }
      out["value"] = json_number(written->value);
      if (!written->unit.empty())
        out["unit"] = written->unit;
    }
  return json;
}

std::vector<VariantSetting> read_settings(const nlohmann::ordered_json& json)
{
  std::vector<VariantSetting> settings;
  if (json.is_object())
    for (const auto& [entry, written] : json.items())
      {
        const auto value = written.is_object() ? written.find("value") : written.end();
        if (value == written.end() || !(value->is_number() || value->is_string()))
          continue;
        const std::string unit = text_of(written, "unit");
        const std::string text =
          value->is_string() ? value->get<std::string>() : fmt::format("{}", value->get<double>());
        settings.push_back({entry, unit.empty() ? text : text + " " + unit});
      }
  return settings;
}

std::string text_of(const nlohmann::ordered_json& json, const std::string_view key)
{
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}
} // namespace feldspar
