#pragma once

#include "fem/solid/discretisation.h"

#include <cstddef>
#include <vector>

namespace feldspar::fem
{
/// Time that ranks worked in their points since the last balance was struck, on one core each [s].
struct Balance
{
  double mean = 0.0;
  double longest = 0.0;         ///< sum of the longest of each round, for which the others wait
  double longest_unmoved = 0.0; ///< the same had the cells never moved
  bool moved = false;           ///< now
};

/// Records the rounds of time that ranks spend in their cells, and decides when it pays to distribute the cells anew.
///
/// A round: every rank asks each of its points for something, and waits for the others. p4est cuts the curve through all
/// cells into pieces, one a rank.
template <int dim>
class CellBalance
{
public:
  /// The cells of this rank as they lie now, no time noted. Collective.
  void place(const Discretisation<dim>& elements);

  /// The time of each cell of this rank since it came here [s].
  void note_round(const std::vector<double>& seconds);

  struct Verdict
  {
    Balance balance;                   ///< moved: the cells should be
    std::vector<unsigned int> weights; ///< of the cells of this rank, as repartition() takes them; empty if not moved
  };
  /// Verdict on the rounds since the last one. Collective.
  Verdict strike(MPI_Comm communicator);

  /// Records how long it took to move cells [s].
  void note_move(const double seconds) { cost_of_moving = seconds; }

private:
  std::vector<std::size_t> cuts;           ///< as partition_cuts() tells them
  std::vector<std::size_t> cuts_at_first;  ///< before any cell moved
  std::vector<std::size_t> along_curve;    ///< the cells of this rank in its order
  std::vector<unsigned int> rank_at_first; ///< of each cell of this rank
  double cost_of_moving = 0.01;            ///< the last time, at first a guess [s]
  /// Times since the last balance that all points of this rank took in each round, and thereof those of each rank's
  /// first cells [s].
  std::vector<double> rounds;
  std::vector<double> rounds_at_first;
  std::vector<double> seconds_noted; ///< of each cell of this rank, up to the last round
};
} // namespace feldspar::fem
