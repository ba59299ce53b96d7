#include "base/table/csv.h"

#include "base/contains.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/table/quantity.h"
#include "base/text.h"

#include <fmt/format.h>

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::size_t longest_quote = 200;

/// The text of a file of UTF-16, as UTF-8.
std::string from_utf16(std::string content, const std::string& name)
{
  const auto close = [](iconv_t conversion) { iconv_close(conversion); };
  const std::unique_ptr<void, decltype(close)> conversion(iconv_open("UTF-8", "UTF-16"), close);
  std::string result(2 * content.size(), '\0'); // a unit of two bytes becomes three bytes at most
  char* in = content.data();
  char* out = result.data();
  std::size_t n_in = content.size();
  std::size_t n_out = result.size();
  if (iconv(conversion.get(), &in, &n_in, &out, &n_out) == std::size_t(-1))
    throw InputError("{}: begins as UTF-16 and is not; save it as UTF-8", name);
  result.resize(result.size() - n_out);
  return result;
}

/// Tabs and semicolons stand in no name of a column; commas may, as in "Spannung, MPa;Dehnung".
char separator_of(const std::string_view header)
{
  bool is_quoted = false;
  char found = ',';
  for (const char c : header)
    if (c == '"')
      is_quoted = !is_quoted;
    else if (!is_quoted && (c == '\t' || (c == ';' && found == ',')))
      found = c;
  return found;
}

/// The cells of a line, trimmed; quotes around them are taken off, and two quotes within them become one in the line.
std::vector<std::string_view> split(std::string& line, const char separator)
{
  std::vector<std::string_view> found;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= line.size(); ++k)
    if (k < line.size() && line[k] == '"')
      is_quoted = !is_quoted;
    else if (k == line.size() || (!is_quoted && line[k] == separator))
      {
        std::string_view cell = trim(std::string_view(line).substr(begin, k - begin));
        if (cell.size() >= 2 && cell.starts_with('"') && cell.ends_with('"'))
          {
            const std::size_t first = std::size_t(cell.data() - line.data()) + 1;
            std::size_t end = first;
            for (std::size_t i = first; i < first + cell.size() - 2; ++i)
              {
                line[end++] = line[i];
                if (line[i] == '"')
                  ++i;
              }
            cell = trim(std::string_view(line).substr(first, end - first));
          }
        found.push_back(cell);
        begin = k + 1;
      }
  return found;
}

/// Returns whether the comma of a number may stand between thousands: 1,234, but neither 0,234 nor 12,34 nor 1234,567.
bool is_perhaps_of_thousands(const std::string_view cell)
{
  const std::string_view digits = cell.substr(cell.starts_with('-') || cell.starts_with('+'));
  const std::size_t comma = digits.find(',');
  return comma >= 1 && comma <= 3 && digits.size() == comma + 4 && !digits.starts_with('0') &&
         std::ranges::count_if(digits, [](const char c) { return '0' <= c && c <= '9'; }) == std::ptrdiff_t(comma + 3);
}

std::string with_points(const std::string_view cell)
{
  std::string text(cell);
  std::ranges::replace(text, ',', '.');
  return text;
}

std::string without_commas(const std::string_view cell)
{
  std::string text(cell);
  std::erase(text, ',');
  return text;
}

bool is_blank(const std::vector<std::string_view>& cells)
{
  return std::ranges::all_of(cells, [](const std::string_view cell) { return cell.empty(); });
}
} // namespace

std::unique_ptr<std::istream> open_text(const std::filesystem::path& file)
{
  auto stream = std::make_unique<ReadableFile>(file);
  std::array<char, 3> first{};
  stream->read(first.data(), first.size());
  const std::string_view mark(first.data(), std::size_t(stream->gcount()));
  if (mark.starts_with("\xff\xfe") || mark.starts_with("\xfe\xff"))
    return std::make_unique<std::istringstream>(from_utf16(content_of(file), file.string()));
  if (mark != "\xef\xbb\xbf")
    {
      stream->clear();
      stream->seekg(0);
    }
  return stream;
}

