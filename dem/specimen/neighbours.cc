#include "dem/specimen/neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace feldspar
{
namespace
{
/// Cells no smaller than the reach of the search, so that partners lie in adjacent cells.
template <int dim>
struct CellGrid
{
  Vector<dim> corner;
  double cell_size;
  std::array<std::size_t, dim> n_cells;
  std::vector<std::uint32_t> first;  ///< of each cell in `grains`, [n cells + 1]
  std::vector<std::uint32_t> grains; ///< sorted by cell, ascending within

  CellGrid(const Grains<dim>& all, const double wanted_cell_size)
    : corner(Vector<dim>::Zero())
    , cell_size(wanted_cell_size)
  {
    Vector<dim> top;
    for (int c = 0; c < dim; ++c)
      {
        const auto [low, high] = std::ranges::minmax_element(all.position[c]);
        corner[c] = *low;
        top[c] = *high;
      }
    // A far stray grain must not ask for endless cells.
    const double most_cells = 4.0 * double(all.size()) + 64.0;
    const auto cells_needed = [&] {
      double product = 1.0;
      for (int c = 0; c < dim; ++c)
        product *= std::floor((top[c] - corner[c]) / cell_size) + 1.0;
      return product;
    };
    while (cells_needed() > most_cells)
      cell_size *= 1.5;

    std::size_t n = 1;
    for (int c = 0; c < dim; ++c)
      {
        n_cells[c] = std::size_t((top[c] - corner[c]) / cell_size) + 1;
        n *= n_cells[c];
      }
    std::vector<std::uint32_t> cell_of(all.size());
    first.assign(n + 1, 0);
    for (std::size_t i = 0; i < all.size(); ++i)
      {
        cell_of[i] = std::uint32_t(index(coordinates(at<dim>(all.position, i))));
        ++first[cell_of[i] + 1];
      }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    grains.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      grains[next[cell_of[i]]++] = std::uint32_t(i);
  }

  std::array<std::size_t, dim> coordinates(const Vector<dim>& point) const
  {
    std::array<std::size_t, dim> cell;
    for (int c = 0; c < dim; ++c)
      cell[c] = std::min(n_cells[c] - 1, std::size_t((point[c] - corner[c]) / cell_size));
    return cell;
  }

  std::size_t index(const std::array<std::size_t, dim>& cell) const
  {
    std::size_t i = cell[dim - 1];
    for (int c = dim - 2; c >= 0; --c)
      i = i * n_cells[c] + cell[c];
    return i;
  }

  /// Calls visit(index) for a cell and those around it.
  template <typename Visitor>
  void around(const std::array<std::size_t, dim>& cell, Visitor&& visit) const
  {
    const int n_neighbours = dim == 2 ? 9 : 27;
    for (int k = 0; k < n_neighbours; ++k)
      {
        std::array<std::size_t, dim> other;
        bool inside = true;
        for (int c = 0, rest = k; c < dim; ++c, rest /= 3)
          {
            const std::ptrdiff_t shifted = std::ptrdiff_t(cell[c]) + rest % 3 - 1;
            inside = inside && shifted >= 0 && shifted < std::ptrdiff_t(n_cells[c]);
            other[c] = std::size_t(shifted);
          }
        if (inside)
          visit(index(other));
      }
  }
};

template <int dim, typename Visitor>
void visit_pairs(const Grains<dim>& grains, const double largest_gap, Visitor&& visit,
                 const std::function<void()>& check)
{
  constexpr std::size_t grains_between_checks = 10000; // some milliseconds
  if (grains.size() < 2)
    return;
  const double largest_radius = *std::ranges::max_element(grains.radius);
  const CellGrid<dim> grid(grains, 2.0 * largest_radius + largest_gap);
  std::vector<std::uint32_t> partners;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      if (i % grains_between_checks == 0)
        check();
      const Vector<dim> centre = at<dim>(grains.position, i);
      partners.clear();
      grid.around(grid.coordinates(centre), [&](const std::size_t cell) {
        for (std::uint32_t k = grid.first[cell]; k < grid.first[cell + 1]; ++k)
          {
            const std::uint32_t other = grid.grains[k];
            const double reach = grains.radius[i] + grains.radius[other] + largest_gap;
            if (other > i && (at<dim>(grains.position, other) - centre).squaredNorm() < reach * reach)
              partners.push_back(other);
          }
      });
      std::ranges::sort(partners);
      for (const std::uint32_t other : partners)
        visit(GrainPair(std::uint32_t(i), other));
    }
}
} // namespace

template <int dim>
std::vector<GrainPair> pairs_within(const Grains<dim>& grains, const double largest_gap,
                                    const std::function<void()>& check)
{
  std::vector<GrainPair> pairs;
  visit_pairs(
    grains, largest_gap, [&](const GrainPair& pair) { pairs.push_back(pair); }, check);
  return pairs;
}

template <int dim>
void for_each_pair_within(const Grains<dim>& grains, const double largest_gap,
                          const std::function<void(const GrainPair&)>& visit, const std::function<void()>& check)
{
  visit_pairs(grains, largest_gap, visit, check);
}

template <int dim>
std::vector<std::uint32_t> spatial_order(const Grains<dim>& grains)
{
  const double cell_size = 4.0 * grains.mean_radius();
  Vector<dim> corner;
  for (int c = 0; c < dim; ++c)
    corner[c] = *std::ranges::min_element(grains.position[c]);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> key(grains.size());
  constexpr int n_bits = 63 / dim;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      std::uint64_t code = 0;
      for (int c = 0; c < dim; ++c)
        {
          const auto cell = std::uint64_t((grains.position[c][i] - corner[c]) / cell_size);
          for (int bit = 0; bit < n_bits; ++bit)
            code |= (cell >> bit & 1u) << (bit * dim + c);
        }
      key[i] = {code, std::uint32_t(i)};
    }
  std::ranges::sort(key);
  std::vector<std::uint32_t> order(grains.size());
  std::ranges::transform(key, order.begin(), [](const auto& entry) { return entry.second; });
  return order;
}

template decltype(pairs_within<2>) pairs_within<2>;
template decltype(pairs_within<3>) pairs_within<3>;
template decltype(for_each_pair_within<2>) for_each_pair_within<2>;
template decltype(for_each_pair_within<3>) for_each_pair_within<3>;
template decltype(spatial_order<2>) spatial_order<2>;
template decltype(spatial_order<3>) spatial_order<3>;
} // namespace feldspar
