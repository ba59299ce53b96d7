#pragma once

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Rows for a data frame: no two columns of one name, a number a cell, nothing in the cell of what is not known.
struct DataFrame
{
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows = {};
};

/// A table as the page shows it; its CSV file has the same unless it has a form of its own.
struct Table
{
  std::string name; ///< of its file
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows = {}; ///< the first cell of each is its heading
  std::optional<DataFrame> file = std::nullopt;
};

/// For a terminal: the caption, and below it the columns.
std::string as_text(const Table& table);

/// Comma-separated, quoted where needed. A text that a spreadsheet would take for a formula begins with an apostrophe
/// there.
std::string as_csv(const Table& table);
} // namespace feldspar
