#pragma once

#include <string>

/// Condition on the sides of a cell; docs/theory.md §9.6.
namespace feldspar
{
enum class BoundaryKind
{
  periodic,
  minimal_kinematic, ///< a uniform traction on each pair of sides
  weakly_periodic,   ///< a uniform traction on each piece of a pair of sides
  edge,              ///< a uniform traction on one pair of sides, the others periodic
  affine             ///< the grains on the sides are displaced as the strain says
};

struct Boundary
{
  BoundaryKind kind = BoundaryKind::periodic;
  unsigned int n_pieces = 4; ///< of a side along each of its edges, where the boundary is weakly periodic
  int free_axis = 0;         ///< from side to side of which an edge cell has its uniform traction

  bool opens(const int axis) const
  {
    return kind == BoundaryKind::minimal_kinematic || kind == BoundaryKind::weakly_periodic ||
           (kind == BoundaryKind::edge && axis == free_axis);
  }
  bool operator==(const Boundary&) const = default;
};

/// Name of a boundary in words: periodic, "weakly periodic, 4 pieces", "edge, x free".
std::string name(const Boundary& boundary);
} // namespace feldspar
