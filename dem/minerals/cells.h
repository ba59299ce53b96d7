#pragma once

#include "base/parameter_id.h"
#include "base/random.h"
#include "dem/specimen/specimen.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Random points whose Voronoi cells divide the grains of a specimen.
namespace feldspar
{
/// Cells of one kind that are wanted.
struct CellKind
{
  std::string name;                           ///< of a cell, for messages
  double size;                                ///< diameter of the circle or ball of the mean volume [m]
  std::string of = {};                        ///< the kind, for messages; empty where there is one
  double share = 1.0;                         ///< of the volume
  double aspect_ratio = 1.0;                  ///< length over width
  std::optional<double> angle = std::nullopt; ///< of the length, from the first axis towards the last; none: any [rad]
};

template <int dim>
struct Cell
{
  Vector<dim> centre; ///< [m]
  std::size_t kind;
  Tensor<dim> metric; ///< of distances from the centre, over the size of the kind [1/m]
};

/// Throws in as many points as cells of these kinds fill the specimen, the largest cells first. `size` is the parameter that an
/// InputError names for impossible cells.
template <int dim>
std::vector<Cell<dim>> throw_cells(const Specimen<dim>& specimen, const std::vector<CellKind>& kinds,
                                   RandomStream stream, const ParameterId& size);

/// The number of the cell that each grain lies in: that of the least distance to its centre. [n_grains]
template <int dim>
std::vector<std::uint32_t> cells_of_grains(const Specimen<dim>& specimen, const std::vector<Cell<dim>>& cells);
} // namespace feldspar
