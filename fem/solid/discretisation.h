#pragma once

#include "fem/mesh/sample_mesh.h"
#include "fem/solid/parameters.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/index_set.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/component_mask.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/lac/petsc_vector.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace feldspar::fem
{
using NodalVector = dealii::PETScWrappers::MPI::Vector;

/// The mask of one component of a displacement.
template <int dim>
dealii::ComponentMask only(const unsigned int component)
{
  dealii::ComponentMask mask(dim, false);
  mask.set(component, true);
  return mask;
}

/// Number of a cell among all cells of a mesh whose coarse cells are all refined as often, in the order of their
/// CellIds.
template <typename Cell>
std::uint64_t number_of(const Cell& cell)
{
  const dealii::CellId id = cell->id();
  std::uint64_t number = id.get_coarse_cell_id();
  for (const auto child : id.get_child_indices())
    number = number * dealii::GeometryInfo<Cell::AccessorType::dimension>::max_children_per_cell + child;
  return number;
}

/// The finite elements on a mesh: shape functions, quadrature, and the degrees of freedom of each rank.
template <int dim>
struct Discretisation
{
  /// The mesh must outlive it. Throws std::invalid_argument for elements that cannot be used.
  Discretisation(const SampleMesh<dim>& mesh, const SolidParameters& parameters);

  /// Numbers the degrees of freedom, anew where cells have moved between ranks.
  void distribute();

  MPI_Comm communicator() const { return dof_handler.get_communicator(); }
  /// The cells of this rank.
  auto owned_cells() const { return dof_handler.active_cell_iterators() | dealii::IteratorFilters::LocallyOwnedCell(); }
  std::uint64_t n_cells() const { return dof_handler.get_triangulation().n_global_active_cells(); }
  unsigned int n_points_per_cell() const { return quadrature.size(); }

  /// The degrees of freedom of a component on a boundary, of the cells that this rank knows.
  dealii::IndexSet dofs_on(const std::string& boundary, unsigned int component) const;

  NodalVector owned_vector() const { return NodalVector(owned, communicator()); }
  NodalVector ghosted_vector() const { return NodalVector(owned, relevant, communicator()); }

  using Integrand = std::function<double(const dealii::Tensor<1, dim>&, const dealii::Tensor<1, dim>&)>;
  /// Integral over a boundary, of a function of the displacement and the outer normal. Collective.
  double integral(const std::string& boundary, const NodalVector& displacement, const Integrand& integrand) const;
  /// Volume between boundaries at rest and as they are displaced, outwards positive [m³]. Collective.
  double swept_volume(const std::vector<std::string>& boundaries, const NodalVector& displacement) const;

  const SampleMesh<dim>& mesh;
  Kinematics kinematics;
  unsigned int order;
  dealii::MappingQ<dim> mapping;
  dealii::FESystem<dim> fe;
  dealii::QGauss<dim> quadrature;
  dealii::QGauss<dim - 1> face_quadrature;
  dealii::DoFHandler<dim> dof_handler;
  dealii::IndexSet owned;
  dealii::IndexSet relevant;
};
} // namespace feldspar::fem
