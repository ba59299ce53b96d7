#pragma once

#include "base/entries.h"
#include "coupling/sample/continua/continua.h"
#include "coupling/sample/sample_parameters.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The entries of a sample of finite elements.
namespace feldspar
{
/// The entries of section Sample.
inline std::vector<Entry<SampleParameters>> sample_entries()
{
  using P = SampleParameters;
  std::vector<std::pair<std::string_view, std::string>> materials{{"grains", "grains"}};
  for (const std::string_view name : continuum_names)
    materials.emplace_back(name, name);
  return {
    entry::choice(
      "Geometry", &P::geometry,
      {{"plane", SampleGeometry::plane},
       {"plane strain", SampleGeometry::plane_strain},
       {"axisymmetric", SampleGeometry::axisymmetric},
       {"cylinder", SampleGeometry::cylinder}},
      "plane: representative volumes of discs, one metre thick; the others have those of spheres "
      "(Dimension = 3): plane strain lets nothing strain across the plane, axisymmetric is a cylinder by half "
      "of its section, cylinder the whole",
      {.basic = true}),
    entry::choice("Material", &P::material, materials,
                  "at the points of the sample of `feldspar multiscale`: the representative volume, or, for "
                  "comparison, what Continuum says",
                  {.basic = true}),
    entry::file(
      "Mesh file", &P::mesh_file,
      "of Gmsh (format 2 or 4, text or binary), instead of Width, Height and both Elements: "
      "quadrilaterals with the lines of the physical groups left, right, bottom and top, in r-z "
      "axis, side, bottom and top with the axis at x = 0, or hexahedra about x = y = 0 along z "
      "with the surfaces side, bottom and top, or other names by Mesh names; the last coordinate counts upwards, and each "
      "name must be that of the place where its lines or surfaces lie",
      {.basic = true}),
    entry::choice("Mesh unit", &P::mesh_unit,
                  {{"none", MeshUnit::not_said},
                   {"m", MeshUnit::metre},
                   {"cm", MeshUnit::centimetre},
                   {"mm", MeshUnit::millimetre}},
                  "in which the coordinates of the mesh file count; none: metres, of a sample of at most 3 m"),
    entry::quantity("Width", &P::width, Measure::length, "mm", ranges::above_zero,
                    "of the sample of `feldspar multiscale`; of a cylinder its diameter", {.basic = true}),
    entry::quantity("Height", &P::height, Measure::length, "mm", ranges::above_zero,
                    "of the sample, along the axis of the tests", {.basic = true}),
    entry::integer("Elements across", &P::elements_across, {'[', 1.0, 10000.0, ']'},
                   "over the width; axisymmetric: over the radius; in a cylinder at least 3", {.basic = true}),
    entry::integer("Elements along", &P::elements_along, {'[', 1.0, 10000.0, ']'}, "over the height", {.basic = true}),
    entry::integer("Order", &P::order, {'[', 1.0, 2.0, ']'}, "of the elements"),
    entry::choice("Quadrature", &P::reduced_quadrature, {{"full", false}, {"reduced", true}},
                  "full: order + 1 points each way; reduced: as many as the order, which must be 2"),
    entry::choice("Platens", &P::rough_platens, {{"smooth", false}, {"rough", true}},
                  "whether the ends are held sideways", {.basic = true}),
    entry::choice("Control past the peak", &P::widened_past_peak, {{"axial strain", false}, {"lateral strain", true}},
                  "of a compression test, from the first avalanche of breaks or fall of the stress on; lateral "
                  "strain: the sample widens by Compression step from row to row and the platens follow (class "
                  "II)"),
    entry::choice(
      "Softening", &P::scaled_softening, {{"scaled", true}, {"as it is", false}},
      "of the representative volume of a point once its stress has begun to fall; scaled: by the size of its "
      "element over its own, so that the curve after the peak does not depend on the mesh where the fall can be "
      "followed (not in an avalanche)"),
    entry::integer("Realisations", &P::n_realisations, {'[', 1.0, 1000.0, ']'},
                   "packings of the representative volume, assigned to the points by the seed", {.basic = true}),
    entry::choice("Orientation", &P::random_orientation, {{"random", true}, {"fixed", false}},
                  "whether the representative volume at each point is turned by an angle of its own, and the "
                  "flaws in it"),
    entry::choice("Dealing", &P::assigned_to_elements, {{"to points", false}, {"to elements", true}},
                  "to points: every point gets a representative volume of its own; to elements: the points of an "
                  "element have the same packing in the same orientation"),
    entry::choice("Draw", &P::without_replacement, {{"by lot", false}, {"in turn", true}},
                  "by lot: any Realisation as likely as any other; in turn: from a shuffled stack, so that none "
                  "is used twice before all are. With as many Realisations as points (or elements) each has "
                  "its own"),
    entry::file(
      "Rocks", &P::rocks_file,
      "CSV table of the groups of cells (surfaces or volumes) of the mesh file that consist of another rock: a "
      "column `group`, and a column for each entry in which its representative volumes differ from those of "
      "all other cells, as `Flat joint/Modulus [GPa]`",
      {.demands = {{"", "Sample/Material", {"grains"}, "rocks differ in their grains; set Material = grains"},
                   {"",
                    "Sample/Weak seed",
                    {},
                    "excludes Weak seed: make the weak cells a group of their "
                    "own"}}}),
    entry::choice("Weak seed", &P::weak_seed,
                  {{"none", WeakSeed::none}, {"row", WeakSeed::row}, {"element", WeakSeed::element}},
                  "where the sample is to break first: the representative volumes of the row of elements just "
                  "above mid-height, or of the outermost element of that row, to the right, have weaker bonds"),
    entry::number("Weak seed strength", &P::weak_seed_strength, {'(', 0.0, 1.0, ']'},
                  "share of their tensile strength and cohesion that the bonds there have"),
    entry::number("Compression step", &P::compression_step, {'(', 0.0, 0.01, ']'},
                  "axial strain between two rows of the curve", {.basic = true}),
    entry::number("Tension step", &P::tension_step, {'(', 0.0, 0.01, ']'}, "the same in direct tension",
                  {.basic = true}),
    entry::number(
      "Most broken share", &P::most_broken_share, {'(', 0.0, 1.0, ']'},
      "of all segments in one step; a step that breaks more is cut. Of bonds that soften: of all the events that "
      "their segments can have"),
    entry::number("Smallest step share", &P::smallest_step_share, {'(', 0.0, 1.0, ']'},
                  "of a step, below which there is said to be no equilibrium"),
    entry::number("Newton tolerance", &P::newton_tolerance, {'[', 1e-12, 0.1, ']'},
                  "unbalanced over internal force of the sample")};
}
} // namespace feldspar
