#include "report/pictures/plot_style.h"

#include "base/quoted.h"
#include "report/pictures/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace feldspar::plot
{
namespace
{
/// None of them that of a kind of cracks.
constexpr std::array colours{green, purple, orange, sky, brown, lime};
} // namespace

std::string colour(const Series& series, const std::size_t n)
{
  return series.kind == SeriesKind::laboratory_curve ? black : colours[n % colours.size()];
}

int point_type(const Series& series)
{
  constexpr int disc = 7;
  constexpr int square = 5;
  constexpr int diamond = 13;
  return series.kind == SeriesKind::laboratory_curve ? diamond : series.kind == SeriesKind::specimens ? disc : square;
}

int dashes(const std::size_t n) { return 1 + int(n / colours.size()); }

std::string frame(const std::string& x_label, const std::string& y_label)
{
  return fmt::format("set xlabel {} noenhanced offset 0,0.4\nset ylabel {} noenhanced\n"
                     "set border 3 lw 0.8; set tics nomirror out; set grid lw 0.5 lc rgb '#e4e4e4'\n"
                     "set key below center horizontal Left reverse samplen 2.2 spacing 1.1 height 0.8 noenhanced\n",
                     gnuplot_text(x_label), gnuplot_text(y_label));
}

std::string data_block(const std::string& what, const std::string& owner)
{
  std::string name = what + "_" + owner;
  std::replace_if(
    name.begin(), name.end(),
    [](const char c) {
      return !is_plain_name({&c, 1});
    },
    '_');
  return "$" + name;
}

std::string trace_of(const Crack& crack, const std::size_t axis, const std::array<double, 2>& origin)
{
  const double dx = -crack.normal[axis] * crack.size;
  const double dy = crack.normal[0] * crack.size;
  return fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", (crack.centroid[0] - origin[0] - 0.5 * dx) / milli,
                     (crack.centroid[axis] - origin[1] - 0.5 * dy) / milli, dx / milli, dy / milli);
}

std::string title(const std::string& text)
{
  return text.empty() ? "notitle" : fmt::format("title {} noenhanced", gnuplot_text(text));
}

std::string ColumnKey::entry(const std::string& label)
{
  if (!label.empty())
    {
      ++n_entries;
      // Bytes that go on with a character of UTF-8 begin with the bits 10.
      longest = std::max(
        longest, int(std::count_if(label.begin(), label.end(), [](const char c) { return (c & 0xC0) != 0x80; })));
    }
  return title(label);
}

int ColumnKey::n_rows(const int picture_width) const
{
  constexpr int usual = 5;
  // What gnuplot reckons for a column, and how far columns may stick out: it takes letters for wider than they are.
  constexpr double letter = 8.4, mark = 53.0, reach = 1.08;
  const int n_columns = std::max(1, int(reach * picture_width / (letter * longest + mark)));
  return std::max(usual, (n_entries + n_columns - 1) / n_columns);
}

std::string ColumnKey::set_up(const int picture_width) const
{
  return fmt::format("set key vertical maxrows {}", n_rows(picture_width));
}

int ColumnKey::further_height(const int picture_width) const
{
  constexpr int usual = 5, row = 23;
  return row * (n_rows(picture_width) - usual);
}

void add_cracks(std::string& data, std::string& plots, const std::size_t n, const CrackKind kind,
                const std::string& rows, const double line_width)
{
  const auto n_cracks = std::count(rows.begin(), rows.end(), '\n');
  if (n_cracks == 0)
    return;
  const bool in_tension = kind == CrackKind::tension;
  const char* const name = in_tension ? "tension" : "shear";
  data += fmt::format("${}{} << EOD\n{}EOD\n", name, n, rows);
  plots += fmt::format(", ${}{} with vectors nohead lw {} lc rgb '{}' title '{}: {}'", name, n, line_width,
                       in_tension ? tension_colour : shear_colour, name, n_cracks);
}

std::string file_name(const std::string& label)
{
  constexpr std::size_t most_characters = 60;
  std::string name;
  for (const char c : label.substr(0, most_characters))
    if (is_plain_name({&c, 1}) || (!name.empty() && (c == '-' || c == '.')))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  while (!name.empty() && name.back() == '_')
    name.pop_back();
  return name;
}
} // namespace feldspar::plot
