#include "results/folder/reference.h"

#include "base/prefixes.h"

#include "base/contains.h"
#include "base/input_error.h"
#include "base/json_text.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/text.h"
#include "results/fits/hoek_brown.h"
#include "results/quantities.h"
#include "results/statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

/// A number that a source may give, and the values that one of a rock can have, in the unit at the end of its name.
struct Property
{
  std::string_view name;
  double least;
  double most;
};

constexpr Property confined_strength{"strength_at_P_MPa", 0.1, 20000.0};
constexpr Property other_strength{"KIND_strength_MPa", 1e-3, 20000.0};
constexpr Property confinement{"confining_pressure_MPa", 0.0, 5000.0};
constexpr Property least_stress{"sigma_3_MPa", -1000.0, 5000.0};
constexpr Property largest_stress{"sigma_1_MPa", 0.0, 20000.0};

/// Largest number of single tests, and of figures, of a source: the fits of its envelopes take seconds with a thousand points.
constexpr std::size_t most_strengths = 1000;

/// Pressure [MPa] in `strength_at_5_MPa` and the like; none in another name.
std::optional<double> pressure_in(const std::string_view name, const std::string_view beginning,
                                  const std::string_view ending)
{
  if (name.size() < beginning.size() + ending.size() || !name.starts_with(beginning) || !name.ends_with(ending))
    return std::nullopt;
  const auto pressure =
    number_in<double>(name.substr(beginning.size(), name.size() - beginning.size() - ending.size()));
  return pressure && *pressure > 0.0 && std::isfinite(*pressure) ? pressure : std::nullopt;
}

/// True triaxial strengths: triaxial_compression_5_MPa_intermediate_20_MPa_strength_MPa.
bool is_true_triaxial(const std::string_view name)
{
  constexpr std::string_view between = "_MPa_intermediate_";
  const std::size_t middle = name.find(between);
  return middle != std::string_view::npos && pressure_in(name.substr(0, middle + 4), "triaxial_compression_", "_MPa") &&
         pressure_in(name.substr(middle + 4), "_intermediate_", "_MPa_strength_MPa");
}

/// Returns whether this is the strength of a test that gives no point of the envelope: direct_shear_5_MPa_strength_MPa.
bool is_strength_of(const TestKind& kind, const std::string_view name)
{
  if (kind.envelope_role != EnvelopeRole::none)
    return false;
  return kind.takes_confining_pressure
           ? pressure_in(name, fmt::format("{}_", kind.name), "_MPa_strength_MPa").has_value()
           : name == fmt::format("{}_strength_MPa", kind.name);
}

std::optional<Property> property_of(const std::string_view name, const std::vector<TestKind>& kinds)
{
  for (const RockProperty& one : rock_properties)
    if (one.key == name)
      return Property{one.key, one.least, one.most};
  if (pressure_in(name, "strength_at_", "_MPa") || is_true_triaxial(name))
    return confined_strength;
  if (std::ranges::any_of(kinds, [&](const TestKind& kind) { return is_strength_of(kind, name); }))
    return other_strength;
  return std::nullopt;
}

/// Keys of other tests in the list of what a reference may give.
std::string keys_of_others(const std::vector<TestKind>& kinds)
{
  std::string keys;
  for (const TestKind& kind : kinds)
    if (kind.envelope_role == EnvelopeRole::none)
      keys += fmt::format(", {}{}_strength_MPa", kind.name, kind.takes_confining_pressure ? "_P_MPa" : "");
  return keys;
}

std::string key_of_strength(const double confining_pressure)
{
  return confining_pressure > 0.0 ? fmt::format("strength_at_{:g}_MPa", confining_pressure / mega)
                                  : "uniaxial_compressive_strength_MPa";
}

/// A place in the file, for errors.
struct Place
{
  std::string file;
  std::string path;

  Place operator/(const std::string_view key) const
  {
    return {file, path.empty() ? excerpt(key) : fmt::format("{}/{}", path, excerpt(key))};
  }

  [[noreturn]] void refuse(const std::string& problem) const
  {
    throw InputError("{}: {}{}{}", file, path, path.empty() ? "" : ": ", problem);
  }
};

/// Refuses what is no object of these names.
void expect_object(const Json& json, const std::vector<std::string_view>& known, const Place& place)
{
  if (!json.is_object())
    place.refuse(fmt::format("must be an object of {}", fmt::join(known, ", ")));
  for (const auto& [name, value] : json.items())
    if (!contains(known, name))
      (place / name).refuse(fmt::format("no such key; there are {}", fmt::join(known, ", ")));
}

