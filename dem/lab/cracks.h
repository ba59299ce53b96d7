#pragma once

#include "dem/dynamics/dynamics.h"
#include "laboratory/record.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// A crack and the grains whose joint broke.
struct CrackBetween
{
  Crack crack;
  std::uint32_t grain_1, grain_2;
};

/// The cracks of a step, by their joints and segments; of a shared body those of all processes.
template <int dim>
std::vector<CrackBetween> cracks_of(const Dynamics<dim>& dynamics, const std::vector<Break>& breaks,
                                    double axial_strain);
} // namespace feldspar
