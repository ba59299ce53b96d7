#pragma once

#include "base/prefixes.h"
#include "laboratory/test_outcome.h"

#include <fmt/format.h>

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

/// The form of a quantity of a test, and of a property of the rock; the tables are in results/quantities.h.
namespace feldspar
{
/// A figure, or the reason why it could not be had.
struct Figure
{
  std::optional<double> value;
  std::string reason;
};

struct TestResults;

/// The curve of a test up to its peak, or of a test without one up to its first crack (results/evaluation/rising_branch.h).
class RisingBranch;

/// Unit and decimals of a number on pages.
struct ShownIn
{
  std::string_view unit = {};
  double scale = 1.0; ///< of the unit in SI
  int decimals = 3;
};

namespace display
{
inline constexpr double degree = std::numbers::pi / 180.0;
inline constexpr ShownIn gigapascals{"GPa", giga, 1};
inline constexpr ShownIn thousandths{"1e-3", milli, 2};
inline constexpr ShownIn degrees{"deg", degree, 1};
constexpr ShownIn megapascals(const int decimals = 1) { return {"MPa", mega, decimals}; }
constexpr ShownIn percent(const int decimals) { return {"%", 1e-2, decimals}; }
constexpr ShownIn plain(const int decimals) { return {"", 1.0, decimals}; }
} // namespace display

/// "title [unit]"; of a number without a unit the title.
inline std::string with_unit(const std::string_view title, const std::string_view unit)
{
  return unit.empty() ? std::string(title) : fmt::format("{} [{}]", title, unit);
}

/// The tests that give a quantity.
struct TestsThatGive
{
  std::string_view words = "all";
  const char* (*objection)(const TestRecord& record) = nullptr; ///< the reason of another test; null of one of them
};

/// Subject of a quantity.
enum class QuantityOf
{
  loading,  ///< known before the test
  rock,     ///< or of this body
  specimen, ///< before the test
  method,   ///< how near the test was to what it stands for
  effort    ///< of no meaning for the rock
};

/// Data that a quantity is read from and that not every curve measured in a laboratory has: none has cracks or motion.
enum class NeedsBesidesCurve
{
  nothing,
  cracks,
  motion,
  lateral_strain,
  fall ///< after the peak
};

/// The column of a quantity in the table of tests on a page; files have all.
enum class PageColumn
{
  never,
  always,
  where_given ///< by one of the tests
};

enum class BoundSide
{
  at_most,
  at_least
};

/// A value beyond which a test is doubtful; the reasons are in docs/report.md.
struct PlausibleBound
{
  BoundSide side;
  double value; ///< in SI
};

constexpr PlausibleBound at_most(const double value) { return {BoundSide::at_most, value}; }
constexpr PlausibleBound at_least(const double value) { return {BoundSide::at_least, value}; }

/// Marks a quantity that a test without a peak gives too, from its curve before the first crack.
struct NeedsNoPeak
{
};

/// Picture of a quantity in studies, by the part of its name in files; empty: none is drawn.
struct InStudies
{
  std::string_view picture;
};

/// Reason of a number that is NaN.
struct NanMeans
{
  std::string_view reason;
};

/// A row of the table of quantities.
struct TestQuantity
{
  using Member = std::variant<Figure TestResults::*, double TestResults::*, std::uint64_t TestResults::*,
                              double TestRecord::*, double SpecimenReport::*, std::uint64_t SpecimenReport::*,
                              double RunBookkeeping::*, std::uint64_t RunBookkeeping::*>;
  /// Evaluation of a quantity; none of a number that the test counts or knows itself.
  using Evaluation = std::variant<std::monostate, Figure (*)(const RisingBranch&), Figure (*)(const TestRecord&)>;

