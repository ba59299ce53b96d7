#include "app/input/entry_parameter.h"

#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "app/input/quantity.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <functional>
#include <optional>
#include <system_error>
#include <type_traits>
#include <variant>
#include <vector>

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

/// Text of a range with `unit` (preceded by a space, or empty) behind each number.
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

/// Reads a number in SI. `demand` is the message where the value lies out of its range.
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
      return with_usual_exponent(value);
    }
  const Dimension& dimension = dimension_of(measure);
  const double value = parse_quantity(text, dimension);
  const Range si_range{range.left, to_si(range.lower, unit, dimension), to_si(range.upper, unit, dimension),
                       range.right};
  if (!si_range.contains(value))
    throw InputError(demand);
  return value;
}

std::string write_number(const double value, const Measure measure, const std::string_view unit)
{
  return measure == Measure::number ? format_number(value) : format_quantity(value, unit, dimension_of(measure));
}

std::string spaced(const std::string_view unit) { return unit.empty() ? "" : fmt::format(" {}", unit); }

/// The text of a value.
template <typename T>
struct ValueForm
{
  std::string unit;
  std::string range;
  std::function<T(const Input&, std::string_view)> read; ///< throws InputError
  std::function<std::string(const T&)> write;
};

ValueForm<double> form_of(const Entry<Input>::Number& number)
{
  const auto& [place, measure, unit, range] = number;
  return {std::string(unit), text_of(range, spaced(unit)),
          [measure = measure, unit = unit, range = range](const Input&, const std::string_view text) {
            return read_number(text, measure, unit, range, demand_of(range, spaced(unit)));
          },
          [measure = measure, unit = unit](const double value) { return write_number(value, measure, unit); }};
}

ValueForm<std::optional<double>> form_of(const Entry<Input>::OptionalNumber& number)
{
  const auto& [place, measure, unit, range] = number;
  return {std::string(unit), fmt::format("none, or {}", text_of(range, spaced(unit))),
          [measure = measure, unit = unit, range = range](const Input&,
                                                          const std::string_view text) -> std::optional<double> {
            if (text == none)
              return std::nullopt;
            return read_number(text, measure, unit, range,
                               fmt::format("{}, or be none", demand_of(range, spaced(unit))));
          },
          [measure = measure, unit = unit](const std::optional<double>& value) {
            return value ? write_number(*value, measure, unit) : std::string(none);
          }};
}

ValueForm<unsigned int> form_of(const Entry<Input>::Integer& integer)
{
  const std::string allowed = fmt::format("integer in {}", text_of(integer.range, ""));
  return {"", allowed,
          [allowed, range = integer.range](const Input&, const std::string_view text) {
            unsigned int value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (error != std::errc() || end != text.data() + text.size() || !range.contains(value))
              throw InputError(fmt::format("must be an {}", allowed));
            return value;
          },
          [](const unsigned int value) { return std::to_string(value); }};
}

ValueForm<std::string> form_of(const Entry<Input>::File& /*file*/)
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

ValueForm<std::size_t> form_of(const Entry<Input>::Choice& choice)
{
  const auto& options = choice.options;
  std::string range(options.front());
  if (options.size() == 1)
    range += " (the only choice in this version)";
  for (std::size_t k = 1; k < options.size(); ++k)
    range += fmt::format(" or {}", options[k]);
  return {"", range,
          [range, options](const Input&, const std::string_view text) {
            for (std::size_t k = 0; k < options.size(); ++k)
              if (options[k] == text)
                return k;
            throw InputError(fmt::format("must be {}{}", range, nearest_name(text, options)));
          },
          [options](const std::size_t k) { return std::string(options[k]); }};
}

} // namespace

Parameter parameter_of(const std::string_view section, const Entry<Input>& entry)
{
  Parameter parameter{section, entry.name, "", "", entry.meaning, entry.flags, entry.id, {}, {}};
  std::visit(
    [&](const auto& value) {
      using Kind = std::decay_t<decltype(value)>;
      if constexpr (std::is_same_v<Kind, Entry<Input>::Text>)
        {
          parameter.unit = value.unit;
          parameter.range = value.range;
          parameter.read = value.read;
          parameter.write = value.write;
        }
      else
        {
          const auto form = form_of(value);
          parameter.unit = form.unit;
          parameter.range = form.range;
          if constexpr (std::is_same_v<Kind, Entry<Input>::Choice>)
            {
              parameter.read = [=](Input& input, const std::string_view text) {
                value.set(input, form.read(input, text));
              };
              parameter.write = [=](const Input& input) { return form.write(value.get(input)); };
            }
          else
            {
              parameter.read = [=](Input& input, const std::string_view text) {
                value.place.at(input) = form.read(input, text);
              };
              parameter.write = [=](const Input& input) { return form.write(value.place.get(input)); };
            }
        }
    },
    entry.value);
  return parameter;
}
} // namespace feldspar
