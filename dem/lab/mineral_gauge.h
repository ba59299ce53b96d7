#pragma once

#include "dem/specimen/neighbours.h"
#include "dem/specimen/specimen.h"

#include <array>
#include <cstdint>
#include <vector>

namespace feldspar
{
/// Strain of each mineral of a specimen: the least-squares gradient of the motions of its grains against their neighbours. These
/// are the grains of the body within a gap of one mean radius, across pores too, which deform more than the joints around
/// them; docs/theory.md §3.4. A grain of a rigid group stands where the centre of its group does.
template <int dim>
class MineralGauge
{
public:
  MineralGauge() = default;

  /// Takes these positions of all grains as the undeformed ones [m]. is_part: each grain, of the body; [n_grains]. There are no
  /// strains of a specimen without minerals.
  MineralGauge(const Specimen<dim>& specimen, const Components<dim>& undeformed, const std::vector<bool>& is_part);

  /// xx, xy, xz, yy, yz, zz of each mineral, tension positive, for grains that stand as the specimen's do; NaN where it has too
  /// few grains to tell.
  std::array<std::vector<double>, 6> strains(const Specimen<dim>& specimen) const;

private:
  std::vector<GrainPair> neighbours;       ///< in different bodies
  Components<dim> start;                   ///< undeformed positions of the bodies of all grains [m]
  std::vector<Tensor<dim>> inverse_moment; ///< (Σ w l ⊗ l)⁻¹ of each mineral [1/m²]
};
} // namespace feldspar
