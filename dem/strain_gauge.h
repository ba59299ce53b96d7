#pragma once

#include "dem/specimen.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// Strain of the middle of a specimen: least-squares gradient of the displacements of the grains within 0.4 of the
/// width and 0.25 of the height from its centre, where the ends disturb least.
template <int dim>
class StrainGauge
{
public:
  /// Takes the grains' present positions as the undeformed ones.
  explicit StrainGauge(const Specimen<dim>& specimen);

  /// Displacement gradient ∂u_i/∂x_j; NaN where too few grains lie in the gauge to tell.
  Tensor<dim> displacement_gradient(const Grains<dim>& grains) const;

private:
  std::vector<std::uint32_t> members;
  std::vector<Vector<dim>> start; ///< undeformed positions [m]
  Vector<dim> mean_start;
  Tensor<dim> inverse_moment; ///< (Σ x ⊗ x)⁻¹ of positions from their mean [1/m²]
};
} // namespace feldspar
