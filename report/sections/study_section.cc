#include "report/sections/sections.h"

#include "base/append.h"
#include "report/pictures/plot_style.h"
#include "report/pictures/study_lines.h"
#include "report/sections/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

namespace feldspar
{
namespace
{
/// An entry with its effects.
struct StudiedEntry
{
  Abscissa over;
  std::vector<StudyEffect> effects;

  /// Name without the section, which the table's heading has.
  std::string name() const { return over.entry.substr(over.entry.find('/') + 1); }
  std::string value(const double number) const
  {
    return fmt::format("{:g}{}{}", number, over.unit.empty() ? "" : " ", over.unit);
  }
  std::string range() const { return fmt::format("{:g} to {}", *over.values.begin(), value(*over.values.rbegin())); }
  const StudyEffect* effect_on(const StudyEffect& same) const
  {
    const auto found = std::ranges::find_if(effects, [&](const StudyEffect& one) { return one.is_on_same(same); });
    return found == effects.end() ? nullptr : &*found;
  }
};

constexpr double least_change = 5e-4; // a smaller one rounds to 0.0 %

std::vector<StudiedEntry> studied_entries(const std::vector<Series>& all)
{
  std::vector<StudiedEntry> entries;
  for (const Abscissa& over : abscissas(all))
    entries.push_back({over, effects_of(all, over)});
  // The largest effect on the first result first.
  std::ranges::stable_sort(entries, std::greater(), [](const StudiedEntry& entry) {
    return entry.effects.empty() ? -1.0 : entry.effects.front().reach();
  });
  return entries;
}

/// 60.1 to 141 (+134.6 %); a mean between the ends of the entry that lies beyond both of theirs behind it.
std::string as_cell(const StudiedEntry& entry, const StudyEffect& effect)
{
  using text::significant;
  const auto& [result, test, means] = effect;
  if (effect.reach() < least_change)
    return "no effect";
  const double first = means.begin()->second;
  const double last = means.rbegin()->second;
  std::string cell = fmt::format("{} to {}", significant(first, 3), significant(last, 3));
  if (first != 0.0)
    cell += fmt::format(" ({})", text::signed_percent(effect.change()));
  const auto [least, most] = effect.extremes();
  for (const auto& extreme : {least, most})
    if (const double beyond =
          extreme == least ? std::min(first, last) - least->second : most->second - std::max(first, last);
        beyond > 0.01 * std::max(std::abs(most->second), std::abs(least->second)))
      cell += fmt::format("; {} at {}", significant(extreme->second, 3), entry.value(extreme->first));
  return cell;
}

Table effect_table(const std::vector<StudiedEntry>& entries)
{
  Table table{
    "effects",
    "Effect of each entry from its lowest to its highest value: means over the seeds and over the values of the "
    "other entries",
    {"result"}};
  std::vector<const StudyEffect*> rows;
  for (const StudiedEntry& entry : entries)
    {
      if (!entry.effects.empty())
        table.header.push_back(fmt::format("{}, {}", entry.over.entry, entry.range()));
      for (const StudyEffect& effect : entry.effects)
        if (std::ranges::none_of(rows, [&](const StudyEffect* one) { return one->is_on_same(effect); }))
          rows.push_back(&effect);
    }
  for (const StudyEffect* const row : rows)
    {
      table.rows.push_back({fmt::format("{}: {}", row->test, with_unit(row->result.title, row->result.unit))});
      for (const StudiedEntry& entry : entries)
        if (!entry.effects.empty())
          {
            const StudyEffect* const effect = entry.effect_on(*row);
            table.rows.back().push_back(effect ? as_cell(entry, *effect) : text::none);
          }
    }
  return table;
}

/// The effects on the first result of the first test in words.
std::string headline_of(const std::vector<StudiedEntry>& entries)
{
  if (entries.empty() || entries.front().effects.empty())
    return "";
  const StudyEffect& first = entries.front().effects.front();
  std::string words;
  for (const StudiedEntry& entry : entries)
    if (const StudyEffect* const effect = entry.effect_on(first))
      {
        const std::string along = entry.over.along.empty() ? "" : " and what goes along with it";
        words += words.empty() ? "" : "; ";
        words += effect->reach() < least_change ? fmt::format("{}{} has no effect", entry.name(), along)
                                                : fmt::format("with {}{} from {} it goes from {}", entry.name(), along,
                                                              entry.range(), as_cell(entry, *effect));
      }
  return fmt::format("{}, {}: {}.", first.test, with_unit(first.result.title, first.result.unit), words);
}

/// Moves the first picture whose name begins so from one list to the other.
void move_first(std::vector<Picture>& from, const std::string& beginning, std::vector<Picture>& to)
{
  const auto found =
    std::ranges::find_if(from, [&](const Picture& picture) { return picture.name.starts_with(beginning); });
  if (found == from.end())
    return;
  to.push_back(std::move(*found));
  from.erase(found);
}
} // namespace

PageSection study_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"study", "Study", "Results over what was varied"};
  PageBlock block;
  for (const std::string& sentence : findings.repeats)
    block.warnings.push_back(sentence + ".");
  std::vector<Picture> pictures = study_pictures(findings.all);
  const std::vector<StudiedEntry> entries = studied_entries(findings.all);
  block.headline = headline_of(entries);
  if (Table table = effect_table(entries); !table.rows.empty())
    block.tables.push_back(std::move(table));
  else if (!pictures.empty())
    block.paragraphs.push_back("No two variants differ in one entry alone, so that the effect of a single entry is not "
                               "known; points show the results over each.");
  // A map over two entries beside the largest effect; over one entry the first two results.
  std::vector<Picture> lead;
  move_first(pictures, "study_map_", lead);
  for (const StudiedEntry& entry : entries)
    if (lead.size() < 2)
      move_first(pictures, fmt::format("study_{}_", plot::file_name(entry.over.entry)), lead);
  if (lead.size() < 2)
    move_first(pictures, "study_", lead);
  block.lead = book.keep(std::move(lead));
  if (!block.warnings.empty() || !block.lead.empty())
    section.blocks.push_back(std::move(block));
  if (!pictures.empty())
    section.blocks.push_back(
      {.folded = "Every result over what was varied", .pictures = book.keep(std::move(pictures))});
  return section;
}
} // namespace feldspar
