#include "app/input/csv.h"

#include "app/input/quantity.h"
#include "base/input_error.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace feldspar
{
namespace
{
std::ifstream open(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  if (!stream)
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::generic_category().message(errno)));
  return stream;
}

std::string first_line(std::istream& stream, const std::filesystem::path& file)
{
  std::string line;
  std::getline(stream, line);
  if (constexpr std::string_view byte_order_mark = "\xef\xbb\xbf"; line.starts_with(byte_order_mark))
    line.erase(0, byte_order_mark.size());
  if (line.find(';') != std::string::npos && line.find(',') == std::string::npos)
    throw InputError(fmt::format("{}:1: columns are separated by commas, not semicolons", file.string()));
  return std::string(trim(line));
}
} // namespace

std::string read_csv_header(const std::filesystem::path& file)
{
  auto stream = open(file);
  return first_line(stream, file);
}

std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, const std::string_view header)
{
  auto stream = open(file);
  const std::vector<std::string_view> columns = split_at_commas(header);

  std::string line = first_line(stream, file);
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
