#pragma once

#include "base/entries.h"
#include "base/table/quantity.h"
#include "dem/laws/joint_laws.h"
#include "dem/specimen/parameters.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The entries of a specimen.
namespace feldspar
{
/// The entries of section Specimen.
inline std::vector<Entry<SpecimenParameters>> specimen_entries()
{
  using P = SpecimenParameters;
  const EntryFlags of_rock{.varies = true, .of_specimen = true};
  const EntryFlags of_body{.of_specimen = true}; // one for all variants
  const EntryFlags basic_of_rock{.varies = true, .of_specimen = true, .basic = true};
  const EntryFlags basic_of_body{.of_specimen = true, .basic = true};
  constexpr std::string_view cells_need = "needs Coring = free sides or sides only";
  const EntryFlags of_cells{.varies = true,
                            .of_specimen = true,
                            .demands = {{"", "Specimen/Coring", {"free sides", "sides only"}, cells_need}}};
  EntryFlags of_cells_along = of_cells;
  of_cells_along.demands.push_back(
    {"", "Specimen/Coring", {"free sides"}, "needs Coring = free sides; sides only has walls at the ends of a cell"});
  std::vector<std::pair<std::string_view, std::string>> laws;
  for (const std::string_view name : JointLaws::names())
    laws.emplace_back(name, name);
  return {
    entry::choice("Dimension", &P::dimension, {{"2", 2}, {"3", 3}},
                  "2: discs in the plane, one metre thick; 3: spheres", basic_of_body),
    entry::choice("Shape", &P::shape,
                  {{"box", BodyShape::box}, {"cylinder", BodyShape::cylinder}, {"periodic", BodyShape::periodic}},
                  "box or, in three dimensions, upright cylinder with the width as diameter: between walls, "
                  "for laboratory tests; periodic: a cell that repeats itself, for `feldspar rve`",
                  {.of_specimen = true,
                   .basic = true,
                   .demands = {{"cylinder", "Specimen/Dimension", {"3"}, "needs Dimension = 3"}}}),
    entry::quantity(
      "Width", &P::width, Measure::length, "mm", ranges::above_zero,
      "of the box or cell, across the axis of the tests, and in space its depth too; at least four radii of the "
      "largest grain",
      basic_of_rock),
    entry::quantity("Height", &P::height, Measure::length, "mm", ranges::above_zero,
                    "of the box or cell, along the axis of the tests; at least four radii of the largest grain",
                    basic_of_rock),
    entry::quantity("Minimum radius", &P::minimum_radius, Measure::length, "mm", ranges::above_zero, "of the grains",
                    basic_of_rock),
    entry::number("Radius ratio", &P::radius_ratio, {'[', 1.0, 100.0, ']'},
                  "largest over smallest radius; radii lie between them, as Size distribution says", basic_of_rock),
    entry::choice(
      "Size distribution", &P::size_distribution,
      {{"uniform", SizeDistribution::uniform},
       {"normal", SizeDistribution::normal},
       {"log-normal", SizeDistribution::log_normal}},
      "of the number of grains over the radius, between the smallest and the largest radius; normal and "
      "log-normal have their mean half-way (of the logarithm) and a sixth of the way as standard deviation, "
      "and are redrawn while out of bounds",
      of_rock),
    entry::number("Porosity", &P::porosity, {'(', 0.0, 1.0, ')'},
                  "of the finished packing; with the radii it gives the number of grains; in three dimensions "
                  "0.36 unless it is given",
                  {.varies = true, .of_specimen = true, .basic = true, .in_space = "0.36"}),
    entry::quantity("Density", &P::bulk_density, Measure::density, "kg/m^3", ranges::above_zero,
                    "of the rock as a body; a grain's is this over (1 - Porosity)", of_rock),
    entry::number("Packing stress ratio", &P::packing_stress_ratio, {'(', 0.0, 0.1, ']'},
                  "mean stress in the packing over Particle contact/Modulus, before the joints are installed", of_rock),
    entry::choice(
      "Packing relaxation", &P::packed_by_descent, {{"static", true}, {"dynamics", false}},
      "how the grains come to rest. static: by descent of grains and radii together; dynamics: by damped motion, "
      "radii scaled in steps between, which takes some twenty times as long in the plane and thirty in space. The same "
      "seed gives another packing. "
      "Without effect on a Packing file or Specimen file",
      of_rock),
    entry::choice(
      "Coring", &P::coring,
      {{"none", Coring::none}, {"free sides", Coring::free_sides}, {"sides only", Coring::sides_only}},
      "none: the grains are packed between walls, which take some of the joints beside them; free sides: packed as a "
      "periodic cell, joined everywhere and then cut free, at the sides and where the platens touch; sides only: packed "
      "between walls at the ends and periodic sideways, joined everywhere and cut free at the sides, so that the platens "
      "touch the ends of a walled specimen. Coordination number is then that of the rock before it is cut",
      {.varies = true,
       .of_specimen = true,
       .demands =
         {{"",
           "Specimen/Shape",
           {"box", "cylinder"},
           "a periodic cell has no sides to be cut free; set Shape = box or cylinder"},
          {"", "Specimen/Packing file", {}, "excludes Packing file, whose grains are not packed as a periodic cell"}}}),
    entry::integer(
      "Cells across", &P::cells_across, {'[', 1.0, 1000.0, ']'},
      "of a cored specimen: it is put together from so many equal cells along each side, each with the same "
      "grains, joints and strengths as a representative volume of that size and seed, which alone is packed",
      of_cells),
    entry::integer("Cells along", &P::cells_along, {'[', 1.0, 1000.0, ']'}, "the same along the axis of the tests",
                   of_cells_along),
    entry::file(
      "Packing file", &P::packing_file,
      "grains packed elsewhere: lines `x y radius`, a table with column names, or a file of LAMMPS, whose bonds become "
      "the joints; into a periodic cell grains outside come in from the other side; none makes a packing",
      of_body),
    entry::quantity("Packing unit", &P::packing_unit, Measure::length, "m", ranges::above_zero,
                    "length of 1 in a Packing file without units", of_body),
    {"Packing shift",
     Entry<P>::Text{"mm", "none, or a length for each of x, y (or x, y, z)",
                    [](P& wanted, const std::string_view text) {
                      wanted.packing_shift = text == "none" ? std::vector<double>() : parse_quantities(text, length);
                    },
                    [](const P& wanted) {
                      std::string text;
                      for (const double shift : wanted.packing_shift)
                        text += (text.empty() ? "" : ", ") + format_number(shift * 1e3);
                      return text.empty() ? "none" : text + " mm";
                    }},
     "by which the grains of a Packing file are moved", of_body, parameter_id<&P::packing_shift>()},
    entry::file(
      "Specimen file", &P::specimen_file,
      "a finished specimen.h5 to be tested, or, for `feldspar rve`, a representative volume "
      "of `feldspar multiscale --extract`, whose path begins in the state it is in; none makes a specimen",
      {.of_specimen = true,
       .demands = {{"", "Specimen/Packing file", {}, "excludes Packing file, which is given too; keep one of them"}}}),
    entry::choice(
      "Joint law", &P::joint_law, laws,
      "between grains that meet; its parameters are in the section of its name. Clumps and the mineral grains of a "
      "grain-based model are sections of their own, and go with a law",
      basic_of_rock)};
}
} // namespace feldspar
