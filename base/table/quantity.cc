#include "base/table/quantity.h"

#include "base/input_error.h"
#include "base/quoted.h"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace feldspar
{
namespace
{
/// Letters of any language: every byte of a UTF-8 sequence counts as one.
bool is_letter(const char c)
{
  return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || c == '%' || c == '_' || (c & 0x80) != 0;
}

std::size_t count_digits(const std::string_view text)
{
  return std::min(text.find_first_not_of("0123456789"), text.size());
}

/// Returns whether all of the text is names with integer powers, joined by . * /, as in kg/m^3 or N.mm-2; 1/s is one
/// too. Factors and origins (`MPa.3`, `since 1990`), which UDUNITS would apply without a word, are none.
bool is_unit_expression(std::string_view text)
{
  if (text.starts_with("1/"))
    text.remove_prefix(2);
  while (true)
    {
      std::size_t n = 0;
      while (n < text.size() && is_letter(text[n]))
        ++n;
      if (n == 0)
        return false;
      text.remove_prefix(n);

      const bool power_follows = text.starts_with('^') || text.starts_with('-');
      text.remove_prefix(text.starts_with('^'));
      text.remove_prefix(text.starts_with('-'));
      const std::size_t n_digits = count_digits(text);
      if (power_follows && n_digits == 0)
        return false;
      text.remove_prefix(n_digits);

      if (text.empty())
        return true;
      if (text.front() != '.' && text.front() != '*' && text.front() != '/')
        return false;
      text.remove_prefix(1);
    }
}

struct Free
{
  void operator()(ut_system* system) const { ut_free_system(system); }
  void operator()(ut_unit* unit) const { ut_free(unit); }
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
template <typename T>
using Owner = std::unique_ptr<T, Free>;

/// UDUNITS reads the numbers of its own tables by the locale of the thread: the C locale, for as long as this lives.
class CLocale
{
public:
  CLocale() = default;
  CLocale(const CLocale&) = delete;
  CLocale& operator=(const CLocale&) = delete;
  ~CLocale()
  {
    uselocale(previous);
    freelocale(c_locale);
  }

private:
  const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
  const locale_t previous = uselocale(c_locale);
};

Owner<ut_system> read_unit_system()
{
  ut_set_error_message_handler(ut_ignore);
  Owner<ut_system> system(ut_read_xml(nullptr));
  if (!system)
    throw std::runtime_error("the table of units cannot be read; is the package libudunits2-data installed?");
  const Owner<ut_unit> degree(ut_get_unit_by_name(system.get(), "degree"));
  ut_map_name_to_unit("deg", UT_ASCII, degree.get());
  return system;
}

/// UDUNITS is not made for several threads at once: its parser keeps its place in global variables.
std::mutex of_units;

/// Parses a unit; to be called under the lock.
Owner<ut_unit> parse_unit(const std::string_view text)
{
  const CLocale c_locale;
  static const Owner<ut_system> system = read_unit_system();
  return Owner<ut_unit>(ut_parse(system.get(), std::string(text).c_str(), UT_UTF8));
}

/// For UDUNITS the radian is a pure number and could come and go unseen (`22 %` as an angle, `22 MPa.rad` as a stress):
/// here it must be the same on both sides.
bool are_of_one_dimension(ut_unit* unit, ut_unit* si_unit)
{
  if (!ut_are_convertible(unit, si_unit))
    return false;
  const Owner<ut_unit> ratio(ut_divide(unit, si_unit));
  std::array<char, 256> definition{};
  return ratio && ut_format(ratio.get(), definition.data(), definition.size(), UT_ASCII | UT_DEFINITION) > 0 &&
         std::string_view(definition.data()).find("rad") == std::string_view::npos;
}

bool is_known_unit(const std::string_view text)
{
  const std::lock_guard lock(of_units);
  return is_unit_expression(text) && parse_unit(text);
}

std::string advice(const Dimension& dimension)
{
  return fmt::format("write {}, e.g. \"{}\"", dimension.name, dimension.example);
}

/// The position of the space between number and unit, both checked for their form.
std::size_t find_space(const std::string_view text, const Dimension& dimension)
{
  const std::size_t space = text.find(' ');
  const std::string_view number = text.substr(0, space);
  if (text.empty() || (space == std::string_view::npos && is_known_unit(text)))
    throw InputError("a number is missing; {}", advice(dimension));
  if (!is_decimal_number(number))
    throw InputError("{} is not a decimal number; {}", in_quotes(number), advice(dimension));
  if (space == std::string_view::npos)
    throw InputError("a unit is missing; {}", advice(dimension));
  if (!is_unit_expression(text.substr(space + 1)))
    throw InputError("{} is not one unit; {}", in_quotes(text.substr(space + 1)), advice(dimension));
  return space;
}
} // namespace

double to_si(const double value, const std::string_view unit, const Dimension& dimension)
{
  const std::lock_guard lock(of_units);
  const Owner<ut_unit> from = parse_unit(unit);
  const Owner<ut_unit> si = parse_unit(dimension.si_unit);
  if (!from)
    throw InputError("{} is not a known unit; {}", in_quotes(unit), advice(dimension));
  if (!are_of_one_dimension(from.get(), si.get()))
    throw InputError("{} is not the unit of {}; {}", in_quotes(unit), dimension.name, advice(dimension));
  const Owner<cv_converter> converter(ut_get_converter(from.get(), si.get()));
  const double in_si = cv_convert_double(converter.get(), value);
  if (std::isfinite(value) && !std::isfinite(in_si))
    throw InputError("{:g} {} is beyond the range of numbers; {}", value, unit, advice(dimension));
  return in_si;
}

double with_usual_exponent(const double value)
{
  constexpr double smallest = 1e-30;
  constexpr double largest = 1e30;
  if (std::abs(value) > largest)
    throw InputError("is too large; a number is at most {:g} in SI units", largest);
  return std::abs(value) < smallest ? 0.0 : value;
}

double parse_quantity(const std::string_view text, const Dimension& dimension)
{
  const std::size_t space = find_space(text, dimension);
  return with_usual_exponent(to_si(parse_number(text.substr(0, space)), text.substr(space + 1), dimension));
}

std::vector<std::string> values_of_range(const std::string_view text)
{
  constexpr double most_values = 10000.0;
  constexpr std::string_view step_word = " step ";
  const std::size_t dots = text.find("..");
  const std::string_view first = trim(text.substr(0, dots));
  if (dots == std::string_view::npos || !is_decimal_number(first))
    return {std::string(text)};
  const auto refusal = [&](const std::string_view what) {
    return InputError("{}: {}; a range is written as in \"10..60 MPa step 10\"", in_quotes(text), what);
  };
  const std::string_view rest = trim(text.substr(dots + 2));
  const std::size_t word = rest.find(step_word);
  if (word == std::string_view::npos)
    throw refusal("the step is missing");
  const auto number_and_unit = [&](const std::string_view piece) {
    const std::size_t space = std::min(piece.find(' '), piece.size());
    if (!is_decimal_number(piece.substr(0, space)))
      throw refusal(fmt::format("{} is not a decimal number", in_quotes(piece.substr(0, space))));
    return std::pair(piece.substr(0, space), trim(piece.substr(space)));
  };
  const auto [last, unit_of_last] = number_and_unit(trim(rest.substr(0, word)));
  const auto [step, unit_of_step] = number_and_unit(trim(rest.substr(word + step_word.size())));
  if (!unit_of_last.empty() && !unit_of_step.empty())
    throw refusal("the unit stands once, after the last number or the step");
  const std::string_view unit = unit_of_last.empty() ? unit_of_step : unit_of_last;
  const double begin = parse_number(first);
  const double by = parse_number(step);
  const double n_steps = (parse_number(last) - begin) / by;
  if (by == 0.0)
    throw refusal("the step is 0");
  if (n_steps < 0.0)
    throw refusal("the step leads away from the last value");
  if (!(n_steps < most_values))
    throw refusal(fmt::format("more than {:.0f} values", most_values));
  if (std::abs(n_steps - std::round(n_steps)) > 1e-9 * std::max(1.0, n_steps)) // decimal fractions are not exact
    throw refusal("the last value is no whole number of steps from the first");
  std::vector<std::string> values;
  for (long k = 0; k <= std::lround(n_steps); ++k)
    values.push_back(format_number(begin + double(k) * by) + (unit.empty() ? "" : fmt::format(" {}", unit)));
  return values;
}

std::vector<double> parse_quantities(const std::string_view text, const Dimension& dimension)
{
  if (text.find(';') != std::string_view::npos)
    throw InputError("numbers are separated by commas and the unit stands once, e.g. \"5, 10, 20 MPa\"");
  const std::vector<std::string_view> pieces = split_at_commas(text);
  const std::string last = values_of_range(pieces.back()).back();
  const std::string unit = last.substr(find_space(last, dimension));
  std::vector<double> values;
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (std::string value : values_of_range(pieces[k]))
      {
        if (k + 1 < pieces.size() && value.find(' ') != std::string::npos)
          throw InputError("{}: the unit stands once, after the last number", in_quotes(value));
        values.push_back(parse_quantity(k + 1 < pieces.size() ? value + unit : value, dimension));
      }
  return values;
}

double unit_in_si(const std::string_view unit, const Dimension& dimension)
{
  constexpr std::pair<std::string_view, double> units_of_strain[] = {
    {"-", 1.0},   {"mm/mm", 1.0}, {"m/m", 1.0},   {"‰", 1e-3},    {"mε", 1e-3},    {"millistrain", 1e-3},
    {"µε", 1e-6}, {"με", 1e-6},   {"µm/m", 1e-6}, {"um/m", 1e-6}, {"10^-6", 1e-6}, {"microstrain", 1e-6}};
  if (&dimension == &strain)
    {
      if (is_decimal_number(unit) && parse_number(unit) > 0.0)
        return parse_number(unit);
      for (const auto& [name, in_si] : units_of_strain)
        if (unit == name)
          return in_si;
    }
  if (unit == dimension.si_unit || (&dimension == &energy && unit == "eu"))
    return 1.0;
  return parse_quantity(fmt::format("1 {}", unit), dimension);
}

std::string format_number(const double value) { return fmt::format("{:.15g}", value); }

std::string format_quantity(const double value_in_si, const std::string_view unit, const Dimension& dimension)
{
  const double si_per_unit = to_si(1.0, unit, dimension);
  return fmt::format("{} {}", format_number(value_in_si / si_per_unit), unit);
}
} // namespace feldspar
