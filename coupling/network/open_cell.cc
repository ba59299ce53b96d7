#include "coupling/network/open_cell.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace feldspar
{
namespace
{
/// The axis whose side such an image lies behind; none behind an edge or a corner.
template <int dim>
std::optional<int> side_of(const std::array<int, dim>& boxes)
{
  std::optional<int> axis;
  for (int c = 0; c < dim; ++c)
    if (boxes[c] != 0)
      {
        if (axis || std::abs(boxes[c]) > 1)
          return std::nullopt;
        axis = c;
      }
  return axis;
}

template <int dim>
std::array<int, dim> difference(std::array<int, dim> boxes, const std::array<int, dim>& other)
{
  for (int c = 0; c < dim; ++c)
    boxes[c] -= other[c];
  return boxes;
}

/// Image that each joint over an open side holds, out of two: first those that most joints can hold.
template <int dim>
std::map<std::size_t, PeriodicImage<dim>> images_held(
  const std::map<std::size_t, std::array<PeriodicImage<dim>, 2>>& candidates)
{
  std::map<PeriodicImage<dim>, std::set<std::size_t>> waiting; // joints without an image, of each that could be theirs
  for (const auto& [joint, images] : candidates)
    for (const auto& image : images)
      waiting[image].insert(joint);
  std::map<std::size_t, PeriodicImage<dim>> held;
  while (held.size() < candidates.size())
    {
      const auto most = std::ranges::max_element(
        waiting, [](const auto& one, const auto& other) { return one.second.size() < other.second.size(); });
      const auto [image, joints] = *most;
      for (const std::size_t joint : joints)
        {
          held.emplace(joint, image);
          for (const auto& one : candidates.at(joint))
            waiting[one].erase(joint);
        }
    }
  return held;
}
} // namespace

template <int dim>
OpenCell<dim>::OpenCell(const Specimen<dim>& specimen, const Boundary& wanted)
  : boundary(wanted)
  , first_image(std::uint32_t(specimen.grains.size()))
{
  double_grains(specimen);
  if (boundary.kind != BoundaryKind::affine)
    return;
  std::set<std::uint32_t> on_sides;
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    if (const auto second = specimen.second_of(j); second.boxes != Boxes{})
      on_sides.insert(second.owner);
  held.assign(on_sides.begin(), on_sides.end());
}

template <int dim>
void OpenCell<dim>::double_grains(const Specimen<dim>& specimen)
{
  const auto& joints = specimen.joints;
  std::map<std::size_t, std::array<PeriodicImage<dim>, 2>> candidates;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const auto second = specimen.second_of(j);
      ends_of_joints.push_back({joints.grain_1[j], second.owner, second.boxes});
      if (const Boxes open = opened(second.boxes); open != Boxes{})
        candidates[j] = {PeriodicImage<dim>{second.owner, open},
                         PeriodicImage<dim>{joints.grain_1[j], difference<dim>({}, open)}};
    }
  auto images = images_held<dim>(candidates);
  std::map<PieceKey, std::set<PeriodicImage<dim>>> in_pieces;
  for (const auto& [joint, image] : images)
    in_pieces[piece_of(specimen, image)].insert(image);
  std::erase_if(images, [&](const auto& one) {
    return follows_its_grain(one.second, unsigned(in_pieces[piece_of(specimen, one.second)].size()));
  });

  std::set<PeriodicImage<dim>> all;
  for (const auto& [joint, image] : images)
    all.insert(image);
  all_images.assign(all.begin(), all.end());
  for (const auto& [joint, image] : images)
    {
      Ends& ends = ends_of_joints[joint];
      ends.boxes = difference<dim>(ends.boxes, opened(ends.boxes));
      const bool is_second = image == candidates.at(joint)[0];
      (is_second ? ends.grain_2 : ends.grain_1) = first_image + *number_of(image);
    }
}

