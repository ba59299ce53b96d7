#include "dem/lab/membrane.h"

#include "dem/flaws/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace feldspar
{
namespace
{
/// Returns whether a closed flaw lies between two points. Discs are left out: their outline is that of one section.
template <int dim>
bool are_parted(const Specimen<dim>& specimen, const Vector<dim>& one, const Vector<dim>& two)
{
  const auto in_plane = [](const Vector<dim>& point) { return Vector<2>(point[0], point[dim - 1]); };
  for (const Flaw<dim>& flaw : specimen.flaws)
    for (std::size_t k = 1; k < flaw.outline.size() && !flaw.open && flaw.name != DiscFlaw::name; ++k)
      if (cross(in_plane(one), in_plane(two), in_plane(flaw.outline[k - 1]), in_plane(flaw.outline[k])))
        return true;
  return false;
}
} // namespace

template <int dim>
LateralSurface<dim> lateral_surface(const Specimen<dim>& specimen, const std::vector<bool>& counts, const double lower,
                                    const double upper)
{
  using Across = Vector<dim - 1>; // from the axis
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  const auto& grains = specimen.grains;
  const double radius = specimen.report.mean_radius;
  const Across axis = 0.5 * specimen.size.template head<dim - 1>();
  // Rows of rays along the axis: in the plane one to the right and one to the left, in space a ring.
  const double spacing = (dim == 2 ? 0.1 : 0.4) * radius;
  const auto n_rows = std::max(std::ptrdiff_t(1), std::ptrdiff_t(std::ceil((upper - lower) / spacing)));
  const double rise = (upper - lower) / double(n_rows);
  const auto n_around = std::ptrdiff_t(dim == 2 ? 2.0 : std::ceil(2.0 * std::numbers::pi * axis.norm() / spacing));
  const double angle = 2.0 * std::numbers::pi / double(n_around);
  std::vector<Across> directions(std::size_t(n_around), Across::Zero());
  for (std::size_t k = 0; k < directions.size(); ++k)
    {
      directions[k][0] = std::cos(double(k) * angle);
      if constexpr (dim == 3)
        directions[k][1] = std::sin(double(k) * angle);
    }

  // Grains are met as if they were larger by a mean radius: what lies between two that are met is spanned.
  std::vector<double> met_at(std::size_t(n_rows * n_around), -std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> met(met_at.size(), none);
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    {
      if (!counts[i])
        continue;
      const Vector<dim> centre = at<dim>(grains.position, i);
      const Across from_axis = centre.template head<dim - 1>() - axis;
      const double reach = grains.radius[i] + radius;
      std::ptrdiff_t first = 0;
      std::ptrdiff_t last = n_around - 1;
      if constexpr (dim == 3)
        {
          if (from_axis.norm() <= reach)
            continue; // in the middle
          const double half = std::asin(reach / from_axis.norm());
          const double towards = std::atan2(from_axis[1], from_axis[0]);
          first = std::ptrdiff_t(std::ceil((towards - half) / angle));
          last = std::ptrdiff_t(std::floor((towards + half) / angle));
        }
      const double at_row = (centre[dim - 1] - lower) / rise - 0.5;
      const auto lowest = std::max(std::ptrdiff_t(0), std::ptrdiff_t(std::ceil(at_row - reach / rise)));
      const auto highest = std::min(n_rows - 1, std::ptrdiff_t(std::floor(at_row + reach / rise)));
      for (std::ptrdiff_t k = first; k <= last; ++k)
        {
          const auto column = std::size_t((k + n_around) % n_around);
          const double along = from_axis.dot(directions[column]);
          for (std::ptrdiff_t row = lowest; row <= highest; ++row)
            {
              const double height = (double(row) - at_row) * rise;
              const double half_chord_squared =
                reach * reach - (from_axis.squaredNorm() - along * along) - height * height;
              const std::size_t ray = std::size_t(row * n_around) + column;
              if (half_chord_squared > 0.0 && along + std::sqrt(half_chord_squared) > met_at[ray])
                {
                  met_at[ray] = along + std::sqrt(half_chord_squared);
                  met[ray] = i;
                }
            }
        }
    }

  // A closed flaw that comes to the side divides it there, though grains of one face stand before those of the other.
  const auto behind_flaws = [&](const std::uint32_t met_first, const Vector<dim>& touched) {
    if (!are_parted<dim>(specimen, touched, at<dim>(grains.position, met_first)))
      return met_first;
    std::uint32_t grain = met_first;
    double nearest = 6.0 * radius;
    for (std::uint32_t i = 0; i < grains.size(); ++i)
      if (const double distance = (at<dim>(grains.position, i) - touched).norm() - grains.radius[i];
          counts[i] && distance < nearest && !are_parted<dim>(specimen, touched, at<dim>(grains.position, i)))
        {
          nearest = distance;
          grain = i;
        }
    return grain;
  };

  LateralSurface<dim> surface{{}, 0.0};
  resize<dim>(surface.inward_area, grains.size());
  for (std::ptrdiff_t row = 0; row < n_rows; ++row)
    {
      std::vector<std::pair<std::uint32_t, Across>> outline; // grains, and where the membrane touches them
      for (std::size_t k = 0; k < directions.size(); ++k)
        if (const std::size_t ray = std::size_t(row * n_around) + k; met[ray] != none)
          {
            const Vector<dim> centre = at<dim>(grains.position, met[ray]);
            const double share = grains.radius[met[ray]] / (grains.radius[met[ray]] + radius);
            Vector<dim> hit;
            hit << axis + met_at[ray] * directions[k], lower + (double(row) + 0.5) * rise;
            const Vector<dim> touched = centre + share * (hit - centre);
            outline.emplace_back(behind_flaws(met[ray], touched), touched.template head<dim - 1>() - axis);
          }
      const std::size_t n = outline.size();
      for (std::size_t k = 0; k < n; ++k)
        {
          const auto& [grain, touched] = outline[k];
          Across inward = -rise * specimen.thickness * directions[k];
          if constexpr (dim == 3) // half of the way from the point before to that behind: the ring closes
            {
              const Across way = outline[(k + 1) % n].second - outline[(k + n - 1) % n].second;
              inward = 0.5 * rise * Across(-way[1], way[0]);
            }
          for (int c = 0; c < dim - 1; ++c)
            surface.inward_area[c][grain] += inward[c];
          surface.cross_section -= touched.dot(inward) / (double(dim - 1) * (upper - lower));
        }
    }
  return surface;
}

template LateralSurface<2> lateral_surface<2>(const Specimen<2>&, const std::vector<bool>&, double, double);
template LateralSurface<3> lateral_surface<3>(const Specimen<3>&, const std::vector<bool>&, double, double);
} // namespace feldspar
