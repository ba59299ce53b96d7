#include "report/sections/study_text.h"

#include "base/append.h"
#include "base/mapped.h"
#include "report/sections/comparison.h"
#include "report/sections/text.h"
#include "results/runs/trust.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
/// A result of every variant, in the order of the variants; "-" where a variant has none.
struct StudyColumn
{
  std::string heading;
  std::vector<std::string> cells;
  std::string of_experiment; ///< or empty

  bool is_the_same_in_all() const
  {
    return std::ranges::all_of(cells, [&](const std::string& cell) { return cell == cells.front(); });
  }
};

std::vector<StudyColumn> columns(const std::vector<std::vector<ComparisonRow>>& of_variants)
{
  std::vector<StudyColumn> all;
  for (std::size_t v = 0; v < of_variants.size(); ++v)
    for (const ComparisonRow& row : of_variants[v])
      if (row.ours)
        {
          const std::string name = with_unit(row.property, row.unit);
          auto column = std::ranges::find(all, name, &StudyColumn::heading);
          if (column == all.end())
            column = all.insert(all.end(), {name, std::vector<std::string>(of_variants.size(), "-"),
                                            row.experiment ? as_text(row, row.experiment) : ""});
          column->cells[v] = text::number(row.ours->mean, row.decimals);
        }
  return all;
}

/// Name of a variant in a line: the values of its entries, which stand above the table.
std::string values_of(const FinishedTest& test)
{
  if (test.settings.empty())
    return test.variant;
  const auto values = mapped<std::string_view>(test.settings, &VariantSetting::value);
  return fmt::format("{}", fmt::join(values, ", "));
}

std::string entries_of(const FinishedTest& test)
{
  const auto entries = mapped<std::string_view>(test.settings, &VariantSetting::entry);
  return entries.empty() ? "variant" : fmt::format("{}", fmt::join(entries, ", "));
}
} // namespace

std::string study_as_text(const std::vector<FinishedTest>& tests, const std::optional<Reference>& reference)
{
  std::vector<std::vector<ComparisonRow>> of_variants;
  std::vector<std::string> names;
  for (const RockTests& rock : by_rock(tests))
    {
      const auto of_rock = mapped<FinishedTest>(rock.tests, [](const FinishedTest* const test) { return *test; });
      of_variants.push_back(compare(of_rock, reference, {}, any_has_flaws(tests)));
      names.push_back(values_of(of_rock.front()));
    }
  std::vector<StudyColumn> varied;
  std::vector<StudyColumn> constant;
  for (StudyColumn& column : columns(of_variants))
    (column.is_the_same_in_all() ? constant : varied).push_back(std::move(column));

  std::string text = fmt::format("{} variants, means over the seeds\n", names.size());
  for (std::size_t c = 0; c < varied.size(); ++c)
    text += fmt::format("  {:>2}  {}{}\n", c + 1, varied[c].heading,
                        varied[c].of_experiment.empty() ? "" : "; experiment " + varied[c].of_experiment);

  constexpr std::size_t most_in_a_line = 7; // leaves room for the values of a variant behind them
  for (std::size_t first = 0; first < varied.size(); first += most_in_a_line)
    {
      const std::size_t end = std::min(first + most_in_a_line, varied.size());
      std::vector<std::size_t> widths;
      text += '\n';
      for (std::size_t c = first; c < end; ++c)
        {
          std::size_t width = 2;
          for (const std::string& cell : varied[c].cells)
            width = std::max(width, cell.size());
          widths.push_back(width);
          text += fmt::format("  {:>{}}", c + 1, width);
        }
      text += fmt::format("   {}\n", entries_of(tests.front()));
      for (std::size_t v = 0; v < names.size(); ++v)
        {
          for (std::size_t c = first; c < end; ++c)
            text += fmt::format("  {:>{}}", varied[c].cells[v], widths[c - first]);
          text += fmt::format("   {}\n", names[v]);
        }
    }
  if (!constant.empty())
    text += "\nthe same in all variants\n";
  for (const StudyColumn& column : constant)
    text += fmt::format("  {}   {}\n", column.heading, column.cells.front());
  std::vector<ComparisonRow> rows;
  for (const auto& of_variant : of_variants)
    append(rows, of_variant);
  if (const std::string missing = text_of_missing(rows, reference); !missing.empty())
    text += "\n" + missing;
  return text + "\nAll results of each test stand in tests.csv, the fits of each variant in summary.json.\n";
}
} // namespace feldspar
