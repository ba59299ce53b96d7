#pragma once

#include "fem/solid/state.h"

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/petsc_sparse_matrix.h>

#include <vector>

/// The weak form of equilibrium and its derivative by the displacement; docs/theory.md §8.1.
namespace feldspar::fem
{
/// Forces on every node [N].
struct NodalForces
{
  NodalVector internal;   ///< by the stresses, as if nothing were held
  NodalVector external;   ///< of the pressures
  NodalVector unbalanced; ///< external less internal, on what the constraints leave free to move
};

/// The forces of a state's stresses and pressures. Collective.
template <int dim, int material_dim>
NodalForces assemble_forces(const Discretisation<dim>& elements, const std::vector<double>& volumes,
                            const SolidState<material_dim>& state,
                            const dealii::AffineConstraints<double>& constraints);

/// The pattern of the matrix under such constraints. Collective.
template <int dim>
void set_pattern(dealii::PETScWrappers::MPI::SparseMatrix& matrix, const Discretisation<dim>& elements,
                 const dealii::AffineConstraints<double>& constraints);

/// The matrix of the tangents; adds to the right side the motion that the constraints ask for. Collective.
template <int dim, int material_dim>
void assemble_tangent(const Discretisation<dim>& elements, const std::vector<double>& volumes,
                      const SolidState<material_dim>& state, const dealii::AffineConstraints<double>& constraints,
                      dealii::PETScWrappers::MPI::SparseMatrix& matrix, NodalVector& right_side);
} // namespace feldspar::fem
