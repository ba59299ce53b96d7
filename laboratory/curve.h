#pragma once

#include "laboratory/column.h"
#include "laboratory/energies.h"

#include <cmath>
#include <cstdint>
#include <string_view>

namespace feldspar
{
/// One row of the curve of a laboratory test; SI, tension positive.
struct CurveSample
{
  std::uint64_t step = 0;
  double time = 0.0;
  double axial_strain = 0.0;
  double axial_stress = 0.0;
  double end_stress_difference = 0.0;
  double lateral_stress = 0.0;
  double mid_stress = 0.0;
  double gauge_axial_strain = 0.0;
  double gauge_lateral_strain = 0.0;
  double gauge_volumetric_strain = 0.0;
  std::uint64_t n_tension_cracks = 0;
  std::uint64_t n_shear_cracks = 0;
  double unbalanced_force_ratio = 0.0;
  Energies energies;

  std::uint64_t n_cracks() const { return n_tension_cracks + n_shear_cracks; }
};

template <double Energies::*member>
constexpr Column<CurveSample> energy_column(const std::string_view name, const std::string_view meaning,
                                            const unsigned int flags = 0)
{
  return column<CurveSample, &CurveSample::energies, member>(name, meaning, flags | perhaps_nan);
}

/// The columns of curves/NAME.csv, in their order.
inline constexpr Column<CurveSample> curve_columns[] = {
  column<CurveSample, &CurveSample::step>("step", "number of the step in time, or of the equilibrium of a sample"),
  column<CurveSample, &CurveSample::time>("time_s", "0 of a sample, but for stages with a rate"),
  column<CurveSample, &CurveSample::axial_strain>("axial_strain", "platen or grip travel over the length between them",
                                                  positive_in_test),
  column<CurveSample, &CurveSample::axial_stress>(
    "axial_stress_Pa", "mean of both ends over the area; Brazilian: 2P/(πDt)", positive_in_test),
  column<CurveSample, &CurveSample::end_stress_difference>("end_stress_difference_Pa", "between both ends",
                                                           positive_in_test),
  column<CurveSample, &CurveSample::lateral_stress>(
    "lateral_stress_Pa", "of the side walls, mean since the row before; 0 without", positive_in_test),
  column<CurveSample, &CurveSample::mid_stress>("mid_stress_Pa", "carried across the middle of the specimen",
                                                positive_in_test),
  column<CurveSample, &CurveSample::gauge_axial_strain>("gauge_axial_strain", "of the grains in the middle",
                                                        positive_in_test | perhaps_nan),
  column<CurveSample, &CurveSample::gauge_lateral_strain>("gauge_lateral_strain", "of the same",
                                                          positive_in_test | perhaps_nan),
  column<CurveSample, &CurveSample::gauge_volumetric_strain>("gauge_volumetric_strain", "of the same",
                                                             positive_in_test | perhaps_nan),
  column<CurveSample, &CurveSample::n_tension_cracks>("n_tension_cracks", "segments broken in tension"),
  column<CurveSample, &CurveSample::n_shear_cracks>("n_shear_cracks", "segments broken in shear"),
  column<CurveSample, &CurveSample::unbalanced_force_ratio>("unbalanced_force_ratio",
                                                            "mean unbalanced over mean contact force"),
  energy_column<&Energies::boundary_work>("boundary_work_J", "of platens, grips and side walls"),
  energy_column<&Energies::kinetic>("kinetic_energy_J", "as it is at the row"),
  energy_column<&Energies::strain>("strain_energy_J", "stored since the start"),
  energy_column<&Energies::slip>("slip_energy_J", "dissipated by friction"),
  energy_column<&Energies::released>("released_energy_J", "by bonds that break or soften"),
  energy_column<&Energies::damping>("damping_energy_J", "dissipated by damping"),
  energy_column<&Energies::kinetic_at_start>("kinetic_energy_at_start_J",
                                             "of the motion with which the grains were set off", added_later),
  // The boundary work by the name of what does it on a sample: reactions of the platens, pressures on the sides.
  energy_column<&Energies::boundary_work>("platen_work_J", "of the platens and of the pressure on the sides",
                                          only_of_samples | added_later),
  energy_column<&Energies::redistribution>("redistribution_energy_J", "released between finite elements after breaks",
                                           only_of_samples | added_later)};

/// The name of a column whose number in this row is infinite, or no number where every body has one; empty: none.
inline std::string_view not_finite_in(const CurveSample& row)
{
  for (const Column<CurveSample>& column : curve_columns)
    if (const double value = column.get(row); !std::isfinite(value) && !(std::isnan(value) && column.is(perhaps_nan)))
      return column.name;
  return {};
}
} // namespace feldspar
