#include "app/input/input.h"
#include "app/input/input_entries.h"
#include "app/input/joint_sections.h"
#include "app/input/parameter_table.h"
#include "app/input/variant_names.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/table/csv.h"
#include "base/text.h"
#include "results/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::size_t most_variants = 10000;

/// Gives an entry its value; returns how an input file would say it. There are two ways to say which pairs of grains
/// get a joint; the varied one holds.
VariantSetting set(Input& input, const std::string& entry, const std::string& value)
{
  const Parameter& parameter = *find_parameter(entry);
  rephrased([&] { parameter.read(input, value); },
            [&](const std::string& what) { return InputError("{} = {}: {}", entry, excerpt(value), what); });
  JointLaws::for_each(input.joints, [&](const std::string_view law, auto& joint) {
    if (parameter.section != section_of(law))
      return;
    if (parameter.entry == "Coordination number")
      joint.installation_gap_ratio.reset();
    if (parameter.entry == "Installation gap ratio")
      joint.coordination_number.reset();
  });
  return {entry, value};
}

std::size_t n_variants(const VariantParameters& wanted)
{
  if (wanted.in_step)
    return wanted.values.front().size();
  std::size_t n = 1;
  for (const auto& values : wanted.values)
    n = std::min(most_variants + 1, n * values.size());
  return n;
}

/// Throws InputError, which says what does not fit.
void check_fit(const VariantParameters& wanted)
{
  if (wanted.entries.size() != wanted.values.size())
    throw InputError(wanted.values.empty() || wanted.entries.empty()
                       ? "Entry and Values go together: name both, or neither"
                       : fmt::format("there are {} entries and {} lists of values; lists are separated by ||",
                                     wanted.entries.size(), wanted.values.size()));
  if (wanted.entries.empty())
    return;
  for (std::size_t k = 0; k < wanted.entries.size(); ++k)
    {
      if (contains(std::span(wanted.entries).first(k), wanted.entries[k]))
        throw InputError("{} is named twice", wanted.entries[k]);
      if (wanted.in_step && wanted.values[k].size() != wanted.values.front().size())
        throw InputError("{} has {} values and {} has {}; in step they need as many", wanted.entries.front(),
                         wanted.values.front().size(), wanted.entries[k], wanted.values[k].size());
    }
  if (n_variants(wanted) > most_variants)
    throw InputError("must be at most {} variants", most_variants);
}

/// Returns whether tests.csv has such a column beside the entries that vary.
bool is_of_tests_table(const std::string_view column)
{
  return column == "name" || column == "kind" || column == "seed" ||
         contains(test_quantities, column, &TestQuantity::name);
}

void name_for_files(std::vector<Variant>& all, const bool by_number)
{
  if (all.size() < 2)
    return;
  const auto settings = mapped<std::vector<VariantSetting>>(all, &Variant::settings);
  const auto names = names_in_files(settings);
  for (std::size_t v = 0; v < all.size(); ++v)
    all[v].name_in_files = by_number ? fmt::format("variant_{}", v + 1) : names[v];
}
} // namespace

void read_variant_table(VariantParameters& wanted, const std::string_view column_of_labels)
{
  if (!wanted.entries.empty() || !wanted.values.empty())
    throw InputError("excludes Entry and Values, which are given too; keep one of them");
  CsvReader table(wanted.table);
  std::vector<std::pair<std::size_t, std::string_view>> columns; // place and unit
  bool has_results = false;
  std::optional<std::size_t> labels;
  for (std::size_t k = 0; k < table.header().size(); ++k)
    {
      const auto [name, unit] = title_of(table.name_of(k));
      if (name.empty()) // row numbers of a data frame
        continue;
      if (!column_of_labels.empty() && name == column_of_labels)
        {
          labels = k;
          continue;
        }
      if (column_of_labels.empty() && is_of_tests_table(table.name_of(k)))
        {
          has_results = true;
          continue;
        }
      wanted.entries.push_back(rephrased([&, &name = name] { return varied_entry(name); },
                                         [&, &name = name](const std::string& what) {
                                           return InputError("{}:{}: {} {}", wanted.table, table.line_of_header(),
                                                             in_quotes(name), what);
                                         }));
      columns.emplace_back(k, unit == "-" ? "" : unit);
    }
  if (!column_of_labels.empty() && !labels)
    throw InputError("{}:{}: there is no column {}", wanted.table, table.line_of_header(), column_of_labels);
  if (columns.empty())
    throw InputError("{}:{}: there is no column of an entry", wanted.table, table.line_of_header());
  wanted.values.resize(wanted.entries.size());
  wanted.in_step = true;
  std::set<std::vector<std::string>> rows; // a table of tests has a row for each test of a variant
  while (table.next())
    {
      std::vector<std::string> row;
      for (const auto& [column, unit] : columns)
        {
          row.push_back(table.text_with_point(column));
          if (!unit.empty() && is_decimal_number(row.back()))
            (row.back() += ' ') += unit;
        }
      if (!rows.insert(row).second && has_results)
        continue;
      if (labels)
        wanted.labels.emplace_back(table.text(*labels));
      for (std::size_t k = 0; k < row.size(); ++k)
        wanted.values[k].push_back(std::move(row[k]));
    }
  if (wanted.values.front().empty())
    throw InputError("{}: there is no row below the header", wanted.table);
}

std::vector<Variant> variants(const Input& input)
{
  const VariantParameters& wanted = input.variants;
  check_fit(wanted);
  if (wanted.entries.empty())
    return {{"", input, {}}};
  std::vector<Variant> all;
  for (std::size_t number = 0; number < n_variants(wanted); ++number)
    {
      Variant variant{"", input, {}};
      std::size_t of_grid = number; // the last entry varies fastest
      std::vector<std::size_t> chosen(wanted.entries.size(), number);
      if (!wanted.in_step)
        for (std::size_t k = wanted.entries.size(); k-- > 0; of_grid /= wanted.values[k].size())
          chosen[k] = of_grid % wanted.values[k].size();
      for (std::size_t k = 0; k < wanted.entries.size(); ++k)
        {
          variant.settings.push_back(set(variant.input, wanted.entries[k], wanted.values[k][chosen[k]]));
          const auto& [entry, value] = variant.settings.back();
          variant.label += fmt::format("{}{} = {}", variant.label.empty() ? "" : ", ", entry, value);
        }
      all.push_back(std::move(variant));
    }
  name_for_files(all, wanted.named_by_number);
  return all;
}

std::vector<Variant> rocks_of_sample(const Input& input)
{
  if (input.rocks.entries.empty())
    return {{"", input}};
  constexpr std::array common{"Specimen/Dimension", "Specimen/Shape", "Specimen/Width", "Specimen/Height"};
  for (const std::string& entry : input.rocks.entries)
    if (!find_parameter(entry)->flags.of_specimen || contains(common, entry))
      throw InputError("{}: {} is one for all rocks of a sample", input.rocks.table, entry);
  Input of_rocks = input;
  of_rocks.variants = input.rocks;
  std::vector<Variant> rocks = variants(of_rocks);
  for (std::size_t k = 0; k < rocks.size(); ++k)
    {
      rocks[k].label = input.rocks.labels[k];
      rocks[k].name_in_files = fmt::format("rock_{}", k + 2);
      if (rocks[k].label.empty() || contains(std::span(input.rocks.labels).first(k), rocks[k].label))
        throw InputError("{}: each row needs a group of its own; row {} has {}", input.rocks.table, k + 1,
                         in_quotes(rocks[k].label));
    }
  rocks.insert(rocks.begin(), {"", input});
  return rocks;
}
} // namespace feldspar
