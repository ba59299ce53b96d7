#pragma once

#include "fem/solid/kinematics.h"
#include "fem/solid/linear_solver.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// Outcome of a solve.
struct NewtonReport
{
  bool converged = false;
  std::string failure;           ///< why not; empty if it converged
  unsigned int n_iterations = 0; ///< linear systems solved
  unsigned int n_cascades = 0;   ///< times that points changed their structure and equilibrium was sought anew
  std::uint64_t n_events = 0;    ///< of all points and cascades
  std::vector<double> residuals; ///< unbalanced over internal force, before each iteration and at the end
};

struct SolidParameters
{
  Kinematics kinematics = Kinematics::plane;
  unsigned int order = 1;          ///< of the shape functions, 1 or 2
  bool reduced_quadrature = false; ///< order instead of order + 1 points a direction; order 2 only
  LinearSolver linear_solver = LinearSolver::automatic;
  double linear_tolerance = 1e-12;   ///< residual over right side; that of a moved boundary is large beside the forces
  double newton_tolerance = 1e-9;    ///< unbalanced over internal force, both as Euclidean norms
  unsigned int most_iterations = 15; ///< between two cascades
  unsigned int most_cascades = 1000;
  std::uint64_t most_events = std::numeric_limits<std::uint64_t>::max(); ///< in one solve
  /// Called after each iteration and cascade, on every rank. An exception of it ends the solve; the accepted state
  /// stays.
  std::function<void(const NewtonReport&)> watch = [](const NewtonReport&) {};
  /// Called before each point, by any thread of any rank: a round over the points of a large sample takes long. Where
  /// it returns true, or a point throws GivenUp, the round is left and `watch` called on every rank, which is to throw.
  /// Empty: never.
  std::function<bool()> gives_up = {};
};
} // namespace feldspar::fem
