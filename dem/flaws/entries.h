#pragma once

#include "base/entries.h"
#include "dem/flaws/clumps.h"
#include "dem/flaws/mineral_grains.h"

#include <vector>

/// The entries of mineral grains and clumps; those of the other flaws, which are written as words, are with the input.
namespace feldspar
{
/// The entries of section Mineral grains.
inline std::vector<Entry<MineralGrainParameters>> mineral_grain_entries()
{
  using P = MineralGrainParameters;
  return {entry::optional_quantity("Mean size", &P::mean_size, Measure::length, "mm", ranges::above_zero,
                                   "diameter of the circle (in three dimensions: ball) of the mean volume of the "
                                   "mineral grains, which are the Voronoi cells of random points over the packing: a "
                                   "grain-based model, with a smooth joint at every joint between two of them, whose "
                                   "strengths section Smooth joint must give; none makes no mineral grains",
                                   {.varies = true, .of_specimen = true})};
}

/// The entries of section Clumps.
inline std::vector<Entry<ClumpParameters>> clump_entries()
{
  using P = ClumpParameters;
  return {entry::optional_quantity("Diameter", &P::diameter, Measure::length, "mm", ranges::above_zero,
                                   "diameter of the circles that are stamped over the packing, or of the circle of the "
                                   "mean area of the cells: the grains in one move as one rigid body, a clump, with "
                                   "joints between clumps only; in two dimensions, in a box, for the tests that "
                                   "take them; none makes no clumps",
                                   {.varies = true, .of_specimen = true}),
          entry::choice("Form", &P::form, {{"stamped circles", ClumpForm::stamped}, {"cells", ClumpForm::cells}},
                        "stamped circles: about one grain after another in random order, which take the grains that no "
                        "clump has yet and that hang together with the one in the middle; cells: the Voronoi cells of "
                        "random points",
                        {.varies = true, .of_specimen = true})};
}
} // namespace feldspar
