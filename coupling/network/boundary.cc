#include "coupling/network/boundary.h"

#include <fmt/format.h>

namespace feldspar
{
std::string name(const Boundary& boundary)
{
  switch (boundary.kind)
    {
    case BoundaryKind::periodic:
      return "periodic";
    case BoundaryKind::minimal_kinematic:
      return "minimal kinematic";
    case BoundaryKind::weakly_periodic:
      return fmt::format("weakly periodic, {} pieces", boundary.n_pieces);
    case BoundaryKind::edge:
      return fmt::format("edge, {} free", "xyz"[boundary.free_axis]);
    case BoundaryKind::affine:
      break;
    }
  return "affine";
}
} // namespace feldspar
