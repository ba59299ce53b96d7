#pragma once

#include "dem/minerals/parameters.h"
#include "dem/specimen/specimen.h"

#include <array>
#include <cstdint>
#include <vector>

namespace feldspar
{
/// Throws InputError unless every colour or name on the map is that of a mineral, and the map covers a body of this size [m].
/// [n_cells of pictures, or n_points] number of the mineral.
std::vector<std::uint8_t> minerals_of_map(const MineralParameters& wanted, const std::array<double, 3>& size);

/// The mineral that the map shows on the largest part of each grain; of equal parts the first. [n_grains]
template <int dim>
std::vector<std::uint32_t> minerals_of_grains(const Specimen<dim>& specimen, const MineralParameters& wanted);
} // namespace feldspar