CsvReader::CsvReader(const std::filesystem::path& file, const IsHeader& is_header)
  : name(file.string())
  , stream(open_text(file))
{
  constexpr std::size_t longest_preamble = 100;
  bool is_found = false;
  is_below_preamble = !is_header;
  while (!is_found && line_number < longest_preamble && read_line())
    {
      if (is_header && line.starts_with('#')) // as numpy.savetxt writes it
        line.erase(0, 1);
      const char its_separator = separator_of(line);
      cells = split(line, its_separator);
      while (cells.size() > 1 && cells.back().empty())
        cells.pop_back();
      is_found = !is_header || is_header(cells);
      if (!is_found && !columns.empty())
        continue; // the first line stands for the header where there is none
      separator = its_separator;
      header_line = line_number;
      names = line;
      columns.clear();
      for (const std::string_view cell : cells)
        columns.push_back(
          cell.empty() ? cell : std::string_view(names).substr(std::size_t(cell.data() - line.data()), cell.size()));
    }
  is_below_preamble = true;
  units.assign(columns.size(), 1.0);
  if (is_header) // of a machine's many columns those that are looked for must be there once
    return;
  constexpr std::string_view of_numbers =
    "+-.0123456789"; // a table without a header is told so where names are looked for
  for (auto column = columns.begin(); column != columns.end(); ++column)
    if (!column->empty() && of_numbers.find(column->front()) == of_numbers.npos &&
        std::find(columns.begin(), column, *column) != column)
      throw InputError("{}:{}: the column {} is there twice", name, header_line, in_quotes(*column));
}

/// The next line with something on it, to its end outside of quotes.
bool CsvReader::read_line()
{
  do
    {
      if (!std::getline(*stream, line))
        return false;
      ++line_number;
    }
  while (trim(line).empty() || (is_below_preamble && line.starts_with('#')));
  const std::size_t first_line = line_number;
  const auto opens_or_closes = [](const std::string& text) { return std::ranges::count(text, '"') % 2 == 1; };
  std::string more;
  for (bool is_open = is_below_preamble && opens_or_closes(line); is_open; is_open = is_open != opens_or_closes(more))
    {
      if (!std::getline(*stream, more))
        throw InputError("{}:{}: a double quote is opened and not closed", name, first_line);
      ++line_number;
      (line += '\n') += more;
    }
  return true;
}

bool CsvReader::has(const std::string_view column) const { return contains(columns, column); }

std::size_t CsvReader::place(const std::string_view column) const
{
  const auto found = std::ranges::find(columns, column);
  if (found == columns.end())
    throw InputError("{}:{}: there is no column {}", name, header_line, column);
  return std::size_t(found - columns.begin());
}

std::optional<std::size_t> CsvReader::find_in_si(const std::string_view name_in_si)
{
  constexpr std::pair<std::string_view, const Dimension*> endings[] = {
    {"_Pa", &stress}, {"_m", &length},     {"_rad", &angle},         {"_per_s", &rate}, {"_s", &duration},
    {"_J", &energy},  {"_dB", &amplitude}, {"_kg_per_m3", &density}, {"", &strain}};
  const auto& [ending, dimension] =
    *std::ranges::find_if(endings, [&](const auto& one) { return name_in_si.ends_with(one.first); });
  const std::string wanted = plain_name(name_in_si.substr(0, name_in_si.size() - ending.size()));
  std::optional<std::size_t> found;
  for (std::size_t c = 0; c < columns.size(); ++c)
    {
      const auto [name_of_column, unit] = title_with_mark_of(columns[c]);
      const auto refusal = [&](const std::string_view what) {
        return InputError("{}:{}: {}: {}", name, header_line, in_quotes(columns[c]), what);
      };
      const bool is_in_si = plain_name(columns[c]) == plain_name(name_in_si);
      if (!is_in_si && plain_name(name_of_column) != wanted)
        continue;
      if (found)
        throw refusal("is there twice");
      if (!is_in_si && unit.empty())
        throw refusal(fmt::format("has no unit; write it as in \"{} [{}]\"", wanted, dimension->si_unit));
      found = c;
      units[c] =
        is_in_si ? 1.0 : rephrased([&, &unit = unit, of = dimension] { return unit_in_si(unit, *of); }, refusal);
    }
  return found;
}

bool CsvReader::next()
{
  do
    {
      if (!read_line())
        {
          if (!ambiguous.empty())
            throw InputError(ambiguous);
          return false;
        }
      cells = split(line, separator);
    }
  while (is_blank(cells));
  while (cells.size() > columns.size() && cells.back().empty())
    cells.pop_back();
  if (cells.size() != columns.size())
    throw InputError("{}:{}: there must be {} values, one for each of {}; found {}", name, line_number, columns.size(),
                     excerpt(fmt::format("{}", fmt::join(columns, ",")), longest_quote), cells.size());
  return true;
}

