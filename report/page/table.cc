#include "report/page/table.h"

#include "base/text.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace feldspar
{
namespace
{
bool is_number(const std::string& text)
{
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool would_be_a_formula(const std::string& cell) { return cell.find_first_of("=+-@\t\r\n") == 0 && !is_number(cell); }

std::string as_csv(const std::vector<std::string>& cells)
{
  std::string line;
  for (const auto& text : cells)
    {
      if (&text != cells.data())
        line += ',';
      const std::string cell = (would_be_a_formula(text) ? "'" : "") + text;
      if (cell.find_first_of(",\"\n\r") == std::string::npos)
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

std::string as_text(const Table& table)
{
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.header.size(); ++c)
    {
      widths.push_back(width_of(table.header[c]));
      for (const auto& row : table.rows)
        widths[c] = std::max(widths[c], width_of(row[c]));
    }
  std::string text = table.caption + "\n";
  const auto add = [&](const std::vector<std::string>& cells) {
    text += cells.front() + std::string(widths.front() - width_of(cells.front()), ' ');
    for (std::size_t c = 1; c < cells.size(); ++c)
      text += "   " + std::string(widths[c] - width_of(cells[c]), ' ') + cells[c];
    text += '\n';
  };
  add(table.header);
  for (const auto& row : table.rows)
    add(row);
  return text;
}

std::string as_csv(const Table& table)
{
  std::string text = as_csv(table.file ? table.file->header : table.header);
  for (const auto& row : table.file ? table.file->rows : table.rows)
    text += as_csv(row);
  return text;
}
} // namespace feldspar
