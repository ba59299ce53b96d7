#pragma once

#include "dem/specimen/specimen.h"

#include <optional>

/// Clumped particles (Cho, Martin and Sego 2007): grains in rigid groups, joints between groups only; docs/theory.md §3.3.
namespace feldspar
{
enum class ClumpForm
{
  stamped, ///< circles stamped over the packing
  cells    ///< the Voronoi cells of random points
};

struct ClumpParameters
{
  std::optional<double> diameter; ///< of the stamped circles, or of the circle of the mean area of the cells; none: no
                                  ///< clumps [m]
  ClumpForm form = ClumpForm::stamped;
};

/// Makes rigid groups of the grains of a specimen, from the specimen's seed, and takes out the joints inside them. In a
/// group every grain is joined to every other by a way of bonded joints inside the group. Throws InputError where there can
/// be no clumps: in space, in periodic cells, beside mineral grains or flaws.
template <int dim>
void put_in_clumps(Specimen<dim>& specimen, const ClumpParameters& wanted);

/// Makes clumps of the mineral grains, one of each part that joints connect. Throws InputError where there can be no clumps.
template <int dim>
void make_minerals_rigid(Specimen<dim>& specimen);
} // namespace feldspar