double number(const Json& json, const Property& property, const Place& place)
{
  if (!json.is_number())
    place.refuse("must be a number");
  const auto value = json.get<double>();
  if (!(value >= property.least && value <= property.most))
    place.refuse(fmt::format("{:g} is no {} of a rock, which lies between {:g} and {:g}; is it in another unit?", value,
                             property.name, property.least, property.most));
  return value;
}

/// A number that must be there; `further`: the end of the error if it is not.
double required(const Json& json, const char* const key, const Property& property, const Place& place,
                const std::string_view further = "")
{
  if (!json.contains(key))
    place.refuse(fmt::format("{} is missing{}", key, further));
  return number(json[key], property, place / key);
}

std::string text(const Json& json, const Place& place)
{
  if (!json.is_string())
    place.refuse("must be a text");
  return printable(json.get<std::string>());
}

/// The range in which 95 % of further tests lie, of a normal distribution.
void set_range_by_deviation(ReferenceValue& value)
{
  constexpr double normal_factor = 1.959964;
  const double n = value.n.value_or(0);
  const double half =
    *value.standard_deviation * (value.n ? student_factor_95(*value.n - 1) * std::sqrt(1.0 + 1.0 / n) : normal_factor);
  value.low = *value.mean - half;
  value.high = *value.mean + half;
}

/// A number, or an object with the mean, the range, or both; or with mean, standard deviation and number of tests.
ReferenceValue value_of(const Json& json, const Property& property, const Place& place)
{
  ReferenceValue value{std::nullopt, std::nullopt, std::nullopt};
  if (json.is_number())
    {
      value.mean = number(json, property, place);
      return value;
    }
  expect_object(json, {"mean", "min", "max", "standard_deviation", "n", "note"}, place);
  const auto given = [&](const char* key, const Property& allowed) -> std::optional<double> {
    return json.contains(key) ? std::optional(number(json[key], allowed, place / key)) : std::nullopt;
  };
  value.mean = given("mean", property);
  value.low = given("min", property);
  value.high = given("max", property);
  value.standard_deviation = given("standard_deviation", {property.name, 0.0, property.most});
  if (json.contains("n"))
    {
      if (!json["n"].is_number_unsigned() || json["n"] < 1 || json["n"] > 1000000)
        (place / "n").refuse("must be the number of tests, an integer from 1");
      value.n = json["n"].get<unsigned int>();
    }
  if (json.contains("note"))
    text(json["note"], place / "note");
  if (!value.mean && !(value.low && value.high))
    place.refuse("needs a mean, or min and max");
  if (value.low.has_value() != value.high.has_value())
    place.refuse(fmt::format("has a {} and no {}; give both", value.low ? "min" : "max", value.low ? "max" : "min"));
  if (value.low && *value.low > *value.high)
    place.refuse(fmt::format("min = {:g} is above max = {:g}", *value.low, *value.high));
  if (value.mean && value.low && (*value.mean < *value.low || *value.mean > *value.high))
    place.refuse(
      fmt::format("mean = {:g} does not lie between min = {:g} and max = {:g}", *value.mean, *value.low, *value.high));
  if (value.standard_deviation && !value.mean)
    place.refuse("standard_deviation needs a mean");
  if (value.standard_deviation && value.n && *value.n < 2)
    (place / "n").refuse("must be 2 or more beside a standard_deviation");
  if (value.standard_deviation && !value.low)
    set_range_by_deviation(value);
  return value;
}

PrintedEnvelope envelope_of(const Json& json, const Place& place)
{
  expect_object(json, {"sigma_ci_MPa", "m", "s", "a", "note"}, place);
  const auto given = [&](const char* key, const double least, const double most) {
    return required(json, key, {key, least, most}, place, "; it needs sigma_ci_MPa, m, s and a");
  };
  return {mega * given("sigma_ci_MPa", 0.1, 5000.0), given("m", 1e-3, 1000.0), given("s", 0.0, 100.0),
          given("a", 0.01, 1.0)};
}

RockMass rock_mass_of(const Json& json, const Place& place)
{
  expect_object(json, {"GSI", "D", "note"}, place);
  return {required(json, "GSI", {"GSI", 5.0, 100.0}, place, ", the geological strength index from 5 to 100"),
          json.contains("D") ? number(json["D"], {"D", 0.0, 1.0}, place / "D") : 0.0};
}

