#include "dem/minerals/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace feldspar
{
namespace
{
/// Points keep this share of the mean size between them, so that none makes a splinter of a cell. Thrown in one after the
/// other they would fill the space by themselves at some 0.74 in the plane and 0.73 in space (random sequential adsorption
/// of discs and balls: 0.547 and 0.384 of the volume).
constexpr double least_distance = 0.65;

/// The shortest way from one point to another, across the sides of a periodic body too.
template <int dim>
Vector<dim> way_between(const Specimen<dim>& specimen, const Vector<dim>& from, const Vector<dim>& to)
{
  Vector<dim> way = to - from;
  for (int c = 0; c < dim; ++c)
    if (specimen.repeats(c))
      way[c] -= specimen.size[c] * std::round(way[c] / specimen.size[c]);
  return way;
}

/// Distances along the length of a cell count less than those across, so that its volume stays; over its size.
template <int dim>
Tensor<dim> metric_of(const CellKind& kind, Random& random)
{
  if (kind.aspect_ratio == 1.0)
    return Tensor<dim>::Identity() / kind.size;
  Vector<dim> length = Vector<dim>::Zero();
  length[0] = kind.angle ? std::cos(*kind.angle) : random.normal(0.0, 1.0);
  length[dim - 1] = kind.angle ? std::sin(*kind.angle) : random.normal(0.0, 1.0);
  if (dim == 3 && !kind.angle)
    length[1] = random.normal(0.0, 1.0);
  length.normalize();
  const double across = std::pow(kind.aspect_ratio, 1.0 / dim);
  return across / kind.size * (Tensor<dim>::Identity() + (1.0 / kind.aspect_ratio - 1.0) * length * length.transpose());
}

/// Number of cells of a kind; throws InputError where there is none, or where they are too small for grains.
template <int dim>
std::size_t number_of_cells(const Specimen<dim>& specimen, const CellKind& kind, const bool is_alone,
                            const ParameterId& size)
{
  const double volume = kind.share * specimen.size.prod();
  const double unit_cell = dim == 2 ? 0.25 * std::numbers::pi : std::numbers::pi / 6.0; // of mean size 1
  const auto n = std::size_t(std::llround(volume / (unit_cell * std::pow(kind.size, dim))));
  const std::size_t least_number = is_alone ? 2 : 1;
  const double least = 4.0 * specimen.report.mean_radius;
  const auto refuse = [&](const std::string& why) {
    throw ParameterError(size, fmt::format("{:g} mm{}{}", 1e3 * kind.size, kind.of.empty() ? "" : " of ", kind.of),
                         why);
  };
  if (n < least_number)
    {
      // 1.5 cells are rounded to two; a little smaller, so that no rounding of the message names a size that is refused.
      const double most = 0.995 * std::pow(volume / ((double(least_number) - 0.5) * unit_cell), 1.0 / dim);
      if (most < least)
        refuse(fmt::format("this specimen is too small for {} {}{} of two mean diameters of its particles, {:.3g} mm",
                           is_alone ? "two" : "one", kind.name, is_alone ? "s" : "", 1e3 * least));
      refuse(fmt::format(
        "must be at most {:.3g} mm in this specimen, which would have {} {}(s), and at least {:.3g} mm, two mean diameters of its particles",
        1e3 * most, n, kind.name, 1e3 * least));
    }
  if (kind.size < least)
    refuse(fmt::format("must be at least two mean diameters of the particles that make up a {}, {:.3g} mm", kind.name,
                       1e3 * least));
  return n;
}
} // namespace

template <int dim>
std::vector<Cell<dim>> throw_cells(const Specimen<dim>& specimen, const std::vector<CellKind>& kinds,
                                   const RandomStream stream, const ParameterId& size)
{
  std::vector<std::size_t> kind_of;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    kind_of.insert(kind_of.end(), number_of_cells(specimen, kinds[k], kinds.size() == 1, size), k);
  Random further(specimen.seed, RandomStream::kinds_of_cells);
  further.shuffle(kind_of);
  std::ranges::stable_sort(kind_of, std::greater(), [&](const std::size_t kind) { return kinds[kind].size; });
  Random random(specimen.seed, stream);
  std::vector<Cell<dim>> cells;
  while (cells.size() < kind_of.size())
    {
      const std::size_t kind = kind_of[cells.size()];
      Vector<dim> centre;
      for (int c = 0; c < dim; ++c)
        centre[c] = random.uniform(0.0, specimen.size[c]);
      if (std::none_of(cells.begin(), cells.end(), [&](const Cell<dim>& other) {
            const double apart = least_distance * 0.5 * (kinds[kind].size + kinds[other.kind].size);
            return way_between(specimen, other.centre, centre).squaredNorm() < apart * apart;
          }))
        cells.push_back({centre, kind, metric_of<dim>(kinds[kind], further)});
    }
  return cells;
}

template <int dim>
std::vector<std::uint32_t> cells_of_grains(const Specimen<dim>& specimen, const std::vector<Cell<dim>>& cells)
{
  std::vector<std::uint32_t> cell_of(specimen.grains.size());
  for (std::size_t i = 0; i < cell_of.size(); ++i)
    {
      const Vector<dim> point = at<dim>(specimen.grains.position, i);
      double least = std::numeric_limits<double>::infinity();
      for (std::uint32_t k = 0; k < cells.size(); ++k)
        {
          const double distance = (cells[k].metric * way_between(specimen, cells[k].centre, point)).squaredNorm();
          if (distance < least)
            {
              least = distance;
              cell_of[i] = k;
            }
        }
    }
  return cell_of;
}

template decltype(throw_cells<2>) throw_cells<2>;
template decltype(throw_cells<3>) throw_cells<3>;
template std::vector<std::uint32_t> cells_of_grains<2>(const Specimen<2>&, const std::vector<Cell<2>>&);
template std::vector<std::uint32_t> cells_of_grains<3>(const Specimen<3>&, const std::vector<Cell<3>>&);
} // namespace feldspar
