#pragma once

#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>

#include <optional>

namespace feldspar::fem
{
enum class LinearSolver
{
  automatic, ///< MUMPS for small problems and matrices that are not symmetric; else conjugate gradients, MUMPS if they fail
  conjugate_gradients, ///< with hypre's algebraic multigrid; symmetric matrices
  gmres,               ///< with hypre's algebraic multigrid
  mumps                ///< direct
};

/// Solves matrix · solution = right_side to a relative residual. n_components: of the displacement, those of a node
/// numbered one after another. Returns the number of iterations (1 if direct), or
/// nothing where the matrix is singular or the iteration does not converge.
std::optional<unsigned int> solve_linear(LinearSolver solver, bool symmetric,
                                         const dealii::PETScWrappers::MPI::SparseMatrix& matrix,
                                         dealii::PETScWrappers::MPI::Vector& solution,
                                         const dealii::PETScWrappers::MPI::Vector& right_side, int n_components,
                                         double relative_tolerance);
} // namespace feldspar::fem
