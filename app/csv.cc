#include "app/csv.h"

#include "app/quantity.h"
#include "dem/input_error.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace feldspar
{
std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, const std::string_view header)
{
  std::ifstream stream(file);
  if (!stream)
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::generic_category().message(errno)));
  const std::vector<std::string_view> columns = split_at_commas(header);

  std::string line;
  std::getline(stream, line);
  if (split_at_commas(line) != columns)
    throw InputError(
      fmt::format("{}:1: the header is \"{}\"; it must be \"{}\"", file.string(), trim(line).substr(0, 200), header));
  std::vector<std::vector<double>> rows;
  for (std::size_t number = 2; std::getline(stream, line); ++number)
    {
      if (trim(line).empty())
        continue;
      const std::vector<std::string_view> cells = split_at_commas(line);
      if (cells.size() != columns.size())
        throw InputError(fmt::format("{}:{}: there must be {} numbers, one for each of {}; found {}", file.string(),
                                     number, columns.size(), header, cells.size()));
      std::vector<double> row;
      for (std::size_t i = 0; i < cells.size(); ++i)
        try
          {
            row.push_back(parse_number(cells[i]));
          }
        catch (const InputError& error)
          {
            throw InputError(fmt::format("{}:{}: {}: {}", file.string(), number, columns[i], error.what()));
          }
      rows.push_back(row);
    }
  if (rows.empty())
    throw InputError(fmt::format("{}: there is no row below the header", file.string()));
  return rows;
}
} // namespace feldspar
