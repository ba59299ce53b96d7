#pragma once

#include <string>
#include <vector>

namespace feldspar
{
/// A table as the page shows it and as a CSV file has it.
struct Table
{
  std::string name; ///< of its file
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows; ///< the first cell of each is its heading
};

/// Comma-separated, quoted where needed. A text that a spreadsheet would take for a formula begins with an apostrophe
/// there.
std::string as_csv(const Table& table);
} // namespace feldspar
