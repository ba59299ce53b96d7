#include "app/input/entry_parameter.h"
#include "app/input/input_entries.h"
#include "app/input/maps/mineral_files.h"

#include <string>
#include <vector>

/// The entries of section Minerals, of which three name files that are read at once.
namespace feldspar
{
namespace
{
/// The entry of a file whose content `read` puts into a member; none: an empty one.
template <typename T>
Entry<Input> file_entry(const std::string_view name, std::string MineralParameters::*const path,
                        T MineralParameters::*const content, T (*read)(const std::filesystem::path&),
                        const std::string_view meaning, const EntryFlags& flags)
{
  return {name,
          Entry<Input>::Text{"", std::string(none_or_a_file),
                             [=](Input& input, const std::string_view text) {
                               input.minerals.*path = readable_file(input, text);
                               input.minerals.*content =
                                 (input.minerals.*path).empty() ? T() : read(input.minerals.*path);
                             },
                             [=](const Input& input) { return or_none(input.minerals.*path); }},
          meaning, flags, id_of_member(path)};
}
} // namespace

std::vector<Entry<Input>> mineral_file_entries()
{
  using P = MineralParameters;
  const EntryFlags of_rock{.varies = true, .of_specimen = true};
  EntryFlags of_table = of_rock;
  of_table.demands = {
    {"", "Mineral grains/Mean size", {}, "excludes Mineral grains/Mean size, which is given too; keep one of them"},
    {"", "Clumps/Diameter", {}, "excludes Clumps/Diameter, which is given too; keep one of them"}};
  return {
    file_entry("Table", &P::table, &P::minerals, read_minerals,
               "CSV of the minerals, a row each: mineral (its name), share [%], size [mm] (diameter of the circle or "
               "ball of the mean volume of its mineral grains), aspect_ratio, angle [deg], colour (#rrggbb), density "
               "[kg/m^3], and the ratios of its joints to what the section of the joint law gives: stiffness_ratio, "
               "tensile_strength_ratio, cohesion_ratio, friction_ratio. Empty cells have the default: 1 of ratios. "
               "None: a rock without minerals",
               of_table),
    file_entry("Boundaries", &P::boundaries_file, &P::boundaries, read_mineral_boundaries,
               "CSV of the joints between mineral grains of two minerals, or of one: mineral_1, mineral_2 and the "
               "same ratios. An empty cell is the two stiffnesses in series, or the lower of both other ratios",
               of_rock),
    file_entry("Map", &P::map_file, &P::map, read_mineral_map,
               "picture of the minerals over the specimen, a PNG of 8 bits with the colours of the table, from its "
               "lower left corner; or a CSV of points with x [mm], y [mm] (z [mm]) and mineral, of which the nearest "
               "counts. Each grain has the mineral of its largest part. None: Voronoi cells by share and size",
               of_rock)};
}

std::vector<Entry<MineralParameters>> mineral_entries()
{
  using P = MineralParameters;
  const EntryFlags of_rock{.varies = true, .of_specimen = true};
  return {
    entry::optional_quantity("Pixel size", &P::pixel_size, Measure::length, "mm", ranges::above_zero, "of a picture",
                             of_rock),
    entry::integer("Slices", &P::n_slices, {'[', 1.0, 10000.0, ']'},
                   "number of slices through the depth, front first, that stand one below the other in the picture; "
                   "one runs through the whole depth",
                   of_rock),
    entry::optional_quantity("Slice distance", &P::slice_distance, Measure::length, "mm", ranges::above_zero,
                             "between slices; none: the size of a pixel", of_rock),
    entry::choice("Grains", &P::form,
                  {{"breakable", MineralGrainForm::breakable},
                   {"smooth boundaries", MineralGrainForm::smooth_boundaries},
                   {"rigid", MineralGrainForm::rigid}},
                  "mineral grains: breakable, with joints of the law inside and between; with smooth boundaries, "
                  "smooth joints between them, whose strengths section Smooth joint must give (a grain-based model); "
                  "rigid, clumps with joints between them only, in the plane",
                  of_rock),
    entry::number("Boundary strength", &P::boundary_strength, ranges::from_zero,
                  "factor on tensile strength and cohesion of all joints between mineral grains", of_rock)};
}
} // namespace feldspar
