#include "dem/minerals/mixture_bounds.h"

#include <algorithm>
#include <limits>

namespace feldspar
{
namespace
{
/// [Σ share / (modulus + reference)]⁻¹ - reference; the harmonic mean without a reference.
double mean(const std::vector<PhaseModuli>& phases, double PhaseModuli::*const modulus, const double reference)
{
  double sum = 0.0;
  for (const PhaseModuli& phase : phases)
    sum += phase.share / (phase.*modulus + reference);
  return 1.0 / sum - reference;
}

/// In a matrix of these moduli.
template <int dim>
Moduli in_matrix(const std::vector<PhaseModuli>& phases, const Moduli& matrix)
{
  const auto [k, g] = matrix;
  const double of_bulk = dim == 2 ? g : 4.0 / 3.0 * g;
  const double of_shear = dim == 2 ? k * g / (k + 2.0 * g) : g * (9.0 * k + 8.0 * g) / (6.0 * (k + 2.0 * g));
  return {mean(phases, &PhaseModuli::bulk_modulus, of_bulk), mean(phases, &PhaseModuli::shear_modulus, of_shear)};
}
} // namespace

template <int dim>
MixtureBounds mixture_bounds(const std::vector<PhaseModuli>& phases)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Moduli least{infinity, infinity}, most{0.0, 0.0}, voigt{0.0, 0.0};
  for (const auto& [share, bulk, shear] : phases)
    {
      least = {std::min(least.bulk_modulus, bulk), std::min(least.shear_modulus, shear)};
      most = {std::max(most.bulk_modulus, bulk), std::max(most.shear_modulus, shear)};
      voigt.bulk_modulus += share * bulk;
      voigt.shear_modulus += share * shear;
    }
  return {{mean(phases, &PhaseModuli::bulk_modulus, 0.0), mean(phases, &PhaseModuli::shear_modulus, 0.0)},
          in_matrix<dim>(phases, least),
          in_matrix<dim>(phases, most),
          voigt};
}

template MixtureBounds mixture_bounds<2>(const std::vector<PhaseModuli>&);
template MixtureBounds mixture_bounds<3>(const std::vector<PhaseModuli>&);
} // namespace feldspar
