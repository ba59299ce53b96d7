#pragma once

#include "coupling/network/boundary.h"
#include "coupling/network/boundary_conditions.h"
#include "dem/specimen/specimen.h"

#include <array>
#include <optional>
#include <vector>

namespace feldspar
{
/// A periodic specimen cut open along the sides that its boundary opens. The cut goes through grains: of each joint
/// that leads over such a side one grain is there twice, as itself and as an image on the other side, and the joint
/// holds the image. No joint is lost, so that the body has the volume of the cell. The grain of a joint that has more
/// such joints is doubled: an image then hangs on several.
template <int dim>
class OpenCell
{
public:
  OpenCell(const Specimen<dim>& specimen, const Boundary& boundary);

  /// Images, numbered behind the grains.
  const std::vector<PeriodicImage<dim>>& images() const { return all_images; }

  /// Ends of a link; `boxes` from grain 1 to the image of grain 2 over sides that are not open.
  struct Ends
  {
    std::uint32_t grain_1, grain_2;
    std::array<int, dim> boxes;
  };
  const Ends& of_joint(const std::size_t joint) const { return ends_of_joints[joint]; }
  /// Ends of a pair without a joint, from a grain to an image; none where an open side lies between.
  std::optional<Ends> of_pair(std::uint32_t grain_1, const PeriodicImage<dim>& second) const;

  /// A traction on each piece of each open side. The shares of its pairs are those of the sections of the joints of their
  /// images, across the side.
  BoundaryConditions<dim> conditions(const Specimen<dim>& specimen) const;

private:
  using Boxes = std::array<int, dim>;
  using PieceKey = std::array<unsigned int, dim + 1>; ///< axis, then the place on the side

  void double_grains(const Specimen<dim>& specimen);
  Boxes opened(const Boxes& boxes) const;
  bool follows_its_grain(const PeriodicImage<dim>& image, unsigned int n_in_its_piece) const;
  PieceKey piece_of(const Specimen<dim>& specimen, const PeriodicImage<dim>& image) const;
  std::optional<std::uint32_t> number_of(const PeriodicImage<dim>& image) const;

  Boundary boundary;
  std::uint32_t first_image;                  ///< number of the first, behind the grains
  std::vector<PeriodicImage<dim>> all_images; ///< ascending
  std::vector<Ends> ends_of_joints;
  std::vector<std::uint32_t> held; ///< ascending
};
} // namespace feldspar