/// Adds a test by its principal stresses. One whose sigma_2 differs from sigma_3 is no point of an envelope, but for an
/// extension test, which breaks under a negative sigma_3.
void add_principal_stresses(ReferenceSource& source, const Json& json, const Place& at)
{
  expect_object(json, {"sigma_1_MPa", "sigma_2_MPa", "sigma_3_MPa", "note"}, at);
  const auto stress = [&](const char* const key, const Property& property) {
    return mega * required(json, key, property, at);
  };
  const double sigma_3 = stress("sigma_3_MPa", least_stress);
  const double sigma_1 = stress("sigma_1_MPa", largest_stress);
  const double sigma_2 =
    json.contains("sigma_2_MPa") ? stress("sigma_2_MPa", {"sigma_2_MPa", -1000.0, 20000.0}) : sigma_3;
  if (!(sigma_3 <= sigma_2 && sigma_2 <= sigma_1 && sigma_3 < sigma_1))
    at.refuse("sigma_1 must be the largest and sigma_3 the least stress, compression positive");
  if (sigma_2 != sigma_3 && sigma_3 >= 0.0)
    source.true_triaxial.push_back({sigma_3, sigma_2, sigma_1});
  else
    source.triaxial.push_back({sigma_3, sigma_1});
}

void add_triaxial(ReferenceSource& source, const Json& json, const Place& place)
{
  if (!json.is_array() || json.empty())
    place.refuse(R"(must be a list of tests, [{"confining_pressure_MPa": 5, "strength_MPa": 240}, ...])");
  if (json.size() > most_strengths)
    place.refuse(fmt::format("has {} tests; there must be at most {}", json.size(), most_strengths));
  for (std::size_t k = 0; k < json.size(); ++k)
    {
      const Place at = place / fmt::format("{}", k + 1);
      if (json[k].is_object() && (json[k].contains("sigma_1_MPa") || json[k].contains("sigma_3_MPa")))
        {
          add_principal_stresses(source, json[k], at);
          continue;
        }
      expect_object(json[k], {"confining_pressure_MPa", "strength_MPa", "note"}, at);
      for (const char* const key : {"confining_pressure_MPa", "strength_MPa"})
        if (!json[k].contains(key))
          at.refuse(fmt::format("{} is missing", key));
      const EnvelopePoint point{mega *
                                  number(json[k]["confining_pressure_MPa"], confinement, at / "confining_pressure_MPa"),
                                mega * number(json[k]["strength_MPa"], confined_strength, at / "strength_MPa")};
      if (point.sigma_1 <= point.sigma_3)
        at.refuse("strength_MPa is sigma_1, which lies above the confining pressure");
      source.triaxial.push_back(point);
    }
  std::ranges::stable_sort(source.triaxial, {}, &EnvelopePoint::sigma_3);
}

/// Fewest tests for a range. From two, the range in which 95 % of further tests would lie holds nearly every rock.
constexpr std::size_t fewest_for_a_range = 3;

/// Means of the single tests under the names of mean strengths, where those are not given themselves.
void add_means(ReferenceSource& source)
{
  std::map<std::string, std::vector<double>> strengths;
  for (const auto& [sigma_3, sigma_1] : source.triaxial)
    if (sigma_3 >= 0.0)
      strengths[key_of_strength(sigma_3)].push_back(sigma_1 / mega);
  for (const auto& [sigma_3, sigma_2, sigma_1] : source.true_triaxial)
    strengths[fmt::format("triaxial_compression_{:g}_MPa_intermediate_{:g}_MPa_strength_MPa", sigma_3 / mega,
                          sigma_2 / mega)]
      .push_back(sigma_1 / mega);
  for (const auto& [key, tests] : strengths)
    {
      const Statistics over_tests = *statistics(tests);
      ReferenceValue value{over_tests.mean, std::nullopt, std::nullopt, over_tests.standard_deviation,
                           static_cast<unsigned int>(over_tests.n)};
      if (value.standard_deviation && over_tests.n >= fewest_for_a_range)
        set_range_by_deviation(value);
      source.values.emplace(key, value);
    }
}

StrengthData strengths_of(const ReferenceSource& source)
{
  const auto mean = [&](const char* key) -> std::optional<double> {
    const auto value = source.find(key, 1.0 / mega);
    return value ? value->mean : std::nullopt;
  };
  StrengthData data{{}, mean("uniaxial_compressive_strength_MPa"), mean("tensile_strength_MPa")};
  if (!data.tensile_strength)
    {
      data.tensile_strength = mean("brazilian_strength_MPa");
      data.tension_is_indirect = data.tensile_strength.has_value();
    }
  for (const auto& point : source.triaxial)
    if (point.sigma_3 == 0.0)
      data.points.push_back(point);
  if (data.points.empty() && data.uniaxial_compressive_strength)
    data.points.push_back({0.0, *data.uniaxial_compressive_strength});
  const auto confined = source.strengths();
  data.points.insert(data.points.end(), confined.begin(), confined.end());
  return data;
}

