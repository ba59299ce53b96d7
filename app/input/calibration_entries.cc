#include "app/input/input_entries.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/table/quantity.h"
#include "base/text.h"
#include "results/quantities.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>

/// The entries of a calibration that have a form of their own: its targets, and the bounds of its unknowns.
namespace feldspar
{
namespace
{
constexpr std::string_view all_targets = "all";
constexpr std::string_view fixed_value = "fixed";

std::vector<std::string> read_targets(const std::string_view text)
{
  std::vector<std::string> targets;
  if (text == all_targets)
    return targets;
  for (const std::string_view piece : split_at_commas(text))
    {
      if (!is_plain_name(piece))
        throw InputError("{} is no name of a figure; an example is youngs_modulus, tensile_strength", in_quotes(piece));
      if (contains(targets, piece))
        throw InputError("{} is listed twice", piece);
      targets.emplace_back(piece);
    }
  return targets;
}

/// `fixed`, or the lower and the upper bound of an unknown.
Entry<CalibrationParameters> bounds_entry(const std::string_view name,
                                          std::optional<Bounds> CalibrationParameters::*const member, const Range range,
                                          const Dimension* const dimension, const std::string_view meaning)
{
  using P = CalibrationParameters;
  const std::string_view unit = dimension ? "deg" : ""; // a literal: the entry keeps the view
  const auto read = [=](P& wanted, const std::string_view text) {
    wanted.*member = std::nullopt;
    if (text == fixed_value)
      return;
    std::vector<double> values;
    if (dimension)
      values = parse_quantities(text, *dimension);
    else
      for (const std::string_view piece : split_at_commas(text))
        values.push_back(parse_number(piece));
    if (values.size() != 2 || !(values[0] < values[1]))
      throw InputError("must be fixed, or the lower and the upper bound, e.g. {}",
                       dimension ? "0, 40 deg" : "0.2, 1.2");
    for (const double value : values)
      if (!range.contains(dimension ? value * 180.0 / std::numbers::pi : value))
        throw InputError("bounds must lie in {}{:g}, {:g}{}{}{}", range.left, range.lower, range.upper, range.right,
                         unit.empty() ? "" : " ", unit);
    wanted.*member = Bounds{values[0], values[1]};
  };
  const auto write = [=](const P& wanted) {
    const auto& bounds = wanted.*member;
    if (!bounds)
      return std::string(fixed_value);
    const double scale = dimension ? 180.0 / std::numbers::pi : 1.0;
    return fmt::format("{}, {}{}{}", format_number(bounds->lower * scale), format_number(bounds->upper * scale),
                       unit.empty() ? "" : " ", unit);
  };
  return {name, Entry<P>::Text{unit, "fixed, or lower and upper bound", read, write}, meaning, {}};
}
} // namespace

std::vector<Entry<CalibrationParameters>> calibration_list_entries()
{
  using P = CalibrationParameters;
  constexpr double most = 1e6;
  static const std::string meaning_of_targets = [] {
    std::vector<std::string_view> names;
    for (const RockProperty& property : rock_properties)
      if (property.scale && (names.empty() || names.back() != property.target())) // a choice of several figures
        names.push_back(property.target());
    return fmt::format("figures of the experiment in the reference file that `feldspar calibrate` is to reach: {}, "
                       "strength_at_P_MPa; all: those that the tests give",
                       fmt::join(names, ", "));
  }();
  const auto write = [](const std::vector<std::string>& targets) {
    return targets.empty() ? std::string(all_targets) : fmt::format("{}", fmt::join(targets, ", "));
  };
  return {entry::text("Targets", &P::targets, "", "all, or names of figures", read_targets, write, meaning_of_targets,
                      {.basic = true}),
          bounds_entry("Stiffness ratio", &P::stiffness_ratio, {'(', 0.0, most, ')'}, nullptr, "of the joints"),
          bounds_entry("Cohesion ratio", &P::cohesion_ratio, {'(', 0.0, most, ')'}, nullptr,
                       "bond cohesion over bond tensile strength"),
          bounds_entry("Bond friction angle", &P::bond_friction_angle, {'[', 0.0, 90.0, ')'}, &angle,
                       "by which compression adds to the shear strength of a bond"),
          bounds_entry("Friction", &P::friction, {'[', 0.0, most, ')'}, nullptr, "of broken segments"),
          bounds_entry("Boundary strength", &P::boundary_strength, {'(', 0.0, most, ')'}, nullptr,
                       "factor on the strengths of the joints between mineral grains"),
          bounds_entry("Installation gap ratio", &P::installation_gap_ratio, {'(', 0.0, 1.0, ']'}, nullptr,
                       "largest gap that gets a joint, over the mean radius")};
}
} // namespace feldspar
