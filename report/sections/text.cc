#include "report/sections/text.h"

#include "base/text.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace feldspar::text
{
std::string number(const double value, const int decimals)
{
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

std::string significant(const double value, const int figures)
{
  if (value == 0.0 || !std::isfinite(value))
    return number(value, 0);
  // The decimals are those of the rounded value: 99.96 is 100.
  const std::string rounded = fmt::format("{:.{}e}", value, figures - 1);
  const int exponent = std::stoi(rounded.substr(rounded.find('e') + 1));
  return number(parse_number(rounded), std::max(0, figures - 1 - exponent));
}

std::string sentence(const std::string& words)
{
  return plot::with_capital(words) + (words.empty() || words.ends_with('.') ? "" : ".");
}

std::string number(const Figure& figure, const double unit, const int decimals)
{
  return figure.value ? number(*figure.value / unit, decimals) : none;
}

std::string estimate(const Estimate& value, const double unit, const int decimals)
{
  std::string text = number(value.value / unit, decimals);
  if (value.half_width.value)
    text += fmt::format(" ± {}", number(*value.half_width.value / unit, decimals));
  return text;
}

std::string two_values(const Statistics& over_seeds, const double unit, const int decimals)
{
  const double half_way = *over_seeds.standard_deviation / std::numbers::sqrt2; // between the two values
  return fmt::format("{} and {}", number((over_seeds.mean - half_way) / unit, decimals),
                     number((over_seeds.mean + half_way) / unit, decimals));
}

std::string mean_and_deviation(const std::optional<Statistics>& over_seeds, const double unit, const int decimals)
{
  if (!over_seeds)
    return none;
  if (has_two_values(*over_seeds))
    return "n = 2: " + two_values(*over_seeds, unit, decimals);
  std::string text = number(over_seeds->mean / unit, decimals);
  if (over_seeds->standard_deviation)
    text += fmt::format(" ± {}", number(*over_seeds->standard_deviation / unit, decimals));
  return text;
}

std::string interval(const std::optional<Statistics>& over_seeds, const double unit, const int decimals)
{
  // An interval from two values is thirteen standard deviations wide.
  constexpr std::size_t fewest = 3;
  if (!over_seeds || over_seeds->n < fewest || !over_seeds->confidence_95 ||
      *over_seeds->confidence_95 >= std::abs(over_seeds->mean))
    return none;
  return fmt::format("{} to {}", number((over_seeds->mean - *over_seeds->confidence_95) / unit, decimals),
                     number((over_seeds->mean + *over_seeds->confidence_95) / unit, decimals));
}

std::string signed_percent(const double share)
{
  const std::string percent = number(100.0 * std::abs(share), 1);
  return fmt::format("{}{} %", share < 0.0 && percent != "0.0" ? "−" : "+", percent);
}
} // namespace feldspar::text
