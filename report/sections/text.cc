#include "report/sections/text.h"

#include <fmt/format.h>

#include <cmath>

namespace feldspar::text
{
std::string number(const double value, const int decimals) { return fmt::format("{:.{}f}", value, decimals); }

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

std::string mean_and_deviation(const Statistics& over_seeds, const double unit, const int decimals)
{
  std::string text = number(over_seeds.mean / unit, decimals);
  if (over_seeds.standard_deviation)
    text += fmt::format(" ± {}", number(*over_seeds.standard_deviation / unit, decimals));
  return text;
}

std::string interval(const Statistics& over_seeds, const double unit, const int decimals)
{
  // From two it is thirteen standard deviations wide.
  constexpr std::size_t fewest = 3;
  if (over_seeds.n < fewest || !over_seeds.confidence_95 || *over_seeds.confidence_95 >= std::abs(over_seeds.mean))
    return none;
  return fmt::format("{} to {}", number((over_seeds.mean - *over_seeds.confidence_95) / unit, decimals),
                     number((over_seeds.mean + *over_seeds.confidence_95) / unit, decimals));
}

std::string signed_percent(const double share)
{
  return fmt::format("{}{:.1f} %", share < 0.0 ? "−" : "+", 100.0 * std::abs(share));
}
} // namespace feldspar::text
