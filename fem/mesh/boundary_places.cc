#include "fem/mesh/sample_mesh.h"

#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/grid_tools.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
/// A side of a cell on the outside of the mesh.
template <int dim>
struct OuterSide
{
  std::vector<Point<dim>> corners;
  Point<dim> centre;
  Tensor<1, dim> normal; ///< of unit length, outwards
  types::boundary_id boundary;
};

template <int dim>
std::vector<OuterSide<dim>> outer_sides(const Triangulation<dim>& mesh)
{
  std::vector<OuterSide<dim>> sides;
  for (const auto& cell : mesh.cell_iterators_on_level(0)) // every rank knows those
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary())
        {
          OuterSide<dim> side{{}, face->center(), {}, face->boundary_id()};
          for (const unsigned int v : face->vertex_indices())
            side.corners.push_back(face->vertex(v));
          if constexpr (dim == 2)
            side.normal = cross_product_2d(side.corners[1] - side.corners[0]);
          else
            side.normal = cross_product_3d(side.corners[3] - side.corners[0], side.corners[2] - side.corners[1]);
          side.normal *= (side.normal * (face->center() - cell->center()) < 0.0 ? -1.0 : 1.0) / side.normal.norm();
          sides.push_back(side);
        }
  return sides;
}

/// The lowest and highest value of a coordinate over a boundary [m].
struct Extent
{
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double middle() const { return std::midpoint(low, high); }
};

template <int dim>
class Places
{
public:
  Places(const SampleMesh<dim>& its_mesh, const bool is_in_r_z)
    : mesh(its_mesh)
    , in_r_z(is_in_r_z)
    , sides(outer_sides(*mesh.triangulation))
    , box(GridTools::compute_bounding_box(*mesh.triangulation))
    , tolerance(1e-3 * (in_r_z ? 2.0 : 1.0) * box.side_length(0))
  {
    for (const auto& side : sides)
      for (const Point<dim>& corner : side.corners)
        largest_radius = std::max(largest_radius, radius(corner));
    names = dim == 3 ? std::vector<std::string>{"bottom", "top", "side"}
            : in_r_z ? std::vector<std::string>{"bottom", "top", "axis", "side"}
                     : std::vector<std::string>{"bottom", "top", "left", "right"};
  }

  void check() const
  {
    for (const std::string& name : names)
      if (std::ranges::none_of(sides, [&](const auto& side) { return is_of(side, name); }))
        throw MeshError(fmt::format("no outer side of a cell belongs to {}", name));
    check_order("bottom", "top", axis, "lies below bottom", "{0} counts upwards, so mirror a depth ({0} -> -{0})");
    if (in_r_z)
      check_order("axis", "side", 0, "lies within axis", "{0} is the radius, from the axis outwards");
    else if (dim == 2)
      check_order("left", "right", 0, "lies to the left of left", "{0} counts to the right");
    check_flat("bottom", axis, box.lower_bound(axis));
    check_flat("top", axis, box.upper_bound(axis));
    if (in_r_z)
      check_flat("axis", 0, 0.0);
    for (const auto& side : sides)
      check_side(side);
  }

private:
  static constexpr unsigned int axis = dim - 1;
  static char letter(const unsigned int coordinate) { return "xyz"[coordinate]; }

  bool is_of(const OuterSide<dim>& side, const std::string& name) const { return side.boundary == mesh.boundary(name); }

  Extent extent(const std::string& name, const unsigned int coordinate) const
  {
    Extent result;
    for (const auto& side : sides)
      if (is_of(side, name))
        for (const Point<dim>& corner : side.corners)
          {
            result.low = std::min(result.low, corner[coordinate]);
            result.high = std::max(result.high, corner[coordinate]);
          }
    return result;
  }

  /// Refuses two boundaries that have each other's name.
  void check_order(const char* const low, const char* const high, const unsigned int coordinate,
                   const std::string& problem, const std::string& remedy) const
  {
    const double at_low = extent(low, coordinate).middle();
    const double at_high = extent(high, coordinate).middle();
    const char x = letter(coordinate);
    if (at_high < at_low)
      throw MeshError(fmt::format("{} {}: {} at {} = {:g} m, {} at {} = {:g} m; {}, or give each the name of the other",
                                  high, problem, high, x, at_high, low, x, at_low,
                                  fmt::format(fmt::runtime(remedy), x)));
  }

