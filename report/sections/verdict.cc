#include "report/sections/verdict.h"

#include "base/mapped.h"
#include "report/sections/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace feldspar
{
namespace
{
/// Caveat on which side of the range our mean lies; empty where the side is sure.
std::string caveat(const ComparisonRow& row)
{
  if (!row.in_range())
    return "";
  const bool is_in = *row.in_range();
  const std::string interval = text::interval(*row.ours, 1.0, row.decimals);
  if (interval == text::none)
    return row.ours->n == 1   ? "one specimen is too few to be sure"
           : row.ours->n == 2 ? "two specimens are too few to be sure"
                              : "the scatter is too large to be sure";
  const double low = row.ours->mean - *row.ours->confidence_95;
  const double high = row.ours->mean + *row.ours->confidence_95;
  if (is_in ? row.surely_in_range() == false : high >= *row.experiment->low && low <= *row.experiment->high)
    return fmt::format("the 95 % interval of the mean, {}, reaches {} the range", interval, is_in ? "out of" : "into");
  return "";
}

/// Unit behind a number, with its space.
std::string behind_number(const std::string& unit)
{
  return unit.empty() ? "" : unit == "deg" ? "°" : unit == "1e-3" ? " · 10⁻³" : unit == "1e-4" ? " · 10⁻⁴" : " " + unit;
}

/// Tile of a result, beside the experiment where it has the property.
Tile tile_of(const ComparisonRow& row)
{
  const std::string unit = behind_number(row.unit);
  Tile tile{.property = row.property,
            .value = (text::has_two_values(*row.ours) ? text::two_values(*row.ours, 1.0, row.decimals)
                                                      : text::mean_and_deviation(*row.ours, 1.0, row.decimals)) +
                     unit,
            .n = row.ours->n,
            .mean = row.ours->mean,
            .deviation = row.ours->standard_deviation.value_or(0.0),
            .in_range = row.in_range()};
  if (!row.experiment)
    return tile;
  tile.notes = "experiment " + as_text(row, row.experiment, unit);
  if (const auto deviation = row.deviation())
    tile.notes += ", " + text::signed_percent(*deviation);
  if (const std::string doubt = caveat(row); !doubt.empty())
    tile.notes += "; " + doubt;
  if (row.in_range())
    {
      tile.low = row.experiment->low;
      tile.high = row.experiment->high;
    }
  return tile;
}

std::string subject(const std::vector<const ComparisonRow*>& rows, const char* const singular, const char* const plural)
{
  const auto properties = mapped<std::string>(rows, [&](const ComparisonRow* row) { return row->property; });
  return subject_of(properties, singular, plural);
}
} // namespace

std::string subject_of(const std::vector<std::string>& properties, const char* const singular, const char* const plural)
{
  constexpr std::size_t most_named = 4;
  std::vector<std::string> names;
  for (const std::string& property : properties)
    names.push_back(property.substr(0, property.find(','))); // Young's modulus, tangent 40-60 % of peak
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (names.size() > most_named)
    return fmt::format("{} properties {}", properties.size(), plural);
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  text.front() = char(std::toupper(static_cast<unsigned char>(text.front())));
  return text + " " + (names.size() == 1 ? singular : plural);
}

Verdict verdict(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference,
                const std::string& reason_for_no_reference)
{
  std::vector<const ComparisonRow*> in, out, open; // of properties without a range
  double largest_without_range = 0.0;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  Verdict result;
  for (const auto& row : rows)
    if (row.ours && row.experiment)
      {
        result.tiles.push_back(tile_of(row));
        fewest = std::min(fewest, row.ours->n);
        if (row.in_range())
          (*row.in_range() ? in : out).push_back(&row);
        if (!row.in_range())
          open.push_back(&row);
        const double deviation = row.in_range() ? 0.0 : row.deviation().value_or(0.0);
        if (std::abs(deviation) > std::abs(largest_without_range))
          largest_without_range = deviation;
      }
  if (result.tiles.empty())
    {
      result.headline =
        "Nothing to compare with: " +
        (reason_for_no_reference.empty() ? std::string("no property both has a figure here and is given for the rock")
                                         : reason_for_no_reference) +
        ".";
      for (const auto& row : rows)
        if (row.ours && !row.key.empty())
          result.tiles.push_back(tile_of(row));
      result.points = sentences_on_missing(rows, reference);
      return result;
    }
  const std::string specimens = fmt::format(" ({} specimen{})", fewest, fewest == 1 ? "" : "s");
  if (in.empty() && out.empty())
    result.headline = "The experiments give means without ranges; the deviations are below.";
  else if (out.empty())
    result.headline =
      "Yes. " + subject(in, "lies within the measured range", "lie within the measured ranges") + specimens + ".";
  else
    result.headline =
      "No. " + subject(out, "is outside the measured range", "are outside the measured ranges") + specimens +
      (in.empty() ? "" : fmt::format("; {} of {} properties lie within", in.size(), in.size() + out.size())) + ".";
  if (!open.empty() && !(in.empty() && out.empty()))
    result.headline += fmt::format(
      " {} {}.",
      subject(open, "is given without a range and deviates by", "are given without a range and deviate by up to"),
      text::signed_percent(largest_without_range));
  result.points = sentences_on_missing(rows, reference);
  return result;
}
} // namespace feldspar
