#include "dem/flaws/seeds.h"

#include "base/parameter_id.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
/// Seeds keep this share of the mean size between them, so that none makes a splinter of a cell. Thrown in one after the
/// other they would fill the space by themselves at some 0.74 in the plane and 0.73 in space (random sequential adsorption
/// of discs and balls: 0.547 and 0.384 of the volume).
constexpr double least_distance = 0.65;
} // namespace

template <int dim>
std::vector<Vector<dim>> throw_seeds(const Specimen<dim>& specimen, const double mean_size, const RandomStream stream,
                                     const ParameterId& size, const std::string_view name)
{
  const double volume = specimen.size.prod();
  const double unit_cell = dim == 2 ? 0.25 * std::numbers::pi : std::numbers::pi / 6.0; // of mean size 1
  const auto n = std::size_t(std::llround(volume / (unit_cell * std::pow(mean_size, dim))));
  const double least = 4.0 * specimen.report.mean_radius;
  const auto refuse = [&](const std::string& why) {
    throw ParameterError(size, fmt::format("{:g} mm", 1e3 * mean_size), why);
  };
  if (n < 2)
    {
      // 1.5 cells are rounded to two; a little smaller, so that no rounding of the message names a size that is refused.
      const double most = 0.995 * std::pow(volume / (1.5 * unit_cell), 1.0 / dim);
      if (most < least)
        refuse(fmt::format("this specimen is too small for two {}s of two mean diameters of its particles, {:.3g} mm",
                           name, 1e3 * least));
      refuse(fmt::format(
        "must be at most {:.3g} mm in this specimen, which would have {} {}(s), and at least {:.3g} mm, two mean diameters of its particles",
        1e3 * most, n, name, 1e3 * least));
    }
  if (mean_size < least)
    refuse(fmt::format("must be at least two mean diameters of the particles that make up a {}, {:.3g} mm", name,
                       1e3 * least));
  Random random(specimen.seed, stream);
  const double apart = least_distance * mean_size;
  std::vector<Vector<dim>> seeds;
  while (seeds.size() < n)
    {
      Vector<dim> seed;
      for (int c = 0; c < dim; ++c)
        seed[c] = random.uniform(0.0, specimen.size[c]);
      if (std::none_of(seeds.begin(), seeds.end(),
                       [&](const Vector<dim>& other) { return (seed - other).squaredNorm() < apart * apart; }))
        seeds.push_back(seed);
    }
  return seeds;
}

template <int dim>
std::uint32_t nearest(const std::vector<Vector<dim>>& seeds, const Vector<dim>& point)
{
  std::uint32_t best = 0;
  for (std::uint32_t k = 1; k < seeds.size(); ++k)
    if ((seeds[k] - point).squaredNorm() < (seeds[best] - point).squaredNorm())
      best = k;
  return best;
}

template std::vector<Vector<2>> throw_seeds<2>(const Specimen<2>&, double, RandomStream, const ParameterId&,
                                               std::string_view);
template std::vector<Vector<3>> throw_seeds<3>(const Specimen<3>&, double, RandomStream, const ParameterId&,
                                               std::string_view);
template std::uint32_t nearest<2>(const std::vector<Vector<2>>&, const Vector<2>&);
template std::uint32_t nearest<3>(const std::vector<Vector<3>>&, const Vector<3>&);
} // namespace feldspar