  void check_flat(const char* const name, const unsigned int coordinate, const double place) const
  {
    const Extent found = extent(name, coordinate);
    const char x = letter(coordinate);
    if (found.high - found.low > tolerance)
      throw MeshError(
        fmt::format("{0} reaches from {1} = {2:g} m to {1} = {3:g} m; all of it must lie at {1} = {4:g} m "
                    "to within {5:.2g} m, a thousandth of the width",
                    name, x, found.low, found.high, place, tolerance));
    if (std::abs(found.middle() - place) > tolerance)
      throw MeshError(
        fmt::format("{0} lies at {1} = {2:g} m, but the sample ends at {1} = {3:g} m", name, x, found.middle(), place));
  }

  /// Distance from the axis of the sample; in the plane the first coordinate.
  static double radius(const Point<dim>& place) { return dim == 3 ? std::hypot(place[0], place[1]) : place[0]; }

  /// The cosine of the angle between its normal and the way from the axis; in the plane, from left to right.
  static double faces_outwards(const OuterSide<dim>& side)
  {
    if constexpr (dim == 2)
      return side.normal[0];
    else
      {
        const double distance = radius(side.centre);
        return distance > 0.0 ? (side.normal[0] * side.centre[0] + side.normal[1] * side.centre[1]) / distance : 0.0;
      }
  }

  /// The boundary whose place it lies at; empty where any may lie.
  std::string place_of(const OuterSide<dim>& side) const
  {
    // A side of a small cell may lie near an end with all of its corners and face elsewhere.
    constexpr double half_way = 0.5;
    const auto lies_at = [&](const double place, const auto& measure) {
      return std::ranges::all_of(
        side.corners, [&](const Point<dim>& corner) { return std::abs(measure(corner) - place) <= tolerance; });
    };
    const auto height = [](const Point<dim>& corner) { return corner[axis]; };
    if (side.normal[axis] < -half_way && lies_at(box.lower_bound(axis), height))
      return "bottom";
    if (side.normal[axis] > half_way && lies_at(box.upper_bound(axis), height))
      return "top";
    const double outwards = faces_outwards(side);
    if (outwards > half_way && lies_at(largest_radius, radius))
      return dim == 3 || in_r_z ? "side" : "right";
    if (dim == 2 && outwards < -half_way && lies_at(box.lower_bound(0), radius))
      return in_r_z ? "axis" : "left";
    return "";
  }

  void check_side(const OuterSide<dim>& side) const
  {
    const std::string place = place_of(side);
    std::string name;
    for (const std::string& known : names)
      if (is_of(side, known))
        name = known;
    const std::string where = coordinates(side.centre);
    if (name != place && !place.empty())
      throw MeshError(
        fmt::format("the side of a cell at ({}) m lies where {} is and {}; {} must be all that lies there", where,
                    place, name.empty() ? "has none of these names" : "is named " + name, place));
    const double outwards = name == "left" ? -faces_outwards(side) : faces_outwards(side);
    constexpr double round_off = 1e-6;
    if ((name == "left" || name == "right" || name == "side") && outwards < -round_off)
      throw MeshError(fmt::format("the side of a cell at ({}) m is named {} and faces {}", where, name,
                                  name == "side"   ? "the axis of the sample"
                                  : name == "left" ? "to the right"
                                                   : "to the left"));
  }

  const SampleMesh<dim>& mesh;
  bool in_r_z;
  std::vector<OuterSide<dim>> sides;
  BoundingBox<dim> box;
  double tolerance; ///< [m]
  double largest_radius = 0.0;
  std::vector<std::string> names;
};
} // namespace

template <int dim>
void check_places(const SampleMesh<dim>& mesh, const bool in_r_z)
{
  Places<dim>(mesh, in_r_z).check();
}

template void check_places<2>(const SampleMesh<2>&, bool);
template void check_places<3>(const SampleMesh<3>&, bool);
} // namespace feldspar::fem
