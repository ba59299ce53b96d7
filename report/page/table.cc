#include "report/page/table.h"

#include "base/mapped.h"
#include "base/text.h"

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace feldspar
{
namespace
{
bool would_be_a_formula(const std::string& cell)
{
  return cell.find_first_of("=+-@\t\r\n") == 0 && !number_in<double>(cell);
}

std::string csv_cell(const std::string& text)
{
  const std::string cell = (would_be_a_formula(text) ? "'" : "") + text;
  return cell.find_first_of(",\"\n\r") == std::string::npos ? cell
                                                            : '"' + boost::replace_all_copy(cell, "\"", "\"\"") + '"';
}

std::string as_csv(const std::vector<std::string>& cells)
{
  return fmt::format("{}\n", fmt::join(mapped<std::string>(cells, csv_cell), ","));
}
} // namespace

std::string as_text(const Table& table)
{
  std::vector<std::size_t> widths;
  std::vector<std::vector<std::string>> headings; // in lines no wider than their columns, where words allow it
  std::size_t n_lines = 0;
  for (std::size_t c = 0; c < table.header.size(); ++c)
    {
      widths.push_back(0);
      for (const auto& row : table.rows)
        widths[c] = std::max(widths[c], width_of(row[c]));
      headings.push_back(in_lines(table.header[c], widths[c]));
      for (const std::string& line : headings[c])
        widths[c] = std::max(widths[c], width_of(line));
      n_lines = std::max(n_lines, headings[c].size());
    }
  std::string text = table.caption + "\n";
  const auto add = [&](const std::vector<std::string>& cells) {
    text += cells.front() + std::string(widths.front() - width_of(cells.front()), ' ');
    for (std::size_t c = 1; c < cells.size(); ++c)
      text += "   " + std::string(widths[c] - width_of(cells[c]), ' ') + cells[c];
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  };
  for (std::size_t k = 0; k < n_lines; ++k)
    {
      std::vector<std::string> line;
      for (const std::vector<std::string>& heading : headings)
        {
          const std::size_t empty_lines = n_lines - heading.size();
          line.push_back(k < empty_lines ? "" : heading[k - empty_lines]);
        }
      add(line);
    }
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
