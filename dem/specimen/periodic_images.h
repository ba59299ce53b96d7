#pragma once

#include "dem/storage/grains.h"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

/// A periodic body repeats itself in every direction over its box, the cell. Where grains near opposite sides meet, one of them is
/// stood in for by its image in a neighbouring box, which moves with the grain it belongs to.
namespace feldspar
{
template <int dim>
struct PeriodicImage
{
  std::uint32_t owner;
  std::array<int, dim> boxes; ///< how many boxes away, along each axis

  bool operator==(const PeriodicImage&) const = default;
  bool operator<(const PeriodicImage& other) const
  {
    return std::tie(owner, boxes) < std::tie(other.owner, other.boxes);
  }
};

/// Displacement of an image from its owner [m]; the columns of `cell` are the edges of the box.
template <int dim>
Vector<dim> shift(const PeriodicImage<dim>& image, const Tensor<dim>& cell)
{
  Vector<dim> way = Vector<dim>::Zero();
  for (int c = 0; c < dim; ++c)
    way += image.boxes[c] * cell.col(c);
  return way;
}

/// All images that could come within `reach` [m] of the surface of a grain, in ascending order.
template <int dim>
std::vector<PeriodicImage<dim>> images_within(const Grains<dim>& grains, const Tensor<dim>& cell, double reach);

/// The grains with images behind them.
template <int dim>
Grains<dim> with_images(const Grains<dim>& grains, const std::vector<PeriodicImage<dim>>& images,
                        const Tensor<dim>& cell);

/// Returns whether this contact is the one of its kind that counts: the same pair occurs once for each of its two
/// grains. `owner_1`, a grain of the box itself, is in contact with owner_2 displaced by so many boxes.
template <int dim>
bool counts(const std::uint32_t owner_1, const PeriodicImage<dim>& second)
{
  return owner_1 != second.owner ? owner_1 < second.owner : second.boxes > std::array<int, dim>{};
}
} // namespace feldspar
