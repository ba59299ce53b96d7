#include "app/input/maps/traces.h"

#include "base/contains.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/table/csv.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <optional>

namespace feldspar
{
namespace
{
Traces read_table(const std::filesystem::path& file)
{
  Traces traces;
  CsvReader table(file);
  const bool has_layers = table.has("layer");
  std::vector<std::size_t> places;
  for (const std::string_view name : split_at_commas(header_of_traces))
    if (const auto place = table.find_in_si(name))
      places.push_back(*place);
    else
      throw InputError("{}:{}: there is no column {}", file.string(), table.line_of_header(), name);
  for (std::size_t c = 0; c < table.header().size(); ++c)
    if (const std::string_view column = table.name_of(c); !column.empty() && column != "layer" && !contains(places, c))
      throw InputError("{}:{}: {} is no column of a joint map; they are {} and layer", file.string(),
                       table.line_of_header(), in_quotes(column), header_of_traces);
  while (table.next())
    {
      std::array<double, 4> row;
      std::ranges::transform(places, row.begin(), [&](const std::size_t c) { return table.number(c); });
      const std::string layer = has_layers ? in_small_letters(table.text(table.place("layer"))) : "";
      traces.shapes.emplace_back(ClosedFlaw{{{row[0], row[1]}, {row[2], row[3]}}, std::nullopt, layer});
      check_number_of_traces(traces.shapes.size(), file);
      if (row[0] == row[2] && row[1] == row[3])
        throw InputError("{}:{}: the trace ends where it begins", file.string(), table.line_of_row());
    }
  if (traces.shapes.empty())
    throw InputError("{}: there is no trace below the header", file.string());
  return traces;
}
} // namespace

void check_number_of_traces(const std::size_t n, const std::filesystem::path& file)
{
  constexpr std::size_t most_traces = 10000;
  if (n > most_traces)
    throw InputError("{}: must be at most {} traces", file.string(), most_traces);
}

Traces read_traces(const std::filesystem::path& file)
{
  return in_small_letters(file.extension().string()) == ".dxf" ? read_drawing(file) : read_table(file);
}
} // namespace feldspar
