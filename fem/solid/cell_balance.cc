#include "fem/solid/cell_balance.h"

#include "base/parallel.h"
#include "fem/mesh/partition.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace feldspar::fem
{
using namespace dealii;

template <int dim>
void CellBalance<dim>::place(const Discretisation<dim>& elements)
{
  const auto& trees = elements.mesh.triangulation->get_coarse_cell_to_p4est_tree_permutation();
  std::vector<std::pair<types::global_dof_index, std::uint64_t>> places;
  for (const auto& cell : elements.owned_cells())
    places.emplace_back(trees[cell->id().get_coarse_cell_id()], number_of(cell));
  along_curve.resize(places.size());
  std::iota(along_curve.begin(), along_curve.end(), std::size_t(0));
  std::ranges::sort(along_curve,
                    [&](const std::size_t one, const std::size_t other) { return places[one] < places[other]; });
  // The ranks' pieces follow each other.
  cuts.assign(1, 0);
  for (const std::size_t n : Utilities::MPI::all_gather(elements.communicator(), places.size()))
    cuts.push_back(cuts.back() + n);
  if (cuts_at_first.empty())
    cuts_at_first = cuts;
  rank_at_first.resize(places.size());
  const std::size_t begin = cuts[Utilities::MPI::this_mpi_process(elements.communicator())];
  for (std::size_t k = 0; k < along_curve.size(); ++k)
    rank_at_first[along_curve[k]] =
      static_cast<unsigned int>(std::ranges::upper_bound(cuts_at_first, begin + k) - cuts_at_first.begin() - 1);
  seconds_noted.assign(places.size(), 0.0);
}

template <int dim>
void CellBalance<dim>::note_round(const std::vector<double>& seconds)
{
  rounds.push_back(0.0);
  const std::size_t begin = rounds_at_first.size();
  rounds_at_first.resize(begin + cuts.size() - 1, 0.0);
  for (std::size_t cell = 0; cell < seconds.size(); ++cell)
    {
      const double in_round = seconds[cell] - seconds_noted[cell];
      rounds.back() += in_round;
      rounds_at_first[begin + rank_at_first[cell]] += in_round;
    }
  seconds_noted = seconds;
}

template <int dim>
auto CellBalance<dim>::strike(const MPI_Comm communicator) -> Verdict
{
  const std::size_t n_ranks = cuts.size() - 1;
  Verdict verdict;
  Balance& balance = verdict.balance;
  balance.mean =
    Utilities::MPI::sum(std::accumulate(rounds.begin(), rounds.end(), 0.0), communicator) / double(n_ranks);
  std::vector<double> longest_of_rounds(rounds.size());
  Utilities::MPI::max(rounds, communicator, longest_of_rounds);
  balance.longest = std::accumulate(longest_of_rounds.begin(), longest_of_rounds.end(), 0.0);
  std::vector<double> of_ranks(rounds_at_first.size());
  Utilities::MPI::sum(rounds_at_first, communicator, of_ranks);
  for (auto round = of_ranks.begin(); round != of_ranks.end(); round += std::ptrdiff_t(n_ranks))
    balance.longest_unmoved += *std::max_element(round, round + std::ptrdiff_t(n_ranks));
  rounds.clear();
  rounds_at_first.clear();

  const std::size_t first = cuts[Utilities::MPI::this_mpi_process(communicator)];
  std::vector<double> everywhere(cuts.back());
  for (std::size_t k = 0; k < along_curve.size(); ++k)
    everywhere[first + k] = seconds_noted[along_curve[k]];
  Utilities::MPI::sum(everywhere, communicator, everywhere);
  const auto weights = partition_weights(everywhere, n_ranks);
  const double longest = longest_share(everywhere, cuts);
  const double attainable = longest_share(everywhere, partition_cuts(weights, n_ranks));
  const auto n_threads = double(number_of_threads());
  // Cells move once the time lost to imbalance equals the cost of a move (ski-rental rule).
  constexpr double worth_while = 0.9;
  const bool pays = attainable < worth_while * longest && (longest - attainable) / n_threads > cost_of_moving;
  balance.moved = Utilities::MPI::max(int(pays), communicator) == 1;
  if (balance.moved)
    {
      verdict.weights.resize(along_curve.size());
      for (std::size_t k = 0; k < along_curve.size(); ++k)
        verdict.weights[along_curve[k]] = weights[first + k];
    }
  return verdict;
}

template class CellBalance<2>;
template class CellBalance<3>;
} // namespace feldspar::fem
