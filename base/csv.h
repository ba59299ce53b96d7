#pragma once

#include "base/readable_file.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// A table of cells between commas under a line of column names, read row by row. Allowed are the byte-order mark and the
/// line ends of spreadsheets, and empty lines. Every mistake throws InputError with file and line.
class CsvReader
{
public:
  explicit CsvReader(const std::filesystem::path& file);
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;
  ~CsvReader() = default;

  /// The first line.
  const std::string& header() const { return names; }

  bool has(std::string_view column) const;

  /// The number of a column; throws InputError where there is none of that name.
  std::size_t place(std::string_view column) const;

  /// Reads the next row; false after the last. Throws InputError unless it has as many cells as there are columns.
  bool next();

  /// The number of the row's line in the file; 1 is the header.
  std::size_t line_of_row() const { return line_number; }

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
  std::string name;
  ReadableFile stream;
  std::string names;
  std::vector<std::string_view> columns; ///< of `names`
  std::string line;
  std::size_t line_number = 1;
  std::vector<std::string_view> cells; ///< of `line`
};

/// Reads a table of decimal numbers whose first line is `header`; [rows][columns], at least one row. Throws InputError.
std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, std::string_view header);
} // namespace feldspar