/// Returns whether an image follows its grain. With one piece a side no image does: the boundary is minimal kinematic.
/// With more, images behind edges and corners follow their grains; so do those that have a piece for themselves: the
/// finest pieces make the periodic boundary.
template <int dim>
bool OpenCell<dim>::follows_its_grain(const PeriodicImage<dim>& image, const unsigned int n_in_its_piece) const
{
  return boundary.kind == BoundaryKind::weakly_periodic && boundary.n_pieces > 1 &&
         (!side_of<dim>(image.boxes) || n_in_its_piece == 1);
}

/// Part of the boxes over open sides only.
template <int dim>
typename OpenCell<dim>::Boxes OpenCell<dim>::opened(const Boxes& boxes) const
{
  Boxes open{};
  for (int c = 0; c < dim; ++c)
    if (boundary.opens(c))
      open[c] = boxes[c];
  return open;
}

template <int dim>
typename OpenCell<dim>::PieceKey OpenCell<dim>::piece_of(const Specimen<dim>& specimen,
                                                         const PeriodicImage<dim>& image) const
{
  const auto axis = side_of<dim>(image.boxes);
  PieceKey key{axis ? unsigned(*axis) : unsigned(dim)};
  if (!axis || boundary.kind != BoundaryKind::weakly_periodic)
    return key;
  const Vector<dim> place = at<dim>(specimen.grains.position, image.owner).cwiseQuotient(specimen.size);
  for (int c = 0; c < dim; ++c)
    if (c != *axis)
      {
        const double in_cell = place[c] - std::floor(place[c]);
        key[std::size_t(c) + 1] = std::min(unsigned(in_cell * boundary.n_pieces), boundary.n_pieces - 1);
      }
  return key;
}

template <int dim>
std::optional<std::uint32_t> OpenCell<dim>::number_of(const PeriodicImage<dim>& image) const
{
  const auto found = std::lower_bound(all_images.begin(), all_images.end(), image);
  if (found == all_images.end() || *found != image)
    return std::nullopt;
  return std::uint32_t(found - all_images.begin());
}

template <int dim>
std::optional<typename OpenCell<dim>::Ends> OpenCell<dim>::of_pair(const std::uint32_t grain_1,
                                                                   const PeriodicImage<dim>& second) const
{
  const Boxes open = opened(second.boxes);
  if (open == Boxes{})
    return Ends{grain_1, second.owner, second.boxes};
  const Boxes rest = difference<dim>(second.boxes, open);
  if (const auto image = number_of({second.owner, open}))
    return Ends{grain_1, first_image + *image, rest};
  if (const auto image = number_of({grain_1, difference<dim>({}, open)})) // the same pair, seen from the other side
    return Ends{first_image + *image, second.owner, rest};
  if (boundary.kind == BoundaryKind::weakly_periodic && boundary.n_pieces > 1)
    return Ends{grain_1, second.owner, second.boxes};
  return std::nullopt;
}

template <int dim>
BoundaryConditions<dim> OpenCell<dim>::conditions(const Specimen<dim>& specimen) const
{
  const auto& joints = specimen.joints;
  std::vector<Vector<dim>> sections(all_images.size(),
                                    Vector<dim>::Zero()); // of the joints of an image, across each axis
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (const std::uint32_t grain : {ends_of_joints[j].grain_1, ends_of_joints[j].grain_2})
      if (grain >= first_image)
        sections[grain - first_image] +=
          face_area<dim>(joints.half_length[j], specimen.thickness) * at<dim>(joints.normal, j).cwiseAbs();
  std::map<PieceKey, typename BoundaryConditions<dim>::Piece> pieces;
  for (std::uint32_t k = 0; k < all_images.size(); ++k)
    if (const auto axis = side_of<dim>(all_images[k].boxes))
      pieces[piece_of(specimen, all_images[k])].push_back(
        {first_image + k, all_images[k].owner,
         all_images[k].boxes[std::size_t(*axis)] * sections[k][Eigen::Index(*axis)]});
  std::vector<typename BoundaryConditions<dim>::Piece> all;
  for (auto& [key, piece] : pieces)
    all.push_back(std::move(piece));
  return BoundaryConditions<dim>(std::move(all), boundary.kind != BoundaryKind::edge, held);
}

template class OpenCell<2>;
template class OpenCell<3>;
} // namespace feldspar
