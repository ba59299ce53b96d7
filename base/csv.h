#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// A table of cells under a line of column names, read row by row, as RFC 4180 has it and as machines, spreadsheets, R and pandas
/// write it: cells between commas, semicolons or tabs, in double quotes or not; UTF-8 or UTF-16 with a byte-order mark; empty
/// lines, lines that begin with #, and empty columns at the end are skipped. Where commas do not separate cells, a comma in a
/// number is the decimal sign; one that may stand between thousands is refused if no other number of the file shows the
/// decimal sign. Every mistake throws InputError with file and line.
class CsvReader
{
public:
  /// Tells whether a line has the column names that are looked for.
  using IsHeader = std::function<bool(const std::vector<std::string_view>& names)>;

  /// The header is the first line that is one, of the first hundred; else the first line.
  explicit CsvReader(const std::filesystem::path& file, const IsHeader& is_header = {});
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;
  ~CsvReader() = default;

  /// The names of the columns.
  const std::vector<std::string_view>& header() const { return columns; }

  bool has(std::string_view column) const;

  /// The number of a column; throws InputError where there is none of that name.
  std::size_t place(std::string_view column) const;

  /// Reads the next row; false after the last. Throws InputError unless it has as many cells as there are columns.
  bool next();

  /// The number of the row's line in the file.
  std::size_t line_of_row() const { return line_number; }

  /// The number of the line with the column names.
  std::size_t line_of_header() const { return header_line; }

  /// The name of a column.
  std::string_view name_of(std::size_t column) const { return columns[column]; }

  /// A cell of the row, trimmed.
  std::string_view text(std::size_t column) const { return cells[column]; }

  /// A decimal number; throws InputError for any other cell.
  double number(std::size_t column) const;

  /// The same, or nan or inf, as this program writes them.
  double number_or_nan(std::size_t column) const;

  /// A whole number between 0 and `most`; throws InputError for any other cell.
  double count(std::size_t column, double most) const;

private:
  bool read_line();

  std::string name;
  std::unique_ptr<std::istream> stream;
  char separator = ',';
  bool is_below_preamble = false;
  std::string names;
  std::vector<std::string_view> columns; ///< of `names`
  std::string line;                      ///< several of the file where a cell in quotes has line ends
  std::size_t header_line = 1;
  std::size_t line_number = 0;
  std::vector<std::string_view> cells; ///< of `line`
  mutable char decimal_sign = 0;       ///< as numbers have shown so far
  mutable std::string ambiguous;       ///< refusal of a number that waits for another to show the decimal sign
};

/// Reads a table of decimal numbers with the columns of `header` in any order, beside which a column without a name may stand;
/// [rows][columns], at least one row. Throws InputError.
std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, std::string_view header);

/// The name of a column and its unit, from `name [unit]` or `name (unit)`; the unit is empty where none is given.
struct ColumnTitle
{
  std::string_view name;
  std::string_view unit;
};
ColumnTitle title_of(std::string_view column);
} // namespace feldspar
