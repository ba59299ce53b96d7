#include "dem/genesis/packing_file.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "dem/specimen/neighbours.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace feldspar
{
namespace
{
constexpr double largest_overlap = 0.05; // of the smaller radius

/// The numbers of one line, which must be exactly n.
std::vector<double> numbers(const std::string& line, const std::size_t n, const std::string& where)
{
  std::vector<double> values;
  const char* at = line.data();
  const char* const end = line.data() + line.size();
  const auto skip_blanks = [&] {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r'))
      ++at;
  };
  for (skip_blanks(); at != end; skip_blanks())
    {
      double value = 0.0;
      const auto [rest, error] = std::from_chars(at, end, value);
      if (error != std::errc() || !std::isfinite(value))
        throw InputError(fmt::format("{}: {} holds something that is not a number; a line is {}", where,
                                     in_quotes(line), n == 3 ? "x y radius" : "x y z radius"));
      values.push_back(value);
      at = rest;
    }
  if (values.size() != n)
    throw InputError(fmt::format("{}: {} numbers found; a line is {}, in metres", where, values.size(),
                                 n == 3 ? "x y radius" : "x y z radius"));
  return values;
}
} // namespace

template <int dim>
Grains<dim> read_packing(const SpecimenParameters& wanted, const std::function<void()>& check)
{
  ReadableFile file(wanted.packing_file);
  std::vector<double> radii;
  Components<dim> positions;
  std::vector<std::size_t> line_of;
  std::string line;
  constexpr std::size_t lines_between_checks = 10000;
  for (std::size_t n = 1; std::getline(file, line); ++n)
    {
      if (n % lines_between_checks == 0)
        check();
      line.erase(std::min(line.find('#'), line.size()));
      if (line.find_first_not_of(" \t\r") == std::string::npos)
        continue;
      const std::string where = fmt::format("{}:{}", wanted.packing_file, n);
      const auto values = numbers(line, dim + 1, where);
      if (values[dim] <= 0.0)
        throw InputError(fmt::format("{}: radius {} m; a radius must be greater than 0", where, values[dim]));
      for (int c = 0; c < dim; ++c)
        {
          const double length = c == dim - 1 ? wanted.height : wanted.width;
          if (values[c] < 0.0 || values[c] > length)
            throw InputError(fmt::format("{}: {} = {} m lies outside the specimen; allowed are 0 to {} m", where,
                                         "xyz"[c], values[c], length));
          positions[c].push_back(values[c]);
        }
      if (wanted.shape == "cylinder")
        if (const double r = std::hypot(values[0] - 0.5 * wanted.width, values[1] - 0.5 * wanted.width);
            r > 0.5 * wanted.width)
          throw InputError(fmt::format("{}: lies {} m from the axis of the cylinder; allowed are 0 to {} m", where, r,
                                       0.5 * wanted.width));
      radii.push_back(values[dim]);
      line_of.push_back(n);
    }
  if (radii.size() < 2)
    throw InputError(fmt::format("{}: {} grains; a packing has at least two", wanted.packing_file, radii.size()));

  Grains<dim> grains;
  grains.place(radii, positions);
  for (const auto& [one, two] : pairs_within(grains, 0.0, check))
    {
      const double overlap = radii[one] + radii[two] - (at<dim>(positions, two) - at<dim>(positions, one)).norm();
      const double allowed = largest_overlap * std::min(radii[one], radii[two]);
      if (overlap > allowed)
        throw InputError(fmt::format("{}:{}: overlaps the grain of line {} by {:.3g} m; allowed are {:.0f} % of the "
                                     "smaller radius, {:.3g} m",
                                     wanted.packing_file, line_of[two], line_of[one], overlap, 100.0 * largest_overlap,
                                     allowed));
    }
  return grains;
}

template Grains<2> read_packing<2>(const SpecimenParameters&, const std::function<void()>&);
template Grains<3> read_packing<3>(const SpecimenParameters&, const std::function<void()>&);
} // namespace feldspar
