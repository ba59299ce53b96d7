#include "app/input/maps/traces.h"

#include "base/input_error.h"
#include "base/table/csv.h"
#include "base/text.h"

#include <fmt/format.h>

namespace feldspar
{
namespace
{
Traces read_table(const std::filesystem::path& file)
{
  Traces traces;
  for (const auto& row : read_csv(file, header_of_traces))
    {
      traces.shapes.emplace_back(ClosedFlaw{{{row[0], row[1]}, {row[2], row[3]}}});
      check_number_of_traces(traces.shapes.size(), file);
      if (row[0] == row[2] && row[1] == row[3])
        throw InputError(fmt::format("{}:{}: the trace ends where it begins", file.string(), traces.shapes.size() + 1));
    }
  return traces;
}
} // namespace

void check_number_of_traces(const std::size_t n, const std::filesystem::path& file)
{
  constexpr std::size_t most_traces = 10000;
  if (n > most_traces)
    throw InputError(fmt::format("{}: must be at most {} traces", file.string(), most_traces));
}

Traces read_traces(const std::filesystem::path& file)
{
  return in_small_letters(file.extension().string()) == ".dxf" ? read_drawing(file) : read_table(file);
}
} // namespace feldspar
