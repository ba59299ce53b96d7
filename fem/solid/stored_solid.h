#pragma once

#include "fem/solid/state.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// The accepted state of a cell; the same for any number of ranks.
struct StoredCell
{
  std::uint64_t number;             ///< PointPlace::cell_number
  std::vector<double> displacement; ///< of its degrees of freedom, in the order of its element
  std::vector<double> responses;    ///< of its points one after another: stress, then tangent
  std::vector<std::string> points;  ///< MaterialPoint::stored()

  template <typename Archive>
  void serialize(Archive& archive, unsigned int /*version*/)
  {
    archive& number& displacement& responses& points;
  }
};

/// The accepted state of a solid, for a file that returns to the same program and mesh.
struct StoredSolid
{
  std::vector<StoredCell> cells;           ///< of this rank
  std::map<std::string, double> pressures; ///< the same on every rank
  BoundaryWork work{};                     ///< the same on every rank
};

/// Cells of this rank, as they are stored.
template <int dim, int material_dim>
std::vector<StoredCell> stored_cells(const Discretisation<dim>& elements, const MaterialPoints<material_dim>& materials,
                                     const SolidState<material_dim>& state);

/// The cells of this rank among those that all ranks bring. Collective.
template <int dim>
std::vector<StoredCell> brought_home(const Discretisation<dim>& elements, const std::vector<StoredCell>& cells);

/// The state at rest with displacement, strains and responses of the cells of this rank, and the points put back to theirs;
/// forces and pressures stay. Collective. Throws std::invalid_argument, on every rank, where these are not all cells, or
/// of another mesh or material; the points are then unusable.
template <int dim, int material_dim>
SolidState<material_dim> restored(const Discretisation<dim>& elements, SolidPoints<material_dim>& points,
                                  const SolidState<material_dim>& at_rest, const std::vector<StoredCell>& cells);
} // namespace feldspar::fem
