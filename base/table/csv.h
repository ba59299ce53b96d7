#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
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

  /// The header is the first line that is one, of the first hundred; else the first line, in which a name stands once.
  explicit CsvReader(const std::filesystem::path& file, const IsHeader& is_header = {});
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;
  ~CsvReader() = default;

  /// The names of the columns.
  const std::vector<std::string_view>& header() const { return columns; }

  bool has(std::string_view column) const;

  /// The number of a column; throws InputError where there is none of that name.
  std::size_t place(std::string_view column) const;

  /// The number of a column by its name in SI, such as axial_stress_Pa or axial_strain, or by the same name with another unit,
  /// such as "Axial stress [MPa]"; number() of it is then in SI. None where there is no such column. Throws InputError for a
  /// unit that is missing or of another kind.
  std::optional<std::size_t> find_in_si(std::string_view name_in_si);

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

  /// The same; a number has a decimal point. Throws InputError as number() does.
  std::string text_with_point(std::size_t column) const;

  /// A decimal number, in SI of a column that find_in_si() has found; throws InputError for any other cell.
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
  std::vector<double> units;             ///< of the columns, in SI; 1 of those not found by find_in_si()
  std::string line;                      ///< several of the file where a cell in quotes has line ends
  std::size_t header_line = 1;
  std::size_t line_number = 0;
  std::vector<std::string_view> cells; ///< of `line`
  mutable char decimal_sign = 0;       ///< as numbers have shown so far
  mutable std::string ambiguous;       ///< refusal of a number that waits for another to show the decimal sign
};

/// The text of a file from its beginning, as UTF-8 without a byte-order mark. Throws InputError.
std::unique_ptr<std::istream> open_text(const std::filesystem::path& file);

/// Reads a table of decimal numbers with the columns of `header` in any order, named in SI or with their units
/// (find_in_si()), beside which a column without a name may stand; [rows][columns] in SI, at least one row. Throws InputError.
std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, std::string_view header);

/// The name of a column and its unit; the unit is empty where none is given.
struct ColumnTitle
{
  std::string_view name;
  std::string_view unit;
};

/// From `name [unit]` or `name (unit)`.
ColumnTitle title_of(std::string_view column);

/// From these, and from `name / unit` or `name, unit`.
ColumnTitle title_with_mark_of(std::string_view column);

/// A name in small letters, with blanks in place of underscores: "Axial_Strain" and "axial strain" are one.
std::string plain_name(std::string_view name);
} // namespace feldspar
