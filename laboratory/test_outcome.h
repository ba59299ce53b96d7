#pragma once

#include "laboratory/appearance.h"
#include "laboratory/record.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace feldspar
{
/// The search of an equilibrium of a sample that was accepted as a step.
struct SolverStep
{
  std::uint64_t step = 0;         ///< from 1
  double axial_strain = 0.0;      ///< tension positive, from seating
  std::uint64_t n_iterations = 0; ///< of Newton's method
  std::uint64_t n_cascades = 0;   ///< times that something broke and equilibrium was sought anew
  std::uint64_t n_cuts = 0;       ///< searches before it that were given up, each then cut or repeated
  double residual = 0.0;          ///< unbalanced over internal force at its end
};

/// The effort of finding the equilibria of a sample of finite elements, steps that were given up included.
struct SolverWork
{
  std::uint64_t n_solves = 0;
  std::uint64_t n_iterations = 0; ///< of Newton's method
  std::uint64_t n_cascades = 0;   ///< times that something broke and equilibrium was sought anew
  double seconds_in_points = 0.0; ///< of one core
  std::vector<SolverStep> steps = {};
};

/// Balance of the work of the processes (ranks) of a test in the representative volumes of its points; even if the
/// longest is as long as the mean.
struct RankBalance
{
  double mean = 0.0;            ///< of one rank on one core, up to the last step [s]
  double longest = 0.0;         ///< sum over the rounds in which all wait for the longest [s]
  double longest_unmoved = 0.0; ///< the same had no point moved to another rank
  unsigned int n_moves = 0;     ///< times that points were distributed anew
};

/// The effort of a test: of no meaning for the rock.
struct RunBookkeeping
{
  std::uint64_t steps = 0;
  /// Steps of the loading at the rate of the laboratory; NaN where none was wanted.
  double steps_at_laboratory_rate = std::numeric_limits<double>::quiet_NaN();
  double time_step = 0.0;                                             ///< the last one; NaN where there is no time [s]
  double wall_time = 0.0;                                             ///< [s]
  double largest_residual = std::numeric_limits<double>::quiet_NaN(); ///< of the steps of a sample; NaN without
  RankBalance ranks;
  std::optional<SolverWork> solver_work;
};

/// All that a test leaves behind, by the use that is made of it.
struct TestOutcome
{
  TestRecord record;          ///< the measurement: figures are read off it, and off nothing else
  TestAppearance appearance;  ///< for pictures
  RunBookkeeping bookkeeping; ///< for who cares how long it took
};
} // namespace feldspar
