#include "report/sections/comparison.h"

#include "base/text.h"
#include "results/fits/direct_shear.h"
#include "results/fits/hoek_brown.h"
#include "results/fits/mohr_coulomb.h"
#include "results/runs/bodies.h"
#include "results/runs/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace feldspar
{
namespace
{
bool gives_tensile_strength(const TestRecord& record) { return record.envelope_role() == EnvelopeRole::tension; }

bool is_uniaxial_compression(const TestRecord& record)
{
  return record.envelope_role() == EnvelopeRole::compression && !record.kind.takes_confining_pressure;
}

/// One value a seed, from a figure of the tests that `is_wanted` picks.
std::map<std::uint64_t, double> by_seed(const std::vector<FinishedTest>& tests, bool (&is_wanted)(const TestRecord&),
                                        Figure TestResults::*figure)
{
  std::map<std::uint64_t, double> values;
  for (const auto& test : tests)
    if (test.results.is_valid() && is_wanted(test.record) && (test.results.*figure).value)
      values[test.record.seed] = *(test.results.*figure).value;
  return values;
}

/// One value a seed, of the body that it was tested on.
std::map<std::uint64_t, double> of_bodies(const std::vector<FinishedTest>& tests, double SpecimenReport::*figure)
{
  std::map<std::uint64_t, double> values;
  for (const auto& [seed, body] : whole_bodies(tests))
    if (body.n_grains > 0 && std::isfinite(body.*figure))
      values[seed] = body.*figure;
  return values;
}

std::map<std::uint64_t, std::vector<EnvelopePoint>> points_by_seed(const std::vector<FinishedTest>& tests)
{
  std::map<std::uint64_t, std::vector<EnvelopePoint>> points;
  for (const auto& test : tests)
    if (test.record.envelope_role() == EnvelopeRole::compression && test.results.peak_stress.value)
      points[test.record.seed].push_back({test.record.confining_pressure, *test.results.peak_stress.value});
  return points;
}

/// Of each seed with more points of compression than such a line has parameters.
std::map<std::uint64_t, MohrCoulombFit> lines_by_seed(const std::vector<FinishedTest>& tests)
{
  std::map<std::uint64_t, MohrCoulombFit> lines;
  for (const auto& [seed, points] : points_by_seed(tests))
    if (const auto line = fit_mohr_coulomb({points, std::nullopt, std::nullopt}).fit;
        line && line->quality.degrees_of_freedom > 0)
      lines[seed] = *line;
  return lines;
}

/// m_i of each seed that was also tested without confinement.
std::map<std::uint64_t, double> rock_constants_by_seed(const std::vector<FinishedTest>& tests)
{
  std::map<std::uint64_t, double> constants;
  for (const auto& [seed, points] : points_by_seed(tests))
    if (const auto constant = rock_constant(points))
      constants[seed] = *constant;
  return constants;
}

std::string megapascals(const double stress) { return fmt::format("{:g}", std::round(stress) / 1e6); }

/// What the highest stress of a test is called. A notched body has its own name of it.
std::string strength_name(const TestKind& kind, const bool flawed)
{
  return !flawed || kind.has_notch || kind.follows_stages ? std::string(kind.strength)
                                                          : fmt::format("{}, highest nominal stress", kind.title);
}

std::string strength_row(const TestGroup& group, const bool flawed)
{
  std::string text = strength_name(group.kind, flawed);
  if (group.kind.takes_confining_pressure)
    text += fmt::format(" at {} MPa confinement", megapascals(group.confining_pressure));
  if (group.intermediate_stress)
    text += fmt::format(", {} MPa intermediate stress", megapascals(*group.intermediate_stress));
  return text;
}

/// The name of the strength in a reference file. A point of compression is one however it was measured.
std::string strength_key(const TestGroup& group)
{
  if (group.envelope_role() == EnvelopeRole::compression)
    return fmt::format("strength_at_{}_MPa", megapascals(group.confining_pressure));
  return fmt::format("{}_strength_MPa", group.name());
}

/// Of the tests with a notch, kind by kind: each has its own geometry.
template <typename Add>
void add_toughness(const std::vector<FinishedTest>& tests, Add&& add)
{
  std::vector<TestKind> kinds;
  for (const auto& test : tests)
    if (test.record.kind.has_notch && std::find(kinds.begin(), kinds.end(), test.record.kind) == kinds.end())
      kinds.push_back(test.record.kind);
  for (const TestKind& kind : kinds)
    {
      std::map<std::uint64_t, double> toughness;
      std::map<std::uint64_t, double> energy;
      std::string why_no_toughness;
      std::string why_no_energy;
      for (const auto& test : tests)
        if (test.record.kind == kind)
          {
            const auto take = [&](const Figure& figure, auto& values, std::string& why_missing) {
              if (figure.value)
                values[test.record.seed] = *figure.value;
              else if (why_missing.empty())
                why_missing = test.record.failure.empty() ? figure.reason : test.record.failure;
            };
            take(test.results.fracture_toughness, toughness, why_no_toughness);
            take(test.results.fracture_energy, energy, why_no_energy);
          }
      std::string by(kind.name);
      std::replace(by.begin(), by.end(), '_', ' ');
      add(fmt::format("fracture toughness, {}", by), "MPa √m", 3, 1e6, toughness, "fracture_toughness_MPa_sqrt_m", 1.0,
          why_no_toughness);
      add(fmt::format("work of fracture, {}", by), "J/m²", 1, 1.0, energy, "fracture_energy_J_per_m2", 1.0,
          why_no_energy);
    }
}

template <typename Add>
void add_shear_line(const std::vector<FinishedTest>& tests, Add&& add)
{
  std::map<std::uint64_t, std::vector<const FinishedTest*>> of_seed;
  for (const auto& test : tests)
    if (test.record.kind.pressure_acts_across)
      of_seed[test.record.seed].push_back(&test);
  std::map<std::uint64_t, double> cohesion;
  std::map<std::uint64_t, double> angle;
  for (const auto& [seed, sheared] : of_seed)
    if (const auto line = fit_shear_line(sheared).line)
      {
        cohesion[seed] = line->cohesion;
        angle[seed] = line->friction_angle;
      }
  if (cohesion.empty())
    return;
  add("friction angle, direct shear", "deg", 1, std::numbers::pi / 180.0, angle, "direct_shear_friction_angle_deg");
  add("cohesion, direct shear", "MPa", 2, 1e6, cohesion, "direct_shear_cohesion_MPa");
}
} // namespace

std::optional<double> ComparisonRow::deviation() const
{
  if (!ours || !experiment || experiment->mean.value_or(0.0) == 0.0)
    return std::nullopt;
  return ours->mean / *experiment->mean - 1.0;
}

std::optional<bool> ComparisonRow::in_range() const
{
  if (!ours || !experiment || !experiment->low || !experiment->high)
    return std::nullopt;
  return ours->mean >= *experiment->low && ours->mean <= *experiment->high;
}

std::optional<bool> ComparisonRow::surely_in_range() const
{
  if (!in_range() || !ours->confidence_95)
    return std::nullopt;
  return ours->mean - *ours->confidence_95 >= *experiment->low &&
         ours->mean + *ours->confidence_95 <= *experiment->high;
}

std::vector<ComparisonRow> compare(const std::vector<FinishedTest>& tests, const std::optional<Reference>& reference,
                                   const ElasticFigures& elastic, const bool beside_flaws)
{
  const auto& pulled = gives_tensile_strength;
  const auto& crushed = is_uniaxial_compression;
  std::vector<ComparisonRow> rows;
  const auto add = [&](const std::string& property, const char* unit, const int decimals, const double scale,
                       const std::map<std::uint64_t, double>& values, const std::string& key,
                       const double reference_scale = 1.0, const std::string& why_missing = "") {
    std::vector<double> scaled;
    for (const auto& [seed, value] : values)
      scaled.push_back(value / scale);
    ComparisonRow row{property, unit, decimals, statistics(scaled), std::nullopt, std::nullopt, key};
    if (reference)
      {
        row.model = reference->model.find(key, reference_scale);
        row.experiment = reference->experiment.find(key, reference_scale);
      }
    if (!row.ours)
      row.why_missing = why_missing;
    rows.push_back(row);
  };

  const bool flawed = beside_flaws || any_has_flaws(tests);
  const auto strength = by_seed(tests, crushed, &TestResults::peak_stress);
  const auto tensile = by_seed(tests, pulled, &TestResults::peak_stress);
  std::map<std::uint64_t, double> ratio;
  for (const auto& [seed, value] : tensile)
    if (strength.contains(seed))
      ratio[seed] = value / strength.at(seed);

  const auto name_of_strength = [&](bool (&is_wanted)(const TestRecord&), const char* otherwise) {
    const auto test =
      std::find_if(tests.begin(), tests.end(), [&](const FinishedTest& one) { return is_wanted(one.record); });
    return test == tests.end() ? std::string(otherwise) : strength_name(test->record.kind, flawed);
  };
  add(name_of_strength(pulled, "tensile strength"), "MPa", 2, 1e6, tensile, "tensile_strength_MPa");
  add("strain at tensile peak", "1e-4", 2, 1e-4, by_seed(tests, pulled, &TestResults::strain_at_peak),
      "strain_at_tensile_peak", 1e-4);
  add(name_of_strength(crushed, "uniaxial compressive strength"), "MPa", 1, 1e6, strength,
      "uniaxial_compressive_strength_MPa");
  add(flawed ? "highest nominal stresses, tension over compression" : "tensile over compressive strength", "", 3, 1.0,
      ratio, "tension_to_compression");
  add("strain at peak, compression", "1e-3", 2, 1e-3, by_seed(tests, crushed, &TestResults::strain_at_peak),
      "strain_at_compressive_peak", 1e-3);
  const auto add_modulus = [&](const char* property, const char* which, Figure TestResults::*figure) {
    add(property, "GPa", 1, 1e9, by_seed(tests, crushed, figure),
        elastic.youngs_modulus == which ? "youngs_modulus_GPa" : "");
  };
  const auto add_ratio = [&](const char* property, const char* which, Figure TestResults::*figure) {
    add(property, "", 3, 1.0, by_seed(tests, crushed, figure), elastic.poissons_ratio == which ? "poissons_ratio" : "");
  };
  add_modulus("Young's modulus, tangent 40-60 % of peak", "tangent", &TestResults::youngs_modulus_tangent);
  add_modulus("Young's modulus, initial", "initial", &TestResults::youngs_modulus_initial);
  if (elastic.youngs_modulus == "secant")
    add_modulus("Young's modulus, secant at 50 % of peak", "secant", &TestResults::youngs_modulus_secant);
  add_ratio("Poisson's ratio, secant at 50 % of peak", "secant", &TestResults::poissons_ratio_secant);
  add_ratio("Poisson's ratio, initial", "initial", &TestResults::poissons_ratio_initial);
  add("crack initiation stress, compression", "MPa", 1, 1e6,
      by_seed(tests, crushed, &TestResults::crack_initiation_stress), "crack_initiation_stress_MPa");
  add("crack initiation stress, lateral strain", "MPa", 1, 1e6,
      by_seed(tests, crushed, &TestResults::crack_initiation_stress_lateral), "crack_initiation_stress_lateral_MPa");
  add("crack damage stress, compression", "MPa", 1, 1e6, by_seed(tests, crushed, &TestResults::crack_damage_stress),
      "crack_damage_stress_MPa");

  const auto envelopes = lines_by_seed(tests);
  const auto of_lines = [&](Estimate MohrCoulombFit::*estimate) {
    std::map<std::uint64_t, double> values;
    for (const auto& [seed, line] : envelopes)
      values[seed] = (line.*estimate).value;
    return values;
  };
  if (!envelopes.empty() || (reference && reference->experiment.line()))
    {
      add("friction angle, Mohr-Coulomb", "deg", 1, std::numbers::pi / 180.0, of_lines(&MohrCoulombFit::friction_angle),
          "friction_angle_deg");
      add("cohesion, Mohr-Coulomb", "MPa", 1, 1e6, of_lines(&MohrCoulombFit::cohesion), "cohesion_MPa");
    }
  if (reference && (reference->experiment.find("m_i") || reference->model.find("m_i")))
    add("m_i of Hoek and Brown, compression", "", 1, 1.0, rock_constants_by_seed(tests), "m_i");

  // Then the strengths by the other tests, each under each of its pressures.
  std::vector<std::pair<TestGroup, std::map<std::uint64_t, double>>> others;
  for (const auto& test : tests)
    if (!gives_tensile_strength(test.record) && !is_uniaxial_compression(test.record) &&
        test.results.peak_stress.value && test.results.is_valid())
      {
        TestGroup group = group_of(test.record);
        group.confining_pressure = std::round(group.confining_pressure); // as references name it
        auto found = std::find_if(others.begin(), others.end(),
                                  [&](const auto& other) { return same_conditions(other.first, group); });
        if (found == others.end())
          found = others.insert(others.end(), {group, {}});
        found->second[test.record.seed] = *test.results.peak_stress.value;
      }
  std::stable_sort(others.begin(), others.end(),
                   [](const auto& a, const auto& b) { return comes_before(a.first, b.first); });
  for (const auto& [group, strengths] : others)
    add(strength_row(group, flawed), "MPa", group.kind.strength_decimals, 1e6, strengths, strength_key(group));
  add_toughness(tests, add);
  add_shear_line(tests, add);

  // Which body it is: two with different gaps are different rocks.
  add("installation gap over mean radius", "", 4, 1.0, of_bodies(tests, &SpecimenReport::installation_gap_ratio), "");
  add("coordination number in the bulk", "", 2, 1.0, of_bodies(tests, &SpecimenReport::coordination_number_core), "");
  add("porosity", "", 3, 1.0, of_bodies(tests, &SpecimenReport::porosity), "");
  return rows;
}

std::string as_text(const ComparisonRow& row, const std::optional<ReferenceValue>& value, const std::string& unit)
{
  const auto number = [&](const double x) { return fmt::format("{:.{}f}", x, row.decimals); };
  if (!value)
    return "-";
  const std::string range =
    value->low && value->high ? fmt::format("{} to {}", number(*value->low), number(*value->high)) : "";
  if (!value->mean)
    return range + unit;
  std::string text = number(*value->mean);
  if (value->standard_deviation)
    text += fmt::format(" ± {}", number(*value->standard_deviation));
  if (value->n)
    text += fmt::format("{}, n = {}", unit, *value->n);
  if (!range.empty())
    text += fmt::format(" ({})", range);
  return value->n ? text : text + unit;
}

namespace
{
constexpr std::size_t page = 80; // characters of a line

} // namespace

std::vector<std::string> properties_without_a_test(const std::vector<ComparisonRow>& rows,
                                                   const std::optional<Reference>& reference)
{
  std::vector<std::string> keys;
  if (reference)
    for (const auto& [key, value] : reference->experiment.values)
      if (key != "density_kg_per_m3" &&
          std::none_of(rows.begin(), rows.end(), [&, wanted = key](const ComparisonRow& row) {
            return row.key == wanted && (row.ours || !row.why_missing.empty());
          }))
        keys.push_back(key);
  return keys;
}

std::vector<std::string> sentences_on_missing(const std::vector<ComparisonRow>& rows,
                                              const std::optional<Reference>& reference)
{
  std::vector<std::string> sentences;
  for (const ComparisonRow& row : rows)
    if (row.experiment && !row.why_missing.empty())
      {
        const bool another_has_it = std::any_of(rows.begin(), rows.end(), [&](const ComparisonRow& other) {
          return other.property == row.property && other.ours; // another variant
        });
        const std::string sentence = fmt::format("No figure of {}: {}.", row.property, row.why_missing);
        if (!another_has_it && std::find(sentences.begin(), sentences.end(), sentence) == sentences.end())
          sentences.push_back(sentence);
      }
  if (const auto keys = properties_without_a_test(rows, reference); !keys.empty())
    sentences.push_back(fmt::format(
      "Not tested here: the experiment's {}; Tests/List and Tests/Confinements add tests.", fmt::join(keys, ", ")));
  return sentences;
}

std::string text_of_missing(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference)
{
  std::string text;
  for (const std::string& sentence : sentences_on_missing(rows, reference))
    for (const std::string& line : in_lines(sentence, page, "  "))
      text += line + '\n';
  return text;
}

std::string as_text(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference)
{
  constexpr std::size_t n_columns = 4;
  constexpr std::size_t narrowest = 20; // of the headings
  std::vector<std::array<std::string, n_columns>> cells;
  cells.push_back({"", "this run", "reference model", "experiment"});
  for (const auto& row : rows)
    {
      const auto value = [&](const double number) { return fmt::format("{:.{}f}", number, row.decimals); };
      std::string ours = row.ours ? value(row.ours->mean) : "-";
      if (row.ours && row.ours->standard_deviation)
        ours += fmt::format(" ± {}", value(*row.ours->standard_deviation));
      if (row.ours || row.model || row.experiment)
        cells.push_back({row.unit.empty() ? row.property : fmt::format("{} [{}]", row.property, row.unit), ours,
                         as_text(row, row.model), as_text(row, row.experiment)});
    }

  // A column that says nothing is left out; headings give way, so that a line fits on a terminal.
  std::vector<std::size_t> columns{1};
  for (std::size_t c = 2; c < n_columns; ++c)
    if (std::any_of(cells.begin() + 1, cells.end(), [c](const auto& line) { return line[c] != "-"; }))
      columns.push_back(c);
  std::array<std::size_t, n_columns> widest{};
  for (const auto& line : cells)
    for (std::size_t c = 0; c < n_columns; ++c)
      widest[c] = std::max(widest[c], width_of(line[c]));
  std::size_t of_values = 0;
  for (const std::size_t c : columns)
    of_values += 2 + widest[c];
  const std::size_t of_headings = std::min(widest[0], page > of_values + narrowest ? page - of_values : narrowest);
  std::string text;
  for (const auto& line : cells)
    {
      const std::vector<std::string> heading = in_lines(line[0], of_headings, "  ");
      text += heading.front() + std::string(of_headings - std::min(of_headings, width_of(heading.front())), ' ');
      for (const std::size_t c : columns)
        text += "  " + std::string(widest[c] - width_of(line[c]), ' ') + line[c];
      text += '\n';
      for (std::size_t k = 1; k < heading.size(); ++k)
        text += heading[k] + '\n';
    }
  return text + text_of_missing(rows, reference);
}
} // namespace feldspar
