#include "app/input/entry_parameter.h"

#include "app/input/nearest_name.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/table/quantity.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <variant>

namespace feldspar
{
namespace
{
const Dimension& dimension_of(const Measure measure)
{
  constexpr const Dimension* dimensions[] = {nullptr, &stress,          &length,          &angle, &density,
                                             &rate,   &plane_stiffness, &spring_stiffness}; // by their enumerators
  return *dimensions[std::size_t(measure)];
}

/// Text of a range with the unit behind each number.
std::string text_of(const Range& range, const std::string_view of_range)
{
  const std::string unit = of_range.empty() ? "" : fmt::format(" {}", of_range);
  if (range.upper == ranges::infinity)
    return fmt::format("{} {}{}", range.left == '[' ? ">=" : ">", range.lower, unit);
  return fmt::format("{}{}{}, {}{}{}", range.left, range.lower, unit, range.upper, unit, range.right);
}

std::string write_number(const double value, const Measure measure, const std::string_view unit)
{
  return measure == Measure::number ? format_number(value) : format_quantity(value, unit, dimension_of(measure));
}

using Text = Entry<Input>::Text;

Text text_form(const Entry<Input>::Text& text) { return text; }

Text text_form(const Entry<Input>::Number& number)
{
  return {number.unit, text_of(number.range, number.unit),
          [number](Input& input, const std::string_view text) {
            number.place.at(input) = read_number(text, number.measure, number.unit, number.range);
          },
          [number](const Input& input) { return write_number(number.place.get(input), number.measure, number.unit); }};
}

Text text_form(const Entry<Input>::OptionalNumber& number)
{
  return {number.unit, fmt::format("none, or {}", text_of(number.range, number.unit)),
          [number](Input& input, const std::string_view text) {
            std::optional<double>& value = number.place.at(input);
            if (text == none)
              value.reset();
            else
              value = read_number(text, number.measure, number.unit, number.range, ", or be none");
          },
          [number](const Input& input) {
            const std::optional<double>& value = number.place.get(input);
            return value ? write_number(*value, number.measure, number.unit) : std::string(none);
          }};
}

Text text_form(const Entry<Input>::Integer& integer)
{
  const std::string allowed = fmt::format("integer in {}", text_of(integer.range, ""));
  return {"", allowed,
          [allowed, integer](Input& input, const std::string_view text) {
            const auto value = number_in<unsigned int>(text);
            if (!value || !integer.range.contains(*value))
              throw InputError("must be an {}", allowed);
            integer.place.at(input) = *value;
          },
          [integer](const Input& input) { return std::to_string(integer.place.get(input)); }};
}

Text text_form(const Entry<Input>::File& file)
{
  return {"", std::string(none_or_a_file),
          [file](Input& input, const std::string_view text) { file.place.at(input) = readable_file(input, text); },
          [file](const Input& input) { return or_none(file.place.get(input)); }};
}

Text text_form(const Entry<Input>::Choice& choice)
{
  const auto& options = choice.options;
  std::string range(options.front());
  if (options.size() == 1)
    range += " (the only choice in this version)";
  for (std::size_t k = 1; k < options.size(); ++k)
    range += fmt::format(" or {}", options[k]);
  return {"", range,
          [range, choice](Input& input, const std::string_view text) {
            const auto found = std::ranges::find(choice.options, text);
            if (found == choice.options.end())
              throw InputError("must be {}{}", range, nearest_name(text, choice.options));
            choice.set(input, std::size_t(found - choice.options.begin()));
          },
          [choice](const Input& input) { return std::string(choice.options[choice.get(input)]); }};
}
} // namespace

double read_number(const std::string_view text, const Measure measure, const std::string_view unit, const Range& range,
                   const std::string_view or_else)
{
  const std::string demand =
    fmt::format("must {} {}{}", range.upper == ranges::infinity ? "be" : "lie in", text_of(range, unit), or_else);
  double value = 0.0;
  Range in_si = range;
  if (measure == Measure::number)
    {
      if (text.find(' ') != std::string_view::npos)
        throw InputError("is a number without unit; it {}", demand);
      value = with_usual_exponent(parse_number(text));
    }
  else
    {
      const Dimension& dimension = dimension_of(measure);
      value = parse_quantity(text, dimension);
      in_si = {range.left, to_si(range.lower, unit, dimension), to_si(range.upper, unit, dimension), range.right};
    }
  if (!in_si.contains(value))
    throw InputError(demand);
  return value;
}

std::string readable_file(const Input& input, const std::string_view text)
{
  if (text.empty() || text == none)
    return "";
  constexpr std::size_t longest_path = 300; // in a message
  const std::filesystem::path path = input.file_named(text);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw InputError("there is no file {}; a path is taken from the folder of the input",
                     excerpt(path.string(), longest_path));
  if (const std::string objection = objection_to_reading(path); !objection.empty())
    throw InputError("{} {}", excerpt(path.string(), longest_path), objection);
  return path.string();
}

Parameter parameter_of(const std::string& section, const Entry<Input>& entry)
{
  const Text form = std::visit([](const auto& value) { return text_form(value); }, entry.value);
  return {section,   entry.name, std::string(form.unit), form.range, entry.meaning, entry.flags, entry.id,
          form.read, form.write};
}
} // namespace feldspar
