#include "base/csv.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace feldspar
{
namespace
{
constexpr std::size_t longest_quote = 200;
} // namespace

CsvReader::CsvReader(const std::filesystem::path& file)
  : name(file.string())
  , stream(file)
{
  std::getline(stream, line);
  if (constexpr std::string_view byte_order_mark = "\xef\xbb\xbf"; line.starts_with(byte_order_mark))
    line.erase(0, byte_order_mark.size());
  if (line.find(';') != std::string::npos && line.find(',') == std::string::npos)
    throw InputError(fmt::format("{}:1: columns are separated by commas, not semicolons", name));
  names = trim(line);
  columns = split_at_commas(names);
}

bool CsvReader::has(const std::string_view column) const
{
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

std::size_t CsvReader::place(const std::string_view column) const
{
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end())
    throw InputError(fmt::format("{}:1: there is no column {}", name, column));
  return std::size_t(found - columns.begin());
}

bool CsvReader::next()
{
  do
    {
      if (!std::getline(stream, line))
        return false;
      ++line_number;
    }
  while (trim(line).empty());
  cells = split_at_commas(line);
  if (cells.size() != columns.size())
    throw InputError(fmt::format("{}:{}: there must be {} values, one for each of {}; found {}", name, line_number,
                                 columns.size(), excerpt(names, longest_quote), cells.size()));
  return true;
}

double CsvReader::number(const std::size_t column) const
{
  try
    {
      return parse_number(cells[column]);
    }
  catch (const InputError& error)
    {
      throw InputError(fmt::format("{}:{}: {}: {}", name, line_number, excerpt(columns[column]), error.what()));
    }
}

double CsvReader::number_or_nan(const std::size_t column) const
{
  double value = 0.0;
  const std::string_view cell = cells[column];
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() ? value : number(column); // which tells the reason
}

double CsvReader::count(const std::size_t column, const double most) const
{
  const double value = number_or_nan(column);
  if (!(value >= 0.0 && value <= most && value == std::floor(value)))
    throw InputError(
      fmt::format("{}:{}: {} is no count or number of something", name, line_number, in_quotes(cells[column])));
  return value;
}

std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, const std::string_view header)
{
  CsvReader table(file);
  const std::size_t n_columns = split_at_commas(header).size();
  if (split_at_commas(table.header()) != split_at_commas(header))
    throw InputError(
      fmt::format("{}:1: the header is {}; it must be \"{}\"", file.string(), in_quotes(table.header()), header));
  std::vector<std::vector<double>> rows;
  while (table.next())
    {
      std::vector<double> row;
      row.reserve(n_columns);
      for (std::size_t k = 0; k < n_columns; ++k)
        row.push_back(table.number(k));
      rows.push_back(std::move(row));
    }
  if (rows.empty())
    throw InputError(fmt::format("{}: there is no row below the header", file.string()));
  return rows;
}
} // namespace feldspar
