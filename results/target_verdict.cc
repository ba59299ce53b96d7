#include "results/target_verdict.h"

#include "laboratory/named_entries.h"
#include "results/statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

namespace feldspar
{
namespace
{
constexpr std::size_t most_packings_told = 10000;

constexpr std::string_view verdict_names[] = {"reached", "missed", "not_decided"}; // by their enumerators

/// The scatter of one packing, a share of the target.
std::optional<double> scatter_of(const TargetMean& mean)
{
  return mean.standard_error ? std::optional(*mean.standard_error * std::sqrt(double(mean.n))) : std::nullopt;
}

std::string deviation_in_words(const TargetMean& mean)
{
  const auto half_width = mean.half_width();
  const double shown = std::abs(mean.deviation) < 0.0005 ? 0.0 : mean.deviation; // no -0.0
  return half_width ? fmt::format("{} {:+.1f} ± {:.1f} %", mean.title, 100.0 * shown, 100.0 * *half_width) : mean.title;
}

std::string undecided_in_words(const TargetMean& mean, const double tolerance)
{
  if (!mean.half_width())
    return fmt::format("{} (given by {} of the two packings that an interval needs at least)", mean.title, mean.n);
  const auto needed = packings_to_decide(mean, tolerance);
  return fmt::format("{} ({} packings needed)", deviation_in_words(mean),
                     needed ? fmt::format("about {}", *needed) : fmt::format("more than {}", most_packings_told));
}

/// Titles have commas of their own.
std::string listed(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, "; ")); }
} // namespace

std::string name(const TargetVerdict verdict) { return std::string(verdict_names[std::size_t(verdict)]); }

std::string words(const TargetVerdict verdict)
{
  return verdict == TargetVerdict::not_decided ? "not decided" : name(verdict);
}

std::optional<TargetVerdict> verdict_of_name(const std::string& name)
{
  const auto* const found = std::ranges::find(verdict_names, name);
  return found == std::end(verdict_names) ? std::nullopt : std::optional(TargetVerdict(found - verdict_names));
}

std::optional<double> TargetMean::half_width() const
{
  return standard_error && n > 1 ? std::optional(student_factor_95(n - 1) * *standard_error) : std::nullopt;
}

TargetVerdict verdict_on(const TargetMean& mean, const double tolerance)
{
  const auto half_width = mean.half_width();
  if (!half_width)
    return TargetVerdict::not_decided;
  if (std::abs(mean.deviation) + *half_width <= tolerance)
    return TargetVerdict::reached;
  return std::abs(mean.deviation) - *half_width > tolerance ? TargetVerdict::missed : TargetVerdict::not_decided;
}

TargetVerdict verdict_on(const std::vector<TargetVerdict>& verdicts)
{
  const auto has = [&](const TargetVerdict one) { return std::ranges::count(verdicts, one) > 0; };
  if (has(TargetVerdict::missed))
    return TargetVerdict::missed;
  return has(TargetVerdict::not_decided) || verdicts.empty() ? TargetVerdict::not_decided : TargetVerdict::reached;
}

std::optional<std::size_t> packings_for(const double half_width, const double scatter)
{
  constexpr double normal_95 = 1.959964; // Student's factor is larger: fewer packings than by it never do
  const double by_normal = std::pow(normal_95 * scatter / half_width, 2);
  if (!(by_normal < double(most_packings_told)))
    return std::nullopt;
  std::size_t n = std::max<std::size_t>(2, std::size_t(by_normal));
  while (n <= most_packings_told && student_factor_95(n - 1) * scatter / std::sqrt(double(n)) > half_width)
    ++n;
  return n <= most_packings_told ? std::optional(n) : std::nullopt;
}

std::optional<std::size_t> packings_to_decide(const TargetMean& mean, const double tolerance)
{
  const auto scatter = scatter_of(mean);
  return scatter ? packings_for(std::abs(tolerance - std::abs(mean.deviation)), *scatter) : std::nullopt;
}

std::string statement_on(const std::vector<TargetMean>& means, const double tolerance)
{
  std::vector<std::string> missed;
  std::vector<std::string> undecided;
  for (const TargetMean& mean : means)
    if (const TargetVerdict verdict = verdict_on(mean, tolerance); verdict == TargetVerdict::missed)
      missed.push_back(deviation_in_words(mean));
    else if (verdict == TargetVerdict::not_decided)
      undecided.push_back(undecided_in_words(mean, tolerance));
  const double percent = 100.0 * tolerance;
  if (missed.empty() && undecided.empty())
    return fmt::format("All targets were reached within {:g} %.", percent);
  if (missed.empty())
    return fmt::format(
      "it is not decided whether all targets were reached within {:g} %: {}; raise {}, test larger specimens or widen {}",
      percent, listed(undecided), input_entries::most_packings.text(), input_entries::tolerance.text());
  const std::string and_undecided = undecided.empty() ? "" : fmt::format("; not decided: {}", listed(undecided));
  return fmt::format("not all targets were reached; off by more than the tolerance of {:g} %: {}{}", percent,
                     listed(missed), and_undecided);
}
} // namespace feldspar
