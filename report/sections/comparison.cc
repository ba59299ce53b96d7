#include "report/sections/comparison.h"

#include "base/contains.h"
#include "base/text.h"
#include "laboratory/named_entries.h"
#include "report/sections/text.h"
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
#include <string_view>
#include <type_traits>
#include <utility>

namespace feldspar
{
namespace
{
using BySeed = std::map<std::uint64_t, double>;

/// One value a seed, from a figure of the valid tests that a source has.
BySeed by_seed(const std::vector<FinishedTest>& tests, const PropertySource source, Figure TestResults::*figure)
{
  BySeed values;
  for (const auto& test : tests)
    if (test.results.is_valid() && gives(source, test.record.kind) && (test.results.*figure).value)
      values[test.record.seed] = *(test.results.*figure).value;
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

/// The results of a function for the data of each seed, where it has one.
template <typename Data, typename Of>
auto where_found(const std::map<std::uint64_t, Data>& of_seeds, const Of& of)
{
  std::map<std::uint64_t, typename std::invoke_result_t<Of, const Data&>::value_type> found;
  for (const auto& [seed, data] : of_seeds)
    if (const auto result = of(data))
      found[seed] = *result;
  return found;
}

/// One value a seed, of the body that it was tested on.
BySeed of_bodies(const std::vector<FinishedTest>& tests, double SpecimenReport::*figure)
{
  return where_found(whole_bodies(tests), [&](const SpecimenReport& body) {
    return body.n_grains > 0 && std::isfinite(body.*figure) ? std::optional(body.*figure) : std::nullopt;
  });
}

/// Mohr-Coulomb line with more points of compression than the line has parameters.
std::optional<MohrCoulombFit> line_through(const std::vector<EnvelopePoint>& points)
{
  const auto line = fit_mohr_coulomb({points, std::nullopt, std::nullopt}).fit;
  return line && line->quality.degrees_of_freedom > 0 ? line : std::nullopt;
}

std::string megapascals(const double stress) { return fmt::format("{:g}", std::round(stress) / 1e6); }

/// Name of the highest stress of a test. A notched body has its own name for it.
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

/// Returns which figure of a key the reference has; empty for other keys.
std::string chosen(const ElasticFigures& elastic, const std::string_view key)
{
  return key == "youngs_modulus_GPa" ? elastic.youngs_modulus : key == "poissons_ratio" ? elastic.poissons_ratio : "";
}

/// Values of a property of bodies with a notch, and why there are none; each kind of test has its own geometry.
std::pair<BySeed, std::string> of_notched(const std::vector<FinishedTest>& tests, const TestKind& kind,
                                          Figure TestResults::*figure)
{
  std::pair<BySeed, std::string> found;
  auto& [values, why_missing] = found;
  for (const auto& test : tests)
    if (test.record.kind == kind)
      {
        const Figure& of_test = test.results.*figure;
        if (of_test.value)
          values[test.record.seed] = *of_test.value;
        else if (why_missing.empty())
          why_missing = test.record.failure.empty() ? of_test.reason : test.record.failure;
      }
  return found;
}

/// Kinds of test with a notch.
std::vector<TestKind> notched_kinds(const std::vector<FinishedTest>& tests)
{
  std::vector<TestKind> kinds;
  for (const auto& test : tests)
    if (test.record.kind.has_notch && !contains(kinds, test.record.kind))
      kinds.push_back(test.record.kind);
  return kinds;
}

/// Shear line of each seed with shear tests that have one.
std::map<std::uint64_t, ShearLine> shear_lines(const std::vector<FinishedTest>& tests)
{
  std::map<std::uint64_t, std::vector<const FinishedTest*>> of_seed;
  for (const auto& test : tests)
    if (test.record.kind.pressure_acts_across)
      of_seed[test.record.seed].push_back(&test);
  return where_found(of_seed, [](const auto& sheared) { return fit_shear_line(sheared).fit; });
}

/// Strengths that are no property of the table, each under each of its pressures.
std::vector<std::pair<TestGroup, BySeed>> other_strengths(const std::vector<FinishedTest>& tests)
{
  std::vector<std::pair<TestGroup, BySeed>> others;
  for (const auto& test : tests)
    if (!gives(PropertySource::tension, test.record.kind) && !gives(PropertySource::compression, test.record.kind) &&
        test.results.peak_stress.value && test.results.is_valid())
      {
        TestGroup group = group_of(test.record);
        group.confining_pressure = std::round(group.confining_pressure); // as references name it
        auto found =
          std::ranges::find_if(others, [&](const auto& other) { return same_conditions(other.first, group); });
        if (found == others.end())
          found = others.insert(others.end(), {group, {}});
        found->second[test.record.seed] = *test.results.peak_stress.value;
      }
  std::ranges::stable_sort(others, [](const auto& a, const auto& b) { return comes_before(a.first, b.first); });
  return others;
}

constexpr std::size_t page = 80; // characters of a line

/// Returns whether a property is given to a model instead of expected from it.
bool is_given(const std::string_view key)
{
  return std::ranges::any_of(
    rock_properties, [&](const RockProperty& one) { return one.source == PropertySource::given && one.key == key; });
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

std::string name(const RangeVerdict verdict)
{
  return verdict == RangeVerdict::within ? "within" : verdict == RangeVerdict::outside ? "outside" : "not decided";
}

std::optional<RangeVerdict> ComparisonRow::against_range() const
{
  if (!in_range())
    return std::nullopt;
  if (*in_range())
    return RangeVerdict::within;
  const double distance = std::max(*experiment->low - ours->mean, ours->mean - *experiment->high);
  return ours->confidence_95 && *ours->confidence_95 < distance ? RangeVerdict::outside : RangeVerdict::not_decided;
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
  std::vector<ComparisonRow> rows;
  const auto add = [&](const std::string& title, const ShownIn& shown, const BySeed& values, const std::string& key,
                       const double unit_of_key, const std::string& why_missing = "") {
    std::vector<double> scaled;
    for (const auto& [seed, value] : values)
      scaled.push_back(value / shown.scale);
    ComparisonRow row{title, std::string(shown.unit), shown.decimals, statistics(scaled), std::nullopt, std::nullopt,
                      key};
    if (reference)
      {
        row.model = reference->model.find(key, shown.scale / unit_of_key);
        row.experiment = reference->experiment.find(key, shown.scale / unit_of_key);
      }
    if (!row.ours)
      row.why_missing = why_missing;
    rows.push_back(row);
  };
  const auto add_property = [&](const RockProperty& property, const BySeed& values, const std::string& title = "",
                                const std::string& why_missing = "") {
    add(title.empty() ? std::string(property.title) : title, property.shown, values, std::string(property.key),
        property.key_in.unit, why_missing);
  };

  const bool flawed = beside_flaws || any_has_flaws(tests);
  const auto title_of = [&](const RockProperty& property) {
    const auto test = std::ranges::find_if(tests, [&](const FinishedTest& one) {
      return property.figure == &TestResults::peak_stress && gives(property.source, one.record.kind);
    });
    return test == tests.end() ? std::string(property.title) : strength_name(test->record.kind, flawed);
  };
  for (const RockProperty& property : rock_properties)
    if (property.source == PropertySource::tension || property.source == PropertySource::compression)
      {
        const bool is_chosen = property.choice.name == chosen(elastic, property.key);
        if (is_chosen || !property.choice.hidden_otherwise)
          add(title_of(property), property.shown, by_seed(tests, property.source, property.figure),
              is_chosen ? std::string(property.key) : "", property.key_in.unit);
      }
    else if (property.key == "tension_to_compression")
      {
        BySeed ratio = by_seed(tests, PropertySource::tension, &TestResults::peak_stress);
        const BySeed strength = by_seed(tests, PropertySource::compression, &TestResults::peak_stress);
        std::erase_if(ratio, [&](const auto& one) { return !strength.contains(one.first); });
        for (auto& [seed, value] : ratio)
          value /= strength.at(seed);
        add_property(property, ratio, flawed ? "highest nominal stresses, tension over compression" : "");
      }

  const auto points = points_by_seed(tests);
  const auto envelopes = where_found(points, line_through);
  if (!envelopes.empty() || (reference && reference->experiment.line()))
    {
      add_property(rock_property("friction_angle_deg"),
                   where_found(envelopes, [](const auto& fit) { return std::optional(fit.friction_angle.value); }));
      add_property(rock_property("cohesion_MPa"),
                   where_found(envelopes, [](const auto& fit) { return std::optional(fit.cohesion.value); }));
    }
  if (reference && (reference->experiment.find("m_i") || reference->model.find("m_i")))
    add_property(rock_property("m_i"), where_found(points, rock_constant));
  for (const auto& [group, strengths] : other_strengths(tests))
    add(strength_row(group, flawed), display::megapascals(group.kind.strength_decimals), strengths, strength_key(group),
        mega);
  for (const TestKind& kind : notched_kinds(tests))
    for (const RockProperty& property : rock_properties)
      if (property.source == PropertySource::notch)
        {
          std::string by(kind.name);
          std::ranges::replace(by, '_', ' ');
          const auto [values, why_missing] = of_notched(tests, kind, property.figure);
          add_property(property, values, fmt::format("{}, {}", property.title, by), why_missing);
        }
  if (const RockProperty& angle = rock_property("plate_friction_angle_deg");
      std::ranges::any_of(tests, [](const FinishedTest& test) { return test.record.kind.tilts; }))
    add_property(angle, by_seed(tests, angle.source, angle.figure));
  if (const auto lines = shear_lines(tests); !lines.empty())
    {
      add_property(rock_property("direct_shear_friction_angle_deg"),
                   where_found(lines, [](const auto& line) { return std::optional(line.friction_angle); }));
      add_property(rock_property("direct_shear_cohesion_MPa"),
                   where_found(lines, [](const auto& line) { return std::optional(line.cohesion); }));
    }
  // Rows that identify the body: two bodies with different gaps are different rocks.
  for (double SpecimenReport::*const member :
       {&SpecimenReport::installation_gap_ratio, &SpecimenReport::coordination_number_core, &SpecimenReport::porosity})
    add(std::string(quantity_of(member).title), quantity_of(member).shown, of_bodies(tests, member), "", 1.0);
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

std::vector<std::string> properties_without_a_test(const std::vector<ComparisonRow>& rows,
                                                   const std::optional<Reference>& reference)
{
  std::vector<std::string> keys;
  if (reference)
    for (const auto& [key, value] : reference->experiment.values)
      if (!is_given(key) && std::ranges::none_of(rows, [&, wanted = key](const ComparisonRow& row) {
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
        const bool another_has_it = std::ranges::any_of(rows, [&](const ComparisonRow& other) {
          return other.property == row.property && other.ours; // another variant
        });
        const std::string sentence = fmt::format("No figure of {}: {}.", row.property, row.why_missing);
        if (!another_has_it && !contains(sentences, sentence))
          sentences.push_back(sentence);
      }
  if (const auto keys = properties_without_a_test(rows, reference); !keys.empty())
    sentences.push_back(fmt::format("Not tested here: the experiment's {}; {} and {} add tests.", fmt::join(keys, ", "),
                                    input_entries::test_list.text(), input_entries::confinements.text()));
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
      const std::string ours = row.ours ? text::mean_and_deviation(*row.ours, 1.0, row.decimals) : "-";
      if (row.ours || row.model || row.experiment)
        cells.push_back(
          {with_unit(row.property, row.unit), ours, as_text(row, row.model), as_text(row, row.experiment)});
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
