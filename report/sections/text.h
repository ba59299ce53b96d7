#pragma once

#include "base/prefixes.h"
#include "laboratory/record.h"
#include "results/fits/fit.h"
#include "results/statistics.h"

#include <optional>
#include <string>

/// Numbers as the page writes them, in a unit and with a number of decimals.
namespace feldspar::text
{
inline constexpr const char* none = "–";

std::string number(double value, int decimals); ///< zero without a sign
/// Number to so many figures, without an exponent and without decimals beyond them: 0.150, 15.3, 119.
std::string significant(double value, int figures);
std::string sentence(const std::string& words);                         ///< with a capital letter and a full stop
std::string number(const Figure& figure, double unit, int decimals);    ///< or none
std::string estimate(const Estimate& value, double unit, int decimals); ///< 42.0 ± 1.5, half of the 95 % interval
/// Two specimens have no scatter to speak of: both values are given, 40.9 and 43.1.
inline bool has_two_values(const Statistics& over_seeds)
{
  return over_seeds.n == 2 && over_seeds.standard_deviation.has_value();
}
std::string two_values(const Statistics& over_seeds, double unit, int decimals);
/// 42.0 ± 1.5, over the seeds; or none.
std::string mean_and_deviation(const std::optional<Statistics>& over_seeds, double unit, int decimals);
/// Interval of the mean, 95 %; or none.
std::string interval(const std::optional<Statistics>& over_seeds, double unit, int decimals);
std::string signed_percent(double share); ///< +1.5 %, with a minus that is one
} // namespace feldspar::text
