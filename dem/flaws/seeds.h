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
/// Returns as many points as cells of this mean size fill the specimen. `mean_size` is the diameter of the circle or
/// ball of the mean volume [m]. `size` is the parameter that an InputError names for impossible cells, and `name` is the
/// word for the cells there.
template <int dim>
std::vector<Vector<dim>> throw_seeds(const Specimen<dim>& specimen, double mean_size, RandomStream stream,
                                     const ParameterId& size, std::string_view name);

/// The number of the nearest.
template <int dim>
std::uint32_t nearest(const std::vector<Vector<dim>>& seeds, const Vector<dim>& point);
} // namespace feldspar
