#include "report/page/table.h"

namespace feldspar
{
namespace
{
std::string as_csv(const std::vector<std::string>& cells)
{
  std::string line;
  for (const auto& cell : cells)
    {
      if (&cell != cells.data())
        line += ',';
      if (cell.find_first_of(",\"\n") == std::string::npos)
        line += cell;
      else
        {
          line += '"';
          for (const char c : cell)
            line += c == '"' ? std::string("\"\"") : std::string(1, c);
          line += '"';
        }
    }
  return line + "\n";
}
} // namespace

std::string as_csv(const Table& table)
{
  std::string text = as_csv(table.header);
  for (const auto& row : table.rows)
    text += as_csv(row);
  return text;
}
} // namespace feldspar
