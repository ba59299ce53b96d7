#include "app/input/entry_parameter.h"

#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "app/input/quantity.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>

namespace feldspar
{
namespace
{
constexpr std::size_t longest_path = 300; // in a message

const Dimension& dimension_of(const Measure measure)
{
  switch (measure)
    {
    case Measure::stress:
      return stress;
    case Measure::length:
      return length;
    case Measure::angle:
      return angle;
    case Measure::density:
      return density;
    case Measure::stiffness:
      return plane_stiffness;
    default:
      return rate;
    }
}

/// With `unit` (led by a space, or empty) behind each number.
std::string text_of(const Range& range, const std::string_view unit)
{
  if (range.upper == ranges::infinity)
    return fmt::format("{} {}{}", range.left == '[' ? ">=" : ">", range.lower, unit);
  return fmt::format("{}{}{}, {}{}{}", range.left, range.lower, unit, range.upper, unit, range.right);
}

/// The demand of an error.
std::string demand_of(const Range& range, const std::string_view unit)
{
  return fmt::format("must {} {}", range.upper == ranges::infinity ? "be" : "lie in", text_of(range, unit));
}

/// In SI. `demand`: said where the value lies out of its range.
double read_number(const std::string_view text, const Measure measure, const std::string_view unit, const Range& range,
                   const std::string& demand)
{
  if (measure == Measure::number)
    {
      if (text.find(' ') != std::string_view::npos)
        throw InputError(fmt::format("is a number without unit; it {}", demand));
      const double value = parse_number(text);
      if (!range.contains(value))
        throw InputError(demand);
      return value;
    }
  const Dimension& dimension = dimension_of(measure);
  const double value = parse_quantity(text, dimension);
  const Range si_range{range.left, to_si(range.lower, unit, dimension), to_si(range.upper, unit, dimension),
                       range.right};
  if (std::isinf(value)) // in SI, whatever it was in its unit
    throw InputError("is larger than any number this program can hold");
  if (!si_range.contains(value))
    throw InputError(demand);
  return value;
}

std::string write_number(const double value, const Measure measure, const std::string_view unit)
{
  return measure == Measure::number ? format_number(value) : format_quantity(value, unit, dimension_of(measure));
}

std::string spaced(const std::string_view unit) { return unit.empty() ? "" : fmt::format(" {}", unit); }
} // namespace

ValueForm<double> number_form(const Measure measure, const std::string_view unit, const Range& range)
{
  return {std::string(unit), text_of(range, spaced(unit)),
          [=](const Input&, const std::string_view text) {
            return read_number(text, measure, unit, range, demand_of(range, spaced(unit)));
          },
          [=](const double value) { return write_number(value, measure, unit); }};
}

ValueForm<std::optional<double>> optional_number_form(const Measure measure, const std::string_view unit,
                                                      const Range& range)
{
  return {std::string(unit), fmt::format("none, or {}", text_of(range, spaced(unit))),
          [=](const Input&, const std::string_view text) -> std::optional<double> {
            if (text == none)
              return std::nullopt;
            return read_number(text, measure, unit, range,
                               fmt::format("{}, or be none", demand_of(range, spaced(unit))));
          },
          [=](const std::optional<double>& value) {
            return value ? write_number(*value, measure, unit) : std::string(none);
          }};
}

ValueForm<unsigned int> integer_form(const Range& range)
{
  const std::string allowed = fmt::format("integer in {}", text_of(range, ""));
  return {"", allowed,
          [=](const Input&, const std::string_view text) {
            unsigned int value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (error != std::errc() || end != text.data() + text.size() || !range.contains(value))
              throw InputError(fmt::format("must be an {}", allowed));
            return value;
          },
          [](const unsigned int value) { return std::to_string(value); }};
}

ValueForm<std::string> file_form()
{
  return {"", std::string(none_or_a_file),
          [](const Input& input, const std::string_view text) {
            const std::filesystem::path path = text.empty() || text == none ? "" : input.file_named(text);
            std::error_code ignored;
            if (!path.empty() && !std::filesystem::exists(path, ignored))
              throw InputError(fmt::format("there is no file {}; a path is taken from the folder of the input",
                                           excerpt(path.string(), longest_path)));
            if (const std::string objection = path.empty() ? "" : objection_to_reading(path); !objection.empty())
              throw InputError(fmt::format("{} {}", excerpt(path.string(), longest_path), objection));
            return path.string();
          },
          [](const std::string& path) { return path.empty() ? std::string(none) : path; }};
}

ValueForm<std::size_t> choice_form(const std::vector<std::string_view>& options)
{
  std::string range(options.front());
  if (options.size() == 1)
    range += " (the only choice in this version)";
  for (std::size_t k = 1; k < options.size(); ++k)
    range += fmt::format(" or {}", options[k]);
  return {"", range,
          [=](const Input&, const std::string_view text) {
            for (std::size_t k = 0; k < options.size(); ++k)
              if (options[k] == text)
                return k;
            throw InputError(fmt::format("must be {}{}", range, nearest_name(text, options)));
          },
          [=](const std::size_t k) { return std::string(options[k]); }};
}
} // namespace feldspar
