#include "report/sections/verdict.h"

#include "base/mapped.h"
#include "report/pictures/plot_style.h"
#include "report/sections/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
std::string specimens_in_words(const std::size_t n) { return n == 1 ? "one specimen" : fmt::format("{} specimens", n); }

/// Caveat on which side of the range our mean lies; empty where the side is sure.
std::string caveat(const ComparisonRow& row)
{
  const auto found = row.against_range();
  if (!found || found == RangeVerdict::outside)
    return "";
  const std::string interval = text::interval(*row.ours, 1.0, row.decimals);
  if (found == RangeVerdict::not_decided)
    return fmt::format("not decided by {}", specimens_in_words(row.ours->n)) +
           (row.ours->n == 1 ? ", which has no 95 % interval"
                             : fmt::format(": the 95 % interval of the mean{} reaches into the range",
                                           interval == text::none ? "" : ", " + interval + ","));
  if (interval == text::none)
    return row.ours->n == 1   ? "one specimen is too few to be sure"
           : row.ours->n == 2 ? "two specimens are too few to be sure"
                              : "the scatter is too large to be sure";
  return row.surely_in_range() == false
           ? fmt::format("the 95 % interval of the mean, {}, reaches out of the range", interval)
           : "";
}

TileMark mark_of(const std::optional<RangeVerdict>& found)
{
  return !found                           ? TileMark::none
         : found == RangeVerdict::within  ? TileMark::good
         : found == RangeVerdict::outside ? TileMark::bad
                                          : TileMark::not_decided;
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
            .mark = mark_of(row.against_range())};
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

/// Young's modulus of "Young's modulus, tangent 40-60 % of peak".
std::string short_name(const std::string& property) { return property.substr(0, property.find(',')); }

/// Names of a few properties, of many their number, with a verb, within a sentence.
std::string clause_of(const std::vector<std::string>& properties, const char* const singular, const char* const plural)
{
  constexpr std::size_t most_named = 4;
  auto names = mapped<std::string>(properties, short_name);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (names.size() > most_named)
    return fmt::format("{} properties {}", properties.size(), plural);
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  return text + " " + (names.size() == 1 ? singular : plural);
}

using Rows = std::vector<const ComparisonRow*>;

std::vector<std::string> names_of(const Rows& rows)
{
  return mapped<std::string>(rows, [](const ComparisonRow* row) { return row->property; });
}

std::string subject(const Rows& rows, const char* const singular, const char* const plural)
{
  return subject_of(names_of(rows), singular, plural);
}

std::size_t fewest_specimens(const Rows& rows)
{
  return (*std::ranges::min_element(rows, {}, [](const ComparisonRow* row) { return row->ours->n; }))->ours->n;
}

/// Sentence on properties with a range of which none is surely outside.
std::string undecided_sentence(const Rows& rows)
{
  const std::size_t n = fewest_specimens(rows);
  return fmt::format("Not decided by {}. {}, but {}", specimens_in_words(n),
                     subject(rows, "is outside the measured range", "are outside the measured ranges"),
                     n == 1             ? "one specimen has no 95 % interval"
                     : rows.size() == 1 ? "its 95 % interval reaches into it"
                                        : "their 95 % intervals reach into them");
}

/// Sentence on properties without a range; it names the one that deviates most.
std::string deviation_sentence(const Rows& rows)
{
  const auto deviation = [](const ComparisonRow* row) { return row->deviation().value_or(0.0); };
  const ComparisonRow* const farthest =
    *std::ranges::max_element(rows, {}, [&](const ComparisonRow* row) { return std::abs(deviation(row)); });
  return fmt::format(
    "{} {}{}.",
    subject(rows, "is given without a range and deviates by", "are given without a range and deviate by up to"),
    text::signed_percent(deviation(farthest)),
    rows.size() == 1 ? "" : fmt::format(" ({})", short_name(farthest->property)));
}
} // namespace

std::string subject_of(const std::vector<std::string>& properties, const char* const singular, const char* const plural)
{
  return plot::with_capital(clause_of(properties, singular, plural));
}

std::string verdict_sentence(const std::vector<ComparisonRow>& rows)
{
  Rows within, outside, open, without_range;
  for (const auto& row : rows)
    if (row.ours && row.experiment)
      {
        const auto found = row.against_range();
        (!found                           ? without_range
         : found == RangeVerdict::within  ? within
         : found == RangeVerdict::outside ? outside
                                          : open)
          .push_back(&row);
      }
  const std::size_t n = within.size() + outside.size() + open.size();
  if (n == 0)
    return without_range.empty() ? "" : deviation_sentence(without_range);
  const auto by = [](const Rows& found) {
    return fmt::format(" ({} specimen{})", fewest_specimens(found), fewest_specimens(found) == 1 ? "" : "s");
  };
  std::string sentence;
  if (!outside.empty())
    sentence = "No. " + subject(outside, "is outside the measured range", "are outside the measured ranges") +
               by(outside) +
               (open.empty() ? "" : "; " + clause_of(names_of(open), "is not decided", "are not decided"));
  else if (!open.empty())
    sentence = undecided_sentence(open);
  else
    sentence =
      "Yes. " + subject(within, "lies within the measured range", "lie within the measured ranges") + by(within);
  if (!within.empty() && within.size() < n)
    sentence += fmt::format("; {} of {} properties {} within", within.size(), n, within.size() == 1 ? "lies" : "lie");
  return sentence + "." + (without_range.empty() ? "" : " " + deviation_sentence(without_range));
}

Verdict verdict(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference,
                const std::string& reason_for_no_reference)
{
  Verdict result{verdict_sentence(rows), {}, sentences_on_missing(rows, reference)};
  const bool is_compared = !result.headline.empty();
  if (!is_compared)
    result.headline =
      "Nothing to compare with: " +
      (reason_for_no_reference.empty() ? std::string("no property both has a figure here and is given for the rock")
                                       : reason_for_no_reference) +
      ".";
  for (const auto& row : rows)
    if (row.ours && (is_compared ? row.experiment.has_value() : !row.key.empty()))
      result.tiles.push_back(tile_of(row));
  return result;
}
} // namespace feldspar
