#pragma once

#include "base/entries.h"
#include "coupling/network/boundary.h"
#include "coupling/rve/parameters.h"

#include <vector>

/// The entries of a representative volume.
namespace feldspar
{
/// The entries of section Representative volume.
inline std::vector<Entry<EquilibriumParameters>> equilibrium_entries()
{
  using P = EquilibriumParameters;
  const EntryFlags varies{.varies = true};
  const EntryFlags basic{.varies = true, .basic = true};
  return {
    entry::number("Event tolerance", &P::event_tolerance, {'[', 1e-12, 0.1, ']'},
                  "largest unbalanced over mean contact force, between breaks", varies),
    entry::number("Final tolerance", &P::final_tolerance, {'[', 1e-12, 0.1, ']'},
                  "the same, of the stress that is handed out", varies),
    entry::choice("Break rule", &P::break_rule,
                  {{"near worst", BreakRule::near_worst}, {"only worst", BreakRule::only_worst}},
                  "whether segments with 0.98 of the worst overload break together with it", varies),
    entry::integer(
      "Softening steps", &P::softening_steps, {'[', 1.0, 1000.0, ']'},
      "number of steps, about, in which a bond of a softening flat joint softens from one equilibrium to the next",
      varies),
    entry::choice(
      "Kinematics", &P::kinematics, {{"small strains", Kinematics::small_strains}, {"finite", Kinematics::finite}},
      "small strains: the contacts of an RVE keep the directions that they have at rest; finite: they turn with their "
      "grains from the first break on; explicit dynamics always turn them",
      basic),
    entry::integer("Most iterations", &P::most_iterations, {'[', 1.0, 1e6, ']'},
                   "by Newton's method in search of one equilibrium, before damped motion brings it nearer", varies)};
}

/// Entries of the boundary, in section Representative volume.
inline std::vector<Entry<Boundary>> boundary_entries()
{
  using P = Boundary;
  const EntryFlags varies{.varies = true};
  const EntryFlags basic{.varies = true, .basic = true};
  return {
    entry::choice(
      "Boundary", &P::kind,
      {{"periodic", BoundaryKind::periodic},
       {"minimal kinematic", BoundaryKind::minimal_kinematic},
       {"weakly periodic", BoundaryKind::weakly_periodic},
       {"edge", BoundaryKind::edge},
       {"affine", BoundaryKind::affine}},
      "what holds the sides of the cell; minimal kinematic: a uniform traction on each pair of sides, so that "
      "the strain is their mean displacement; weakly periodic: a uniform traction on each of Traction pieces; "
      "edge: a uniform traction across Free axis, periodic along the others; in a sample the elements on its "
      "free sides have such cells, the others periodic ones; affine: the grains on the sides are displaced as "
      "the strain says",
      basic),
    entry::integer("Traction pieces", &P::n_pieces, {'[', 1.0, 1000.0, ']'},
                   "of a side along each of its edges, where the boundary is weakly periodic; 1: minimal kinematic; a "
                   "piece with one grain is periodic",
                   varies),
    entry::choice("Free axis", &P::free_axis, {{"x", 0}, {"y", 1}, {"z", 2}},
                  "of an edge cell of `feldspar rve`: across its sides acts a uniform traction, or none where the path "
                  "gives a stress of 0 MPa there; in a sample it is the normal of the free side",
                  varies)};
}
} // namespace feldspar