  Member member;
  Evaluation evaluate;
  std::string_view name;  ///< in files; ends in its SI unit
  std::string_view title; ///< on pages
  ShownIn shown;
  std::string_view meaning;
  QuantityOf of = QuantityOf::rock;
  TestsThatGive tests = {};
  NeedsBesidesCurve needs = NeedsBesidesCurve::nothing;
  PageColumn column = PageColumn::never;
  InStudies studies = {};
  std::optional<PlausibleBound> bound = {};
  NanMeans nan = {};
  bool needs_no_peak = false;

  /// The member of a figure; null of other numbers.
  constexpr Figure TestResults::*figure() const
  {
    const auto* const found = std::get_if<Figure TestResults::*>(&member);
    return found ? *found : nullptr;
  }
  /// Returns whether only a model has the quantity, and no curve measured on rock.
  constexpr bool is_of_model() const { return !figure() && of != QuantityOf::loading; }

  constexpr void set(const QuantityOf value) { of = value; }
  constexpr void set(const TestsThatGive& value) { tests = value; }
  constexpr void set(const NeedsBesidesCurve value) { needs = value; }
  constexpr void set(const PageColumn value) { column = value; }
  constexpr void set(const InStudies& value) { studies = value; }
  constexpr void set(const PlausibleBound& value) { bound = value; }
  constexpr void set(const NanMeans& value) { nan = value; }
  constexpr void set(const NeedsNoPeak&) { needs_no_peak = true; }
};

/// Tests, or fits to them, that give a property of the rock.
enum class PropertySource
{
  given,            ///< to a model; no test gives it
  tension,          ///< a test that pulls
  compression,      ///< without confinement
  indirect_tension, ///< a disc that is split
  notch,            ///< each kind of test with a notch
  tilt,             ///< of the plate below a body
  fit               ///< of several tests
};

/// Returns whether tests of a kind give properties of this source.
constexpr bool gives(const PropertySource source, const TestKind& kind)
{
  switch (source)
    {
    case PropertySource::tension:
      return kind.envelope_role == EnvelopeRole::tension;
    case PropertySource::compression:
      return kind.envelope_role == EnvelopeRole::compression && !kind.takes_confining_pressure;
    case PropertySource::indirect_tension:
      return kind.envelope_role == EnvelopeRole::indirect_tension;
    case PropertySource::notch:
      return kind.has_notch;
    case PropertySource::tilt:
      return kind.tilts;
    case PropertySource::given:
    case PropertySource::fit:
      break;
    }
  return false;
}

/// Scale of the micro-parameters with which a property goes, all their ratios kept.
enum class ResponseScale
{
  modulus,  ///< of the joints
  strength, ///< of the bonds in tension
  ratio,    ///< of strengths: with neither
  none      ///< Poisson's ratio
};

/// Choice among several figures of one key.
struct Choice
{
  std::string_view name;
  bool hidden_otherwise = false; ///< in comparisons
};

/// The unit of a key in a reference file, where it is another than that in which the property is shown.
struct KeyIn
{
  double unit; ///< in SI
};

/// A property of the rock, which a reference may give: the mean of a quantity over tests of one kind, or a fit.
struct RockProperty
{
  std::string_view key; ///< in a reference file; ends in its unit
  PropertySource source;
  double least; ///< that a rock can have, in the unit of the key; wide, to find a number in another unit
  double most;
  Figure TestResults::*figure; ///< null of a fit
  std::string_view title;
  ShownIn shown;
  KeyIn key_in;
  std::optional<ResponseScale> scale = {}; ///< of a possible target of a calibration
  Choice choice = {};

  /// The name of a target of a calibration: the key without its unit.
  constexpr std::string_view target() const
  {
    return key.ends_with("_MPa") || key.ends_with("_GPa") ? key.substr(0, key.size() - 4) : key;
  }

  constexpr void set(const std::string_view value) { title = value; }
  constexpr void set(const ShownIn& value)
  {
    shown = value;
    key_in.unit = value.scale;
  }
  constexpr void set(const KeyIn& value) { key_in = value; }
  constexpr void set(const ResponseScale value) { scale = value; }
  constexpr void set(const Choice& value) { choice = value; }
};
} // namespace feldspar
