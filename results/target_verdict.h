#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// Decision on whether the mean of a rock's packings lies within the tolerance of a target. It rests on the 95 % interval of
/// the mean by Student's t, so that a mean beyond the tolerance is called reached in one case of twenty at most
/// (docs/theory.md §5.1).
namespace feldspar
{
enum class TargetVerdict
{
  reached,    ///< the interval lies within the tolerance
  missed,     ///< it lies beyond the tolerance
  not_decided ///< it holds a bound of the tolerance, or there is no interval
};

/// Name in calibration.json: reached, missed, not_decided.
std::string name(TargetVerdict verdict);
/// The same in a sentence.
std::string words(TargetVerdict verdict);
/// Verdict of a name; none for another name.
std::optional<TargetVerdict> verdict_of_name(const std::string& name);

/// A figure of packings beside its target; shares are of the target.
struct TargetMean
{
  std::string title;
  double deviation;                     ///< of the mean, a share
  std::optional<double> standard_error; ///< of the mean, a share; none from fewer than two packings
  std::size_t n;                        ///< packings that gave the figure

  std::optional<double> half_width() const; ///< of the 95 % interval, a share
};

TargetVerdict verdict_on(const TargetMean& mean, double tolerance);

/// Verdict on all targets together: missed if one is missed, reached if all are reached and there are some.
TargetVerdict verdict_on(const std::vector<TargetVerdict>& verdicts);

/// The number of packings whose mean has a 95 % interval of this half-width, where one packing scatters so much (both shares
/// of one thing); none above ten thousand.
std::optional<std::size_t> packings_for(double half_width, double scatter);

/// The number of packings that would decide a target which is not decided, if mean and scatter stay as they are; none above
/// ten thousand and where there is no scatter.
std::optional<std::size_t> packings_to_decide(const TargetMean& mean, double tolerance);

/// A sentence on targets that were tested; it begins with a small letter where not all are reached.
std::string statement_on(const std::vector<TargetMean>& means, double tolerance);
} // namespace feldspar
