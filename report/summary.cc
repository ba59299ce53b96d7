#include "report/summary.h"

#include "report/result_table.h"
#include "report/statistics.h"
#include "report/text_file.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr int schema_version = 1;

/// Whole numbers are written as such.
Json number(const double value)
{
  if (std::abs(value) < 0x1p53 && value == std::floor(value) && std::abs(value) < 1e15)
    return std::int64_t(value);
  return value;
}

Json describe(const FinishedTest& test)
{
  Json json;
  json["kind"] = name(test.record.kind);
  json["name"] = test.name;
  json["seed"] = test.record.seed;
  json["interrupted"] = test.record.interrupted;
  for (const auto& entry : result_table())
    {
      const Figure figure = entry.value(test);
      const std::string key(entry.name);
      if (figure.value)
        json[key] = number(*figure.value);
      else
        {
          json[key] = nullptr;
          json[key + "_reason"] = figure.reason;
        }
    }
  return json;
}

/// Means over the seeds of each kind of test.
Json ensemble(const std::vector<FinishedTest>& tests)
{
  std::map<std::string, std::map<std::string_view, std::vector<double>>> values;
  for (const auto& test : tests)
    for (const auto& entry : result_table())
      if (const Figure figure = entry.value(test); figure.value)
        values[name(test.record.kind)][entry.name].push_back(*figure.value);

  Json json = Json::object();
  for (const auto& [kind, figures] : values)
    for (const auto& entry : result_table())
      if (const auto found = figures.find(entry.name); found != figures.end())
        {
          const auto over_seeds = statistics(found->second);
          Json& out = json[kind][std::string(entry.name)];
          out["n"] = over_seeds->n;
          out["mean"] = over_seeds->mean;
          if (over_seeds->standard_deviation)
            {
              out["standard_deviation"] = *over_seeds->standard_deviation;
              out["standard_error"] = *over_seeds->standard_error;
            }
        }
  return json;
}
} // namespace

void write_summary(const Provenance& provenance, const std::vector<FinishedTest>& tests,
                   const std::filesystem::path& file)
{
  Json json;
  json["schema_version"] = schema_version;
  json["feldspar_version"] = provenance.version;
  json["commit"] = provenance.commit;
  json["input"]["file"] = provenance.input_file;
  for (const auto& entry : provenance.input)
    json["input"]["parameters"][entry.section][entry.entry] = entry.value;
  json["host"]["processor"] = provenance.processor;
  json["host"]["threads"] = provenance.n_threads;
  json["tests"] = Json::array();
  for (const auto& test : tests)
    json["tests"].push_back(describe(test));
  json["ensemble"] = ensemble(tests);
  for (const char* form : {"as_paper", "intact", "general", "mohr_coulomb"})
    {
      json["fits"][form] = nullptr;
      json["fits"][std::string(form) + "_reason"] = "a strength envelope needs tests at several confining pressures";
    }
  write_text_file(file, json.dump(2) + "\n");
}
} // namespace feldspar
