#include "coupling/network/stiffness_pattern.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <iterator>
#include <utility>

namespace feldspar
{
namespace
{
/// The place of each grain.
template <int dim>
std::vector<std::uint32_t> ordered_for_little_fill(const std::vector<Link<dim>>& links, const std::size_t n_grains,
                                                   const std::function<bool(std::uint32_t)>& has_stiffness)
{
  std::vector<Eigen::Triplet<double>> neighbours;
  for (std::uint32_t k = 0; k < links.size(); ++k)
    if (has_stiffness(k))
      {
        neighbours.emplace_back(int(links[k].grain_1), int(links[k].grain_2), 1.0);
        neighbours.emplace_back(int(links[k].grain_2), int(links[k].grain_1), 1.0);
      }
  for (std::size_t i = 0; i < n_grains; ++i)
    neighbours.emplace_back(int(i), int(i), 1.0);
  Eigen::SparseMatrix<double> graph{Eigen::Index(n_grains), Eigen::Index(n_grains)};
  graph.setFromTriplets(neighbours.begin(), neighbours.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  std::vector<std::uint32_t> places(n_grains);
  for (std::size_t k = 0; k < n_grains; ++k)
    places[std::size_t(order.indices()[Eigen::Index(k)])] = std::uint32_t(k);
  return places;
}
} // namespace

template <int dim>
StiffnessPattern::StiffnessPattern(const std::vector<Link<dim>>& links, const std::size_t n_grains,
                                   const std::function<bool(std::uint32_t)>& has_stiffness)
  : places(ordered_for_little_fill(links, n_grains, has_stiffness))
{
  std::vector<std::vector<std::uint32_t>> neighbours(n_grains); // of each column, in rows below it
  for (std::uint32_t k = 0; k < links.size(); ++k)
    if (has_stiffness(k) && links[k].grain_1 != links[k].grain_2)
      {
        const auto [column, row] = std::minmax({places[links[k].grain_1], places[links[k].grain_2]});
        neighbours[column].push_back(row);
      }
  find_fill(std::move(neighbours));
  find_supernodes();
}

/// Eliminating a grain couples all the later ones that it is coupled with; it is enough to hand them on to the first of these.
void StiffnessPattern::find_fill(std::vector<std::vector<std::uint32_t>> columns)
{
  const std::size_t n = columns.size();
  first_blocks.push_back(0);
  for (std::size_t c = 0; c < n; ++c)
    {
      auto& column = columns[c];
      std::ranges::sort(column);
      column.erase(std::unique(column.begin(), column.end()), column.end());
      if (column.size() > 1)
        columns[column.front()].insert(columns[column.front()].end(), std::next(column.begin()), column.end());
      rows.insert(rows.end(), column.begin(), column.end());
      first_blocks.push_back(std::uint32_t(rows.size()));
    }
}

void StiffnessPattern::find_supernodes()
{
  for (std::uint32_t c = 0; c < places.size(); ++c)
    {
      const auto goes_on = [&] {
        const std::uint32_t before = first_blocks[c - 1], own = first_blocks[c], next = first_blocks[c + 1];
        return c - first_columns.back() < most_columns && own - before == next - own + 1 && rows[before] == c;
      };
      if (c == 0 || !goes_on())
        first_columns.push_back(c);
      supernodes.push_back(std::uint32_t(first_columns.size() - 1));
    }
  first_columns.push_back(std::uint32_t(places.size()));
}

std::uint32_t StiffnessPattern::block_at(const std::uint32_t row, const std::uint32_t column) const
{
  const auto begin = rows.begin() + first_blocks[column];
  const auto end = rows.begin() + first_blocks[column + 1];
  return std::uint32_t(std::lower_bound(begin, end, row) - rows.begin());
}

template StiffnessPattern::StiffnessPattern(const std::vector<Link<2>>&, std::size_t,
                                            const std::function<bool(std::uint32_t)>&);
template StiffnessPattern::StiffnessPattern(const std::vector<Link<3>>&, std::size_t,
                                            const std::function<bool(std::uint32_t)>&);
} // namespace feldspar
