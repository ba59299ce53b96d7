#include "dem/specimen/periodic_images.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace feldspar
{
template <int dim>
std::vector<PeriodicImage<dim>> images_within(const Grains<dim>& grains, const Tensor<dim>& cell, const double reach)
{
  std::vector<PeriodicImage<dim>> images;
  if (grains.size() == 0)
    return images;
  // Lengths are in units of the cell's edges, where the box is a cube; a sphere of radius 1 is so wide there.
  const Tensor<dim> to_cell = cell.inverse();
  const Vector<dim> width = to_cell.rowwise().norm();
  std::vector<Vector<dim>> place;
  Vector<dim> low = to_cell * at<dim>(grains.position, 0);
  Vector<dim> high = low;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      place.push_back(to_cell * at<dim>(grains.position, i));
      low = low.cwiseMin(place.back());
      high = high.cwiseMax(place.back());
    }
  const double largest_radius = *std::ranges::max_element(grains.radius);
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    {
      const Vector<dim> margin = (grains.radius[i] + largest_radius + reach) * width;
      std::array<int, dim> first, last;
      for (int c = 0; c < dim; ++c)
        {
          first[c] = int(std::ceil(low[c] - margin[c] - place[i][c]));
          last[c] = int(std::floor(high[c] + margin[c] - place[i][c]));
        }
      std::array<int, dim> boxes = first;
      for (bool more = true; more;)
        {
          if (boxes != std::array<int, dim>{})
            images.push_back({i, boxes});
          more = false;
          for (int c = dim - 1; c >= 0 && !more; --c)
            {
              more = boxes[c] < last[c];
              boxes[c] = more ? boxes[c] + 1 : first[c];
            }
        }
    }
  return images;
}

template <int dim>
Grains<dim> with_images(const Grains<dim>& grains, const std::vector<PeriodicImage<dim>>& images,
                        const Tensor<dim>& cell)
{
  std::vector<double> radii = grains.radius;
  Components<dim> positions = grains.position;
  for (const auto& image : images)
    {
      radii.push_back(grains.radius[image.owner]);
      const Vector<dim> way = shift(image, cell);
      for (int c = 0; c < dim; ++c)
        positions[c].push_back(grains.position[c][image.owner] + way[c]);
    }
  Grains<dim> all;
  all.place(radii, positions);
  return all;
}

template std::vector<PeriodicImage<2>> images_within<2>(const Grains<2>&, const Tensor<2>&, double);
template Grains<2> with_images<2>(const Grains<2>&, const std::vector<PeriodicImage<2>>&, const Tensor<2>&);
template std::vector<PeriodicImage<3>> images_within<3>(const Grains<3>&, const Tensor<3>&, double);
template Grains<3> with_images<3>(const Grains<3>&, const std::vector<PeriodicImage<3>>&, const Tensor<3>&);
} // namespace feldspar
