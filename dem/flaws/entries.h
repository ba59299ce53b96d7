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
  constexpr std::string_view in_box =
    "clumps are of the plane and in a box, for laboratory tests: set Specimen/Dimension = 2 and Specimen/Shape = box";
  constexpr std::string_view without_flaws = "excludes section Flaws, which is given too; keep one of them";
  const std::vector<Demand> demands{
    {"",
     "Specimen/Shape",
     {"box", "cylinder"},
     "clumps are in a box, and Specimen/Shape is periodic: a representative volume takes none, set Diameter = none; "
     "a laboratory test takes them with Shape = box"},
    {"", "Specimen/Dimension", {"2"}, in_box},
    {"", "Specimen/Shape", {"box"}, in_box},
    {"", "Mineral grains/Mean size", {}, "excludes Mineral grains/Mean size, which is given too; keep one of them"},
    {"", "Flaws/Shapes", {}, without_flaws},
    {"", "Flaws/Traces file", {}, without_flaws}};
  return {entry::optional_quantity("Diameter", &P::diameter, Measure::length, "mm", ranges::above_zero,
                                   "diameter of the circles that are stamped over the packing, or of the circle of the "
                                   "mean area of the cells: the grains in one move as one rigid body, a clump, with "
                                   "joints between clumps only; in two dimensions, in a box, for the tests that "
                                   "take them; none makes no clumps",
                                   {.varies = true, .of_specimen = true, .demands = demands}),
          entry::choice("Form", &P::form, {{"stamped circles", ClumpForm::stamped}, {"cells", ClumpForm::cells}},
                        "stamped circles: about one grain after another in random order, which take the grains that no "
                        "clump has yet and that hang together with the one in the middle; cells: the Voronoi cells of "
                        "random points",
                        {.varies = true, .of_specimen = true})};
}
} // namespace feldspar
