#pragma once

#include "base/body.h"
#include "dem/storage/grains.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// Strain of the middle of a specimen: least-squares gradient of the displacements of the grains within 0.4 of the
/// width and 0.25 of the height from its centre, where the ends disturb least; in a cylinder 0.4 of the diameter from its
/// axis. A grain without a joint lies loose in a pore and need not follow the body: it does not count. A grain of a rigid
/// group stands where the centre of its group does: inside of a group nothing is strained.
template <int dim>
class StrainGauge
{
public:
  StrainGauge() = default;

  /// Takes these positions of all grains as the undeformed ones. size: of the specimen [m]; jointed:
  /// whether each grain has had a joint, [n_grains].
  StrainGauge(const Vector<dim>& size, BodyShape shape, const Components<dim>& undeformed,
              const std::vector<bool>& jointed);

  /// Displacement gradient ∂u_i/∂x_j of grains that stand here; NaN where too few lie in the gauge to tell.
  Tensor<dim> displacement_gradient(const Components<dim>& position) const;

private:
  std::vector<std::uint32_t> members;
  std::vector<Vector<dim>> start; ///< undeformed positions [m]
  Vector<dim> mean_start = Vector<dim>::Zero();
  Tensor<dim> inverse_moment = Tensor<dim>::Zero(); ///< (Σ x ⊗ x)⁻¹ of positions from their mean [1/m²]
};
} // namespace feldspar
