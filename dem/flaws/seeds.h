#pragma once

#include "base/parameter_id.h"
#include "base/random.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <string_view>
#include <vector>

/// Random points whose Voronoi cells divide the grains of a specimen.
namespace feldspar
{
/// As many as cells of this mean size fill the specimen: diameter of the circle or ball of the mean volume [m], the parameter
/// that is wrong where cells cannot be, and what the cells are called there.
template <int dim>
std::vector<Vector<dim>> throw_seeds(const Specimen<dim>& specimen, double mean_size, RandomStream stream,
                                     const ParameterId& size, std::string_view name);

/// The number of the nearest.
template <int dim>
std::uint32_t nearest(const std::vector<Vector<dim>>& seeds, const Vector<dim>& point);
} // namespace feldspar
