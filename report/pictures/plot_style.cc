#include "report/pictures/plot_style.h"

#include "base/quoted.h"

#include <array>
#include <cmath>

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

double round_number(const double most)
{
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  const double first = most / power;
  return power * (first >= 5.0 ? 5.0 : first >= 2.0 ? 2.0 : 1.0);
}

std::string with_capital(const std::string_view words)
{
  std::string text(words);
  if (!text.empty() && 'a' <= text.front() && text.front() <= 'z')
    text.front() = char(text.front() - 'a' + 'A');
  return text;
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
