#include "report/comparison.h"

#include "dem/input_error.h"
#include "report/statistics.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>

namespace feldspar
{
namespace
{
using Json = nlohmann::json;

Json read(const std::optional<std::filesystem::path>& file)
{
  if (!file)
    return Json::object();
  std::ifstream in(*file);
  if (!in)
    throw InputError(fmt::format("Report/Reference file = {}: no such file", file->string()));
  Json json = Json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("experiment"))
    throw InputError(
      fmt::format("Report/Reference file = {}: not a JSON file with an \"experiment\" in it", file->string()));
  return json;
}

/// The keys of a reference file end in its units, MPa and GPa; scale turns its bare numbers into the row's unit.
std::optional<ReferenceValue> find(const Json& json, const char* source, const std::string& key, const double scale)
{
  if (!json.contains(source) || !json[source].contains(key) || !json[source][key].contains("mean"))
    return std::nullopt;
  const Json& entry = json[source][key];
  const auto number = [&](const char* name) -> std::optional<double> {
    return entry.contains(name) && entry[name].is_number() ? std::optional(entry[name].get<double>() / scale)
                                                           : std::nullopt;
  };
  if (!number("mean"))
    return std::nullopt;
  return ReferenceValue{*number("mean"), number("min"), number("max")};
}

/// One value a seed, from the figure of one kind of test.
std::map<std::uint64_t, double> by_seed(const std::vector<FinishedTest>& tests, const TestKind kind,
                                        Figure TestResults::*figure)
{
  std::map<std::uint64_t, double> values;
  for (const auto& test : tests)
    if (test.record.kind == kind && (test.results.*figure).value)
      values[test.record.seed] = *(test.results.*figure).value;
  return values;
}
} // namespace

std::vector<ComparisonRow> compare(const std::vector<FinishedTest>& tests,
                                   const std::optional<std::filesystem::path>& reference_file)
{
  constexpr auto pulled = TestKind::direct_tension;
  constexpr auto crushed = TestKind::uniaxial_compression;
  const Json reference = read(reference_file);
  std::vector<ComparisonRow> rows;
  const auto add = [&](const std::string& property, const char* unit, const int decimals, const double scale,
                       const std::map<std::uint64_t, double>& values, const std::string& key,
                       const double reference_scale = 1.0) {
    std::vector<double> scaled;
    for (const auto& [seed, value] : values)
      scaled.push_back(value / scale);
    const auto ours = statistics(scaled);
    ComparisonRow row{property,
                      unit,
                      decimals,
                      std::nullopt,
                      std::nullopt,
                      find(reference, "paper_model", key, reference_scale),
                      find(reference, "experiment", key, reference_scale)};
    if (ours)
      {
        row.mean = ours->mean;
        row.standard_deviation = ours->standard_deviation;
      }
    rows.push_back(row);
  };

  const auto strength = by_seed(tests, crushed, &TestResults::peak_stress);
  const auto tensile = by_seed(tests, pulled, &TestResults::peak_stress);
  std::map<std::uint64_t, double> ratio;
  for (const auto& [seed, value] : tensile)
    if (strength.contains(seed))
      ratio[seed] = value / strength.at(seed);

  add("tensile strength", "MPa", 2, 1e6, tensile, "tensile_strength_MPa");
  add("strain at tensile peak", "1e-4", 2, 1e-4, by_seed(tests, pulled, &TestResults::strain_at_peak),
      "strain_at_tensile_peak", 1e-4);
  add("uniaxial compressive strength", "MPa", 1, 1e6, strength, "uniaxial_compressive_strength_MPa");
  add("tensile over compressive strength", "", 3, 1.0, ratio, "tension_to_compression");
  add("Young's modulus, tangent 40-60 % of peak", "GPa", 1, 1e9,
      by_seed(tests, crushed, &TestResults::youngs_modulus_tangent), "youngs_modulus_GPa");
  add("Young's modulus, initial", "GPa", 1, 1e9, by_seed(tests, crushed, &TestResults::youngs_modulus_initial), "");
  add("Poisson's ratio, secant at 50 % of peak", "", 3, 1.0,
      by_seed(tests, crushed, &TestResults::poissons_ratio_secant), "poissons_ratio");
  add("Poisson's ratio, initial", "", 3, 1.0, by_seed(tests, crushed, &TestResults::poissons_ratio_initial), "");
  add("crack initiation stress, compression", "MPa", 1, 1e6,
      by_seed(tests, crushed, &TestResults::crack_initiation_stress), "crack_initiation_stress_MPa");
  add("crack damage stress, compression", "MPa", 1, 1e6, by_seed(tests, crushed, &TestResults::crack_damage_stress),
      "crack_damage_stress_MPa");
  std::map<double, std::map<std::uint64_t, double>> confined;
  for (const auto& test : tests)
    if (test.record.kind == TestKind::triaxial_compression && test.results.peak_stress.value)
      confined[test.record.confining_pressure][test.record.seed] = *test.results.peak_stress.value;
  for (const auto& [pressure, strengths] : confined)
    {
      const std::string megapascals = fmt::format("{:g}", pressure / 1e6);
      add(fmt::format("strength at {} MPa confinement", megapascals), "MPa", 1, 1e6, strengths,
          "strength_at_" + megapascals + "_MPa");
    }
  if (const auto disc = by_seed(tests, TestKind::brazilian, &TestResults::peak_stress); !disc.empty())
    add("Brazilian tensile strength", "MPa", 2, 1e6, disc, "brazilian_strength_MPa");
  return rows;
}

std::string as_text(const std::vector<ComparisonRow>& rows)
{
  std::vector<std::array<std::string, 4>> cells;
  cells.push_back({"", "this run", "paper's model", "experiment"});
  for (const auto& row : rows)
    {
      const auto value = [&](const double number) { return fmt::format("{:.{}f}", number, row.decimals); };
      const auto reference = [&](const std::optional<ReferenceValue>& entry) {
        if (!entry)
          return std::string("-");
        std::string text = value(entry->mean);
        if (entry->low && entry->high)
          text += fmt::format(" ({} to {})", value(*entry->low), value(*entry->high));
        return text;
      };
      std::string ours = row.mean ? value(*row.mean) : "-";
      if (row.standard_deviation)
        ours += fmt::format(" ± {}", value(*row.standard_deviation));
      cells.push_back({row.unit.empty() ? row.property : fmt::format("{} [{}]", row.property, row.unit), ours,
                       reference(row.model), reference(row.experiment)});
    }

  // Width on the screen: bytes that continue a UTF-8 character take no place.
  const auto width = [](const std::string& text) {
    return std::size_t(std::count_if(text.begin(), text.end(), [](const char c) { return (c & 0xC0) != 0x80; }));
  };
  std::array<std::size_t, 4> widest{};
  for (const auto& line : cells)
    for (std::size_t c = 0; c < line.size(); ++c)
      widest[c] = std::max(widest[c], width(line[c]));
  std::string text;
  for (const auto& line : cells)
    {
      text += line[0] + std::string(widest[0] - width(line[0]), ' ');
      for (std::size_t c = 1; c < line.size(); ++c)
        text += "   " + std::string(widest[c] - width(line[c]), ' ') + line[c];
      text += '\n';
    }
  return text;
}
} // namespace feldspar
