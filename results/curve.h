#pragma once

#include "dem/dynamics/energies.h"

#include <cstdint>

namespace feldspar
{
/// One row of the curve of a laboratory test; SI, tension positive.
struct CurveSample
{
  std::uint64_t step = 0;
  double time = 0.0;                  ///< [s]
  double axial_strain = 0.0;          ///< platen or grip travel over the length between them
  double axial_stress = 0.0;          ///< mean of both ends over the area; Brazilian: -2P/(πDt) [Pa]
  double end_stress_difference = 0.0; ///< between both ends [Pa]
  double lateral_stress = 0.0;        ///< of the side walls, mean since the row before; 0 without [Pa]
  double mid_stress = 0.0;            ///< carried across the middle of the specimen [Pa]
  double gauge_axial_strain = 0.0;    ///< of the grains in the middle
  double gauge_lateral_strain = 0.0;
  double gauge_volumetric_strain = 0.0;
  std::uint64_t n_tension_cracks = 0;
  std::uint64_t n_shear_cracks = 0;
  double unbalanced_force_ratio = 0.0; ///< mean unbalanced over mean contact force
  Energies energies;
};
} // namespace feldspar