std::string CsvReader::text_with_point(const std::size_t column) const
{
  const std::string_view cell = cells[column];
  if (separator == ',' || !is_decimal_number(with_points(cell)))
    return std::string(cell);
  number(column); // which checks the decimal sign
  return with_points(cell);
}

double CsvReader::number(const std::size_t column) const
{
  const std::string_view cell = cells[column];
  const auto refusal = [&](const std::string& what) {
    return InputError("{}:{}: {}: {}", name, line_number, excerpt(columns[column]), what);
  };
  const char sign = cell.find('.') != std::string_view::npos                       ? '.'
                    : separator != ',' && cell.find(',') != std::string_view::npos ? ','
                                                                                   : char(0);
  if (sign != 0 && decimal_sign != 0 && sign != decimal_sign)
    throw refusal(fmt::format("{} has another decimal sign than the numbers before it", in_quotes(cell)));
  const std::string with_point = sign == ',' ? with_points(cell) : std::string(cell);
  if (sign == ',' && decimal_sign == 0 && is_perhaps_of_thousands(cell))
    {
      if (ambiguous.empty()) // until a number of the file shows its decimal sign
        ambiguous = refusal(fmt::format("{} may mean {} or {}; write thousands without a comma, and a decimal point",
                                        in_quotes(cell), with_point, without_commas(cell)))
                      .what();
    }
  else if (sign == '.' && !ambiguous.empty())
    throw InputError(ambiguous);
  else if (sign != 0)
    {
      decimal_sign = sign;
      ambiguous.clear();
    }
  return units[column] * rephrased([&] { return parse_number(with_point); }, refusal);
}

double CsvReader::number_or_nan(const std::size_t column) const
{
  const auto value = number_in<double>(cells[column]);
  return value ? *value : number(column); // which tells the reason
}

double CsvReader::count(const std::size_t column, const double most) const
{
  const double value = number_or_nan(column);
  if (!(value >= 0.0 && value <= most && value == std::floor(value)))
    throw InputError("{}:{}: {} is no count or number of something", name, line_number, in_quotes(cells[column]));
  return value;
}

std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, const std::string_view header)
{
  CsvReader table(file);
  std::vector<std::size_t> places;
  for (const std::string_view name : split_at_commas(header))
    if (const auto place = table.find_in_si(name))
      places.push_back(*place);
  const auto& given = table.header();
  const auto n_given = std::size_t(std::ranges::count_if(given, [](const auto name) { return !name.empty(); }));
  if (places.size() != split_at_commas(header).size() || places.size() != n_given)
    throw InputError("{}:{}: the header is {}; it must be \"{}\"", file.string(), table.line_of_header(),
                     in_quotes(fmt::format("{}", fmt::join(given, ","))), header);
  std::vector<std::vector<double>> rows;
  while (table.next())
    {
      std::vector<double>& row = rows.emplace_back();
      for (const std::size_t place : places)
        row.push_back(table.number(place));
    }
  if (rows.empty())
    throw InputError("{}: there is no row below the header", file.string());
  return rows;
}

ColumnTitle title_of(const std::string_view column)
{
  const char last = column.empty() ? ' ' : column.back();
  const std::size_t open = last == ']' ? column.rfind('[') : last == ')' ? column.rfind('(') : std::string_view::npos;
  if (open == std::string_view::npos)
    return {column, {}};
  return {trim(column.substr(0, open)), trim(column.substr(open + 1, column.size() - open - 2))};
}

ColumnTitle title_with_mark_of(const std::string_view column)
{
  const ColumnTitle title = title_of(column);
  const std::size_t mark = column.find_last_of("/,");
  if (!title.unit.empty() || mark == std::string_view::npos)
    return title;
  // "axial strain mm/mm" has no mark before its unit
  return {trim(column.substr(0, mark)), trim(column.substr(mark + 1))};
}

std::string plain_name(const std::string_view name)
{
  std::string plain = in_small_letters(trim(name));
  std::ranges::replace(plain, '_', ' ');
  return plain;
}
} // namespace feldspar
