#include "dem/genesis/grain_sizes.h"

#include "base/random.h"
#include "dem/storage/grains.h"

#include <cmath>
#include <cstddef>

namespace feldspar
{
namespace
{
/// The radius at a share of the way from the smallest to the largest, which a log-normal distribution measures by logarithms.
double radius_at(const SpecimenParameters& wanted, const double share)
{
  return wanted.minimum_radius * (wanted.size_distribution == SizeDistribution::log_normal
                                    ? std::pow(wanted.radius_ratio, share)
                                    : 1.0 + (wanted.radius_ratio - 1.0) * share);
}

constexpr double deviations_to_bounds = 3.0; // from the middle; 0.3 % of the draws lie beyond and are repeated

double draw_radius(const SpecimenParameters& wanted, Random& random)
{
  if (wanted.size_distribution == SizeDistribution::uniform)
    return wanted.minimum_radius * random.uniform(1.0, wanted.radius_ratio);
  for (;;)
    if (const double share = random.normal(0.5, 0.5 / deviations_to_bounds); share >= 0.0 && share <= 1.0)
      return radius_at(wanted, share);
}

double volume_of_grain(const SpecimenParameters& wanted, const double radius)
{
  return wanted.dimension == 2 ? grain_volume<2>(radius, 1.0) : grain_volume<3>(radius, 1.0);
}

/// Integral by Simpson's rule, which is exact for uniform radii.
double mean_volume(const SpecimenParameters& wanted)
{
  constexpr int n = 200;
  double volume = 0.0;
  double weight = 0.0;
  for (int k = 0; k <= n; ++k)
    {
      const double share = double(k) / n;
      const double from_middle = deviations_to_bounds * (2.0 * share - 1.0);
      const double density =
        wanted.size_distribution == SizeDistribution::uniform ? 1.0 : std::exp(-0.5 * from_middle * from_middle);
      const double part = density * (k == 0 || k == n ? 1.0 : k % 2 == 1 ? 4.0 : 2.0);
      volume += part * volume_of_grain(wanted, radius_at(wanted, share));
      weight += part;
    }
  return volume / weight;
}

/// Grains between two sieves. Their mass is spread evenly over the logarithm of the size, as between two points of a curve on
/// the usual paper; in d dimensions the number of grains then falls with the d-th power of the size.
struct SieveClass
{
  SieveClass(const SpecimenParameters& wanted, const std::size_t k)
    : dimension(wanted.dimension)
    , smallest(0.5 * wanted.sieve_curve[k].size)
    , largest(0.5 * wanted.sieve_curve[k + 1].size)
    , share_of_mass(wanted.sieve_curve[k + 1].passing - wanted.sieve_curve[k].passing)
    , at_smallest(std::pow(smallest, -dimension))
    , at_largest(std::pow(largest, -dimension))
  {
  }

  double draw(Random& random) const { return std::pow(random.uniform(at_smallest, at_largest), -1.0 / dimension); }

  double mean_volume(const SpecimenParameters& wanted) const
  {
    return volume_of_grain(wanted, 1.0) * dimension * std::log(largest / smallest) / (at_smallest - at_largest);
  }

  double dimension;
  double smallest; ///< radius [m]
  double largest;  ///< radius [m]
  double share_of_mass;
  double at_smallest; ///< R^-d
  double at_largest;
};

std::vector<SieveClass> classes_of(const SpecimenParameters& wanted)
{
  std::vector<SieveClass> classes;
  for (std::size_t k = 0; k + 1 < wanted.sieve_curve.size(); ++k)
    classes.emplace_back(wanted, k);
  return classes;
}
} // namespace

double expected_number(const SpecimenParameters& wanted, const double solid)
{
  if (wanted.sieve_curve.empty())
    return solid / mean_volume(wanted);
  double n = 0.0;
  for (const SieveClass& one : classes_of(wanted))
    n += one.share_of_mass * solid / one.mean_volume(wanted);
  return n;
}

template <int dim>
std::vector<double> draw_radii(const SpecimenParameters& wanted, const double solid, const double thickness,
                               const std::uint64_t seed)
{
  Random random(seed, RandomStream::radii);
  std::vector<double> radii;
  const auto fill = [&](const double volume, const auto& draw) {
    for (double filled = 0.0;;)
      {
        const double radius = draw();
        const double more = grain_volume<dim>(radius, thickness);
        if (std::abs(filled + more - volume) > std::abs(filled - volume))
          return;
        radii.push_back(radius);
        filled += more;
      }
  };
  if (wanted.sieve_curve.empty())
    fill(solid, [&] { return draw_radius(wanted, random); });
  for (const SieveClass& one : classes_of(wanted))
    fill(one.share_of_mass * solid, [&] { return one.draw(random); });
  return radii;
}

template std::vector<double> draw_radii<2>(const SpecimenParameters&, double, double, std::uint64_t);
template std::vector<double> draw_radii<3>(const SpecimenParameters&, double, double, std::uint64_t);
} // namespace feldspar
