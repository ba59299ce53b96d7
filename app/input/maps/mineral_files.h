#pragma once

#include "dem/minerals/parameters.h"

#include <filesystem>
#include <memory>
#include <vector>

/// The files that minerals come from. All throw InputError with the name of the file.
namespace feldspar
{
/// A table with the column `mineral` and any of share, size, aspect_ratio, angle, colour, density, stiffness_ratio,
/// tensile_strength_ratio, cohesion_ratio and friction_ratio; an empty cell is the default.
std::vector<Mineral> read_minerals(const std::filesystem::path& file);

/// A table with the columns mineral_1 and mineral_2 and any of the ratios.
std::vector<MineralBoundary> read_mineral_boundaries(const std::filesystem::path& file);

/// A picture in PNG of 8 bits without transparency (.png), or a table of points: x_m, y_m (z_m) and mineral.
std::shared_ptr<const MineralMap> read_mineral_map(const std::filesystem::path& file);
} // namespace feldspar
