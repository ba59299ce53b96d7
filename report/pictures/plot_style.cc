#include "report/pictures/plot_style.h"

#include "base/quoted.h"

#include <array>

namespace feldspar::plot
{
namespace
{
/// Colours of series, none of them that of a kind of cracks.
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
