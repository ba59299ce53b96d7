#include "results/runs/repeats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

namespace feldspar
{
namespace
{
/// The results of a test, with what it is beside the entries that vary.
std::string results_of(const FinishedTest& test)
{
  std::string text = fmt::format("{} {} {}", test.record.kind.name, test.record.seed,
                                 test.record.intermediate_stress.value_or(test.record.confining_pressure));
  for (const TestQuantity& quantity : test_quantities)
    if (const Figure figure = value_of(quantity, test); quantity.of != QuantityOf::effort && figure.value)
      text += fmt::format(" {}={:.10g}", quantity.name, *figure.value);
  return text + "\n";
}

using Settings = std::map<std::string, std::string>; ///< values by entry

struct StudiedVariant
{
  Settings settings;
  std::set<std::string> results = {}; ///< of each of its tests
  bool is_whole = true;               ///< all of its tests were made
};

/// Variants that have the same results.
using Alike = std::vector<const StudiedVariant*>;

std::map<std::string, StudiedVariant> variants_of(const std::vector<const FinishedTest*>& tests)
{
  std::map<std::string, StudiedVariant> variants;
  for (const FinishedTest* const test : tests)
    if (!test->settings.empty())
      {
        StudiedVariant& variant = variants[test->variant];
        for (const VariantSetting& setting : test->settings)
          variant.settings[setting.entry] = setting.value;
        variant.results.insert(results_of(*test));
        variant.is_whole = variant.is_whole && test->was_made();
      }
  return variants;
}

/// Values that each entry takes in these variants.
std::map<std::string, std::set<std::string>> values_in(const Alike& variants)
{
  std::map<std::string, std::set<std::string>> values;
  for (const StudiedVariant* const variant : variants)
    for (const auto& [entry, value] : variant->settings)
      values[entry].insert(value);
  return values;
}

std::vector<std::string> entries_that_differ(const Alike& variants)
{
  std::vector<std::string> entries;
  for (const auto& [entry, values] : values_in(variants))
    if (values.size() > 1)
      entries.push_back(entry);
  return entries;
}
} // namespace

std::vector<std::string> remarks_on_repeats(const std::vector<const FinishedTest*>& tests)
{
  const auto variants = variants_of(tests);
  std::map<std::set<std::string>, Alike> by_results;
  Alike all;
  for (const auto& [label, variant] : variants)
    {
      all.push_back(&variant);
      if (variant.is_whole)
        by_results[variant.results].push_back(&variant);
    }
  std::map<std::vector<std::string>, std::vector<Alike>> by_entries;
  for (const auto& [results, alike] : by_results)
    if (const auto entries = entries_that_differ(alike); !entries.empty())
      by_entries[entries].push_back(alike);

  const auto values_of_all = values_in(all);
  std::vector<std::string> sentences;
  for (const auto& [entries, groups] : by_entries)
    {
      Alike together;
      for (const Alike& alike : groups)
        together.insert(together.end(), alike.begin(), alike.end());
      std::vector<std::string> common; // settings that set these variants apart from the others
      for (const auto& [entry, values] : values_in(together))
        if (values.size() == 1 && values_of_all.at(entry).size() > 1)
          common.push_back(fmt::format("{} = {}", entry, *values.begin()));
      const std::size_t n_repeating = together.size() - groups.size();
      sentences.push_back(fmt::format(
        "{} of {} variants repeat{} the results of {} other{} to ten digits. They differ in {} alone{}: {} no effect {}",
        n_repeating, variants.size(), n_repeating == 1 ? "s" : "", groups.size(), groups.size() == 1 ? "" : "s",
        fmt::join(entries, " and "), common.empty() ? "" : fmt::format(", and all have {}", fmt::join(common, " and ")),
        entries.size() == 1 ? "this entry has" : "these entries have",
        together.size() == variants.size() ? "in this study" : "there"));
    }
  return sentences;
}
} // namespace feldspar
