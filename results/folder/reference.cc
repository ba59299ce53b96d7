#include "results/folder/reference.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "results/fits/hoek_brown.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>

namespace feldspar
{
namespace
{
using Json = nlohmann::json;

std::optional<double> number(const Json& json, const char* key)
{
  return json.contains(key) && json[key].is_number() ? std::optional(json[key].get<double>()) : std::nullopt;
}

ReferenceSource source(const Json& json, const char* key, const std::string& label)
{
  ReferenceSource result;
  result.label = label;
  if (!json.contains(key) || !json[key].is_object())
    return result;
  for (const auto& [name, entry] : json[key].items())
    {
      if (name == "label" && entry.is_string())
        result.label = excerpt(entry.get<std::string>());
      if (!entry.is_object())
        continue;
      if (const auto mean = number(entry, "mean"))
        result.values[name] = {*mean, number(entry, "min"), number(entry, "max")};
      if (name == "hoek_brown")
        {
          const auto sigma_ci = number(entry, "sigma_ci_MPa");
          const auto m = number(entry, "m");
          const auto s = number(entry, "s");
          const auto a = number(entry, "a");
          if (sigma_ci && m && s && a)
            result.envelope = PrintedEnvelope{*sigma_ci * 1e6, *m, *s, *a};
        }
    }
  return result;
}
} // namespace

double PrintedEnvelope::sigma_1(const double sigma_3) const { return hoek_brown_sigma_1(sigma_3, sigma_ci, m, s, a); }

std::optional<ReferenceValue> ReferenceSource::find(const std::string& key, const double scale) const
{
  const auto found = values.find(key);
  if (found == values.end())
    return std::nullopt;
  ReferenceValue value = found->second;
  value.mean /= scale;
  for (auto* bound : {&value.low, &value.high})
    if (*bound)
      **bound /= scale;
  return value;
}

std::vector<EnvelopePoint> ReferenceSource::strengths() const
{
  constexpr std::string_view beginning = "strength_at_";
  constexpr std::string_view ending = "_MPa";
  std::vector<EnvelopePoint> points;
  for (const auto& [name, value] : values)
    if (name.starts_with(beginning) && name.ends_with(ending))
      {
        double pressure = 0.0;
        const char* const last = name.data() + name.size() - ending.size();
        if (const auto [end, error] = std::from_chars(name.data() + beginning.size(), last, pressure);
            error == std::errc() && end == last)
          points.push_back({pressure * 1e6, value.mean * 1e6});
      }
  std::sort(points.begin(), points.end(),
            [](const EnvelopePoint& a, const EnvelopePoint& b) { return a.sigma_3 < b.sigma_3; });
  return points;
}

Reference read_reference(const std::filesystem::path& file)
{
  std::ifstream in(file);
  if (!in)
    throw InputError(fmt::format("Report/Reference file = {}: no such file", file.string()));
  const Json json = Json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("experiment"))
    throw InputError(
      fmt::format("Report/Reference file = {}: not a JSON file with an \"experiment\" in it", file.string()));
  Reference reference;
  if (json.contains("rock") && json["rock"].is_string())
    reference.rock = printable(json["rock"].get<std::string>());
  if (json.contains("citation") && json["citation"].is_object())
    for (const auto& [name, text] : json["citation"].items())
      if (text.is_string())
        reference.citations.push_back(printable(fmt::format("{}: {}", name, text.get<std::string>())));
  reference.experiment = source(json, "experiment", "experiment");
  reference.model = source(json, "paper_model", "paper's model");
  return reference;
}
} // namespace feldspar
