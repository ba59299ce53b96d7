#include "report/sections/verdict.h"

#include "base/append.h"
#include "report/sections/text.h"

#include <fmt/format.h>

#include <cmath>

namespace feldspar
{
namespace
{
/// Caveat on which side of the range our mean lies, from the second clause on; empty where the side is sure.
std::string caveat(const ComparisonRow& row)
{
  if (!row.in_range())
    return "";
  const bool is_in = *row.in_range();
  const std::string interval = text::interval(*row.ours, 1.0, row.decimals);
  if (interval == text::none)
    return row.ours->n == 1   ? "; one specimen is too few to be sure"
           : row.ours->n == 2 ? "; two specimens are too few to be sure"
                              : "; the scatter is too large to be sure";
  const double low = row.ours->mean - *row.ours->confidence_95;
  const double high = row.ours->mean + *row.ours->confidence_95;
  if (is_in ? row.surely_in_range() == false : high >= *row.experiment->low && low <= *row.experiment->high)
    return fmt::format("; the 95 % interval of the mean, {}, reaches {} the range", interval,
                       is_in ? "out of" : "into");
  return "";
}

/// tensile strength 9.90 ± 0.40 MPa, n = 3; experiment 9.53 (6.95 to 12.33) MPa; +3.9 %
std::string beside_experiment(const ComparisonRow& row)
{
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  std::string sentence =
    fmt::format("{} {}{}, n = {}; experiment {}", row.property, text::mean_and_deviation(*row.ours, 1.0, row.decimals),
                unit, row.ours->n, as_text(row, row.experiment, unit));
  if (const auto deviation = row.deviation())
    sentence += "; " + text::signed_percent(*deviation);
  return sentence + caveat(row);
}
} // namespace

Verdict verdict(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference,
                const std::string& reason_for_no_reference)
{
  std::vector<std::string> in;
  std::vector<std::string> out;
  std::vector<std::string> open;
  double largest_without_range = 0.0;
  for (const auto& row : rows)
    if (row.ours && row.experiment)
      {
        (!row.in_range() ? open : *row.in_range() ? in : out).push_back(beside_experiment(row));
        const double deviation = row.in_range() ? 0.0 : row.deviation().value_or(0.0);
        if (std::abs(deviation) > std::abs(largest_without_range))
          largest_without_range = deviation;
      }

  Verdict result;
  if (in.empty() && out.empty() && open.empty())
    {
      result.headline =
        "Nothing to compare with: " +
        (reason_for_no_reference.empty() ? std::string("no property both has a figure here and is given for the rock")
                                         : reason_for_no_reference) +
        ".";
      result.points = sentences_on_missing(rows, reference);
      return result;
    }
  const std::size_t n = in.size() + out.size();
  result.headline =
    n == 0 ? "The experiments give means without ranges; the deviations are below."
    : out.empty()
      ? fmt::format("Yes, by the {} {} for which experiments give a range.", n, n == 1 ? "property" : "properties")
      : fmt::format("Not in every respect: {} of {} properties for which experiments give a range lie "
                    "outside it.",
                    out.size(), n);
  if (n > 0 && !open.empty())
    {
      result.headline.pop_back();
      result.headline +=
        fmt::format("; {} without a range {} by up to {}.", open.size(), open.size() == 1 ? "deviates" : "deviate",
                    text::signed_percent(largest_without_range));
    }
  const auto add = [&](const char* what, const std::vector<std::string>& entries) {
    for (const auto& entry : entries)
      result.points.push_back(fmt::format("{}: {}.", what, entry));
  };
  add("✗ Out of range", out);
  add("✓ In range", in);
  add("No range given", open);
  append(result.points, sentences_on_missing(rows, reference));
  return result;
}
} // namespace feldspar