ReferenceSource source_of(const Json& json, const std::string& label, const std::vector<TestKind>& kinds,
                          const Place& place)
{
  ReferenceSource source;
  source.label = label;
  if (!json.is_object())
    place.refuse("must be an object of properties");
  if (json.size() > most_strengths)
    place.refuse(fmt::format("has {} names; there must be at most {}", json.size(), most_strengths));
  for (const auto& [name, entry] : json.items())
    {
      const Place at = place / name;
      if (name == "label")
        source.label = excerpt(text(entry, at));
      else if (name == "note")
        text(entry, at);
      else if (name == "failure")
        {
          if (!entry.is_object())
            at.refuse("must be an object of texts");
          for (const auto& [test, words] : entry.items())
            text(words, at / test);
        }
      else if (name == "hoek_brown")
        source.envelope = envelope_of(entry, at);
      else if (name == "triaxial")
        add_triaxial(source, entry, at);
      else if (name == "rock_mass")
        source.rock_mass = rock_mass_of(entry, at);
      else if (const auto property = property_of(name, kinds))
        {
          if (!entry.is_null()) // not measured
            source.values[name] = value_of(entry, *property, at);
        }
      else
        {
          std::vector<std::string_view> known;
          for (const RockProperty& one : rock_properties)
            if (known.empty() || known.back() != one.key) // a choice of several figures
              known.push_back(one.key);
          at.refuse(
            fmt::format("no such property; there are {}, strength_at_P_MPa for a pressure P in MPa{}, hoek_brown, "
                        "triaxial, rock_mass, label, note and failure",
                        fmt::join(known, ", "), keys_of_others(kinds)));
        }
    }
  add_means(source);
  source.fitted = fit_strength_envelopes(strengths_of(source));
  return source;
}
} // namespace

double ReferenceValue::middle() const { return mean ? *mean : 0.5 * (*low + *high); }

double PrintedEnvelope::sigma_1(const double sigma_3) const { return hoek_brown_sigma_1(sigma_3, sigma_ci, m, s, a); }

double PrintedLine::sigma_1(const double sigma_3) const
{
  const double sine = std::sin(friction_angle);
  const double slope = (1.0 + sine) / (1.0 - sine);
  return 2.0 * cohesion * std::sqrt(slope) + slope * sigma_3;
}

std::optional<ReferenceValue> ReferenceSource::find(const std::string& key, const double scale) const
{
  const auto found = values.find(key);
  if (found == values.end())
    return std::nullopt;
  ReferenceValue value = found->second;
  for (auto* number : {&value.mean, &value.low, &value.high, &value.standard_deviation})
    if (*number)
      **number /= scale;
  return value;
}

std::vector<EnvelopePoint> ReferenceSource::strengths() const
{
  std::vector<EnvelopePoint> points = triaxial;
  std::erase_if(points, [](const EnvelopePoint& point) { return point.sigma_3 == 0.0; });
  const auto singles = points;
  for (const auto& [name, value] : values)
    if (const auto pressure = pressure_in(name, "strength_at_", "_MPa"))
      if (const bool has_singles = std::ranges::any_of(
            singles,
            [&, wanted = name](const EnvelopePoint& point) { return key_of_strength(point.sigma_3) == wanted; });
          value.mean && !has_singles)
        points.push_back({*pressure * mega, *value.mean * mega});
  std::ranges::stable_sort(points, {}, &EnvelopePoint::sigma_3);
  return points;
}

std::optional<PrintedLine> ReferenceSource::line() const
{
  const auto angle = find("friction_angle_deg", 180.0 / std::numbers::pi);
  const auto cohesion = find("cohesion_MPa", 1.0 / mega);
  if (!angle || !cohesion)
    return std::nullopt;
  return PrintedLine{angle->middle(), cohesion->middle()};
}

Reference read_reference(const std::filesystem::path& file, const std::vector<TestKind>& kinds)
{
  const Place top{file.string(), ""};
  const Json json = parse_json(file.string(), content_of(file));
  expect_object(json, {"rock", "citation", "experiment", "paper_model", "note"}, top);
  if (!json.contains("experiment"))
    top.refuse("experiment is missing, the figures of the rock");

  Reference reference;
  if (json.contains("rock"))
    reference.rock = text(json["rock"], top / "rock");
  if (json.contains("note"))
    text(json["note"], top / "note");
  if (json.contains("citation"))
    {
      if (!json["citation"].is_object())
        (top / "citation").refuse("must be an object of texts");
      for (const auto& [name, words] : json["citation"].items())
        reference.citations.push_back(printable(fmt::format("{}: {}", name, text(words, top / "citation" / name))));
    }
  reference.experiment = source_of(json["experiment"], "experiment", kinds, top / "experiment");
  if (reference.experiment.values.empty() && !reference.experiment.envelope)
    (top / "experiment").refuse("has no property; give one, such as uniaxial_compressive_strength_MPa");
  reference.model.label = "reference model";
  if (json.contains("paper_model"))
    reference.model = source_of(json["paper_model"], reference.model.label, kinds, top / "paper_model");
  return reference;
}
} // namespace feldspar
