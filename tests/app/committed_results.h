#pragma once

#include "tests/content.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

/// Committed results, and their figures as READMEs show them.
namespace feldspar::tests
{
/// Of an example by the names of its folder and of the file.
inline nlohmann::json results_of(const std::string& example, const std::string& study)
{
  return nlohmann::json::parse(
    content(std::string(FELDSPAR_SOURCE_DIR) + "/examples/" + example + "/results/" + study + ".json"));
}

/// The RVEs in the summary of `feldspar rve`; results of 0.2.0 have them under another key.
inline const nlohmann::json& rves_in(const nlohmann::json& summary)
{
  return summary.at(summary.contains("rves") ? "rves" : "volumes");
}

inline std::string number(const nlohmann::json& value, const double scale, const int decimals)
{
  return fmt::format("{:.{}f}", value.get<double>() / scale, decimals);
}

/// The group of the tests whose name begins so, on the n-th variant, from 1: variants come one after the other.
inline std::string group_of(const nlohmann::json& study, const std::string& beginning, const int variant)
{
  std::vector<std::string> groups;
  for (const auto& test : study["tests"])
    if (const std::string group = test["group"];
        group.starts_with(beginning + '_') && (groups.empty() || groups.back() != group))
      groups.push_back(group);
  return groups.at(std::size_t(variant - 1));
}

inline double mean_of(const nlohmann::json& study, const std::string& group, const std::string& key = "peak_stress_Pa")
{
  return study["ensemble"][group][key]["mean"].get<double>();
}

inline std::string mean_and_deviation(const nlohmann::json& study, const std::string& group, const std::string& key,
                                      const double scale, const int decimals)
{
  const auto& figure = study["ensemble"][group][key];
  return number(figure["mean"], scale, decimals) + " ± " + number(figure["standard_deviation"], scale, decimals);
}

inline double mean(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

inline std::string mean_and_deviation(const std::vector<double>& values, const int decimals)
{
  double square = 0.0;
  for (const double value : values)
    square += (value - mean(values)) * (value - mean(values));
  return fmt::format("{0:.{2}f} ± {1:.{2}f}", mean(values), std::sqrt(square / double(values.size() - 1)), decimals);
}

inline const nlohmann::json& test_of(const nlohmann::json& study, const std::string& name)
{
  for (const auto& test : study["tests"])
    if (test["name"] == name)
      return test;
  throw std::runtime_error("no test " + name);
}

/// A row of a README's table: its name, and the result it shows.
struct Row
{
  std::string name;
  std::string kind;
  std::string key;
  double scale;
  int decimals;
};

} // namespace feldspar::tests
