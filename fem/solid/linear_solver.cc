#include "fem/solid/linear_solver.h"

#include <petscksp.h>

#include <cmath>
#include <stdexcept>

namespace feldspar::fem
{
namespace
{
void check(const PetscErrorCode error)
{
  if (error != 0)
    throw std::runtime_error("PETSc failed with error " + std::to_string(error));
}

/// Solves by PETSc itself: deal.II's wrappers stop by its default norm, that of the preconditioned residual, which is
/// no force.
std::optional<unsigned int> solve_once(const LinearSolver solver, const Mat matrix, const Vec solution,
                                       const Vec right_side, const int n_components, const double relative_tolerance)
{
  KSP krylov;
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix)), &krylov));
  check(KSPSetOperators(krylov, matrix, matrix));
  PC preconditioner;
  check(KSPGetPC(krylov, &preconditioner));
  if (solver == LinearSolver::mumps)
    {
      check(KSPSetType(krylov, KSPPREONLY));
      check(PCSetType(preconditioner, PCLU));
      check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
    }
  else
    {
      const bool symmetric = solver == LinearSolver::conjugate_gradients;
      check(KSPSetType(krylov, symmetric ? KSPCG : KSPGMRES));
      check(PCSetType(preconditioner, PCHYPRE));
      check(PCHYPRESetType(preconditioner, "boomeramg"));
      // hypre then treats displacements along each coordinate as functions of their own: 12 iterations where it took 70.
      check(MatSetBlockSize(matrix, n_components));
      if (!symmetric)
        {
          check(KSPGMRESSetRestart(krylov, 100));
          check(KSPSetPCSide(krylov, PC_RIGHT));
        }
      check(KSPSetNormType(krylov, KSP_NORM_UNPRECONDITIONED));
      constexpr int most_iterations = 1000;
      check(KSPSetTolerances(krylov, relative_tolerance, PETSC_DEFAULT, PETSC_DEFAULT, most_iterations));
    }
  check(KSPSolve(krylov, right_side, solution));
  KSPConvergedReason reason;
  check(KSPGetConvergedReason(krylov, &reason));
  PetscInt n_iterations = 0;
  check(KSPGetIterationNumber(krylov, &n_iterations));
  check(KSPDestroy(&krylov));
  return reason > 0 ? std::optional(unsigned(n_iterations)) : std::nullopt;
}
} // namespace

std::optional<unsigned int> solve_linear(const LinearSolver solver, const bool symmetric,
                                         const dealii::PETScWrappers::MPI::SparseMatrix& matrix,
                                         dealii::PETScWrappers::MPI::Vector& solution,
                                         const dealii::PETScWrappers::MPI::Vector& right_side, const int n_components,
                                         const double relative_tolerance)
{
  // Factors of a plane problem of this size take a fraction of a second, and conditioning is no matter.
  constexpr unsigned int few_unknowns = 20000;
  LinearSolver first = solver;
  if (solver == LinearSolver::automatic)
    first = symmetric && matrix.m() > few_unknowns ? LinearSolver::conjugate_gradients : LinearSolver::mumps;

  // The wrappers of deal.II 9.4 give the matrix out only for writing.
  const Mat petsc_matrix = matrix;
  const auto solve = [&](const LinearSolver with) {
    solution = 0.0;
    const auto n_iterations = solve_once(with, petsc_matrix, solution, right_side, n_components, relative_tolerance);
    // A singular matrix can pass for solved.
    return std::isfinite(solution.l2_norm()) ? n_iterations : std::nullopt;
  };
  auto n_iterations = solve(first);
  if (!n_iterations && solver == LinearSolver::automatic && first != LinearSolver::mumps)
    n_iterations = solve(LinearSolver::mumps);
  return n_iterations;
}
} // namespace feldspar::fem
