#pragma once

#include "fem/solid/discretisation.h"
#include "fem/solid/load.h"

#include <deal.II/lac/affine_constraints.h>

#include <optional>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// The constraints of a load on the corrections of Newton's method, for the degrees of freedom that a rank knows.
struct SolidConstraints
{
  /// A plate that moves until boundaries have swept a volume.
  struct Following
  {
    std::vector<std::string> boundaries;
    double swept_before;                             ///< in the accepted state [m³]
    double swept_wanted;                             ///< [m³]
    dealii::AffineConstraints<double> unit_of_plate; ///< the plate moves by one metre, what else is held stands
  };

  dealii::AffineConstraints<double> first;    ///< of the first correction, which moves the boundary
  dealii::AffineConstraints<double> standing; ///< of the others
  std::optional<Following> following{};
  std::string places{}; ///< what is held where; loads that say the same have a matrix of the same pattern
};

/// Constraints that go this fraction of the way from an accepted displacement (with ghosts) to a load. Collective.
/// Throws MeshError for a boundary that is not there.
template <int dim>
SolidConstraints constrain(const Discretisation<dim>& elements, const Load<dim>& load, const NodalVector& accepted,
                           double fraction);
} // namespace feldspar::fem
