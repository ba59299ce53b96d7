#include "dem/lab/membrane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace feldspar
{
LateralSurface lateral_surface(const Specimen<3>& specimen, const double lower, const double upper)
{
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  const auto& grains = specimen.grains;
  // A raster on the side, some cells to a radius.
  const double cell = 0.4 * specimen.report.mean_radius;
  const double side_radius = 0.5 * specimen.size[0];
  const auto n_around = std::size_t(std::ceil(2.0 * std::numbers::pi * side_radius / cell));
  const auto n_along = std::max(std::size_t(1), std::size_t(std::ceil((upper - lower) / cell)));
  const double angle = 2.0 * std::numbers::pi / double(n_around);
  const double rise = (upper - lower) / double(n_along);
  std::vector<double> met_at(n_around * n_along, 0.0); // distance of the surface from the axis
  std::vector<std::uint32_t> met(n_around * n_along, none);
  std::vector<double> nearest_distance(n_around * n_along, std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> nearest(n_around * n_along, none);

  for (std::uint32_t i = 0; i < grains.size(); ++i)
    {
      const double x = grains.position[0][i] - 0.5 * specimen.size[0];
      const double y = grains.position[1][i] - 0.5 * specimen.size[1];
      const double z = grains.position[2][i];
      const double radius = grains.radius[i];
      const double from_axis = std::hypot(x, y);
      // Only the outer grains; a void in the side is no deeper than a grain or two.
      if (from_axis + radius < side_radius - 4.0 * specimen.report.mean_radius || from_axis <= radius)
        continue;
      const double at = std::atan2(y, x);
      // Reach of the shadow, widened by a radius for the voids.
      const double reach = 2.0 * radius;
      const auto half_around = std::ptrdiff_t(std::ceil(reach / from_axis / angle));
      const auto middle = std::ptrdiff_t(std::floor(at / angle));
      const auto first_row = std::ptrdiff_t(std::floor((z - reach - lower) / rise));
      const auto last_row = std::ptrdiff_t(std::ceil((z + reach - lower) / rise));
      for (std::ptrdiff_t row = std::max(std::ptrdiff_t(0), first_row);
           row <= std::min(last_row, std::ptrdiff_t(n_along) - 1); ++row)
        for (std::ptrdiff_t k = middle - half_around; k <= middle + half_around; ++k)
          {
            const auto column = std::size_t((k % std::ptrdiff_t(n_around) + std::ptrdiff_t(n_around))) % n_around;
            const std::size_t c = std::size_t(row) * n_around + column;
            const double ray = (double(k) + 0.5) * angle;
            const double along = x * std::cos(ray) + y * std::sin(ray);
            const double across = -x * std::sin(ray) + y * std::cos(ray);
            const double height = lower + (double(row) + 0.5) * rise - z;
            const double miss_squared = across * across + height * height;
            if (along <= 0.0)
              continue;
            if (miss_squared < radius * radius)
              {
                const double surface = along + std::sqrt(radius * radius - miss_squared);
                if (surface > met_at[c])
                  {
                    met_at[c] = surface;
                    met[c] = i;
                  }
              }
            const double distance = std::sqrt(miss_squared) - radius + (side_radius - along - radius);
            if (distance < nearest_distance[c])
              {
                nearest_distance[c] = distance;
                nearest[c] = i;
              }
          }
    }

  LateralSurface surface;
  resize<3>(surface.inward_area, grains.size());
  double squares = 0.0;
  double n_met = 0.0;
  for (std::size_t row = 0; row < n_along; ++row)
    for (std::size_t column = 0; column < n_around; ++column)
      {
        const std::size_t c = row * n_around + column;
        // A ray that met a grain far inside has gone through a void; the membrane spans it.
        const bool spanned = met[c] == none || (nearest[c] != none && nearest[c] != met[c] &&
                                                met_at[c] < side_radius - 2.0 * specimen.report.mean_radius);
        const std::uint32_t i = spanned ? nearest[c] : met[c];
        if (i == none)
          continue;
        const double x = grains.position[0][i] - 0.5 * specimen.size[0];
        const double y = grains.position[1][i] - 0.5 * specimen.size[1];
        const double distance = spanned ? std::hypot(x, y) + grains.radius[i] : met_at[c];
        const double ray = (double(column) + 0.5) * angle;
        const double area = distance * angle * rise;
        surface.inward_area[0][i] -= area * std::cos(ray);
        surface.inward_area[1][i] -= area * std::sin(ray);
        squares += distance * distance;
        ++n_met;
      }
  surface.cross_section = n_met > 0.0 ? std::numbers::pi * squares / n_met : 0.0;
  return surface;
}
} // namespace feldspar
