#pragma once

#include "results/peak.h"
#include "results/record.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A figure, or the reason why it could not be had.
struct Figure
{
  std::optional<double> value;
  std::string reason;
};

/// A splitting test is valid as long as no more than this share of the first cracks lies at the pads (docs/theory.md §4.4).
inline constexpr double most_first_cracks_at_pads = 0.5;

/// The results of a test; stresses and strains positive in the sense of the test.
struct TestResults
{
  Figure peak_stress;
  Figure strain_at_peak;
  Figure youngs_modulus_initial; ///< by the gauge, 5–20 % of the peak
  Figure youngs_modulus_tangent; ///< 40–60 % of the peak
  Figure youngs_modulus_secant;  ///< to 50 % of the peak
  Figure poissons_ratio_initial;
  Figure poissons_ratio_secant;
  Figure crack_initiation_stress;         ///< by the count of cracks
  Figure crack_initiation_stress_lateral; ///< by the lateral strain, as curves of the laboratory are read
  Figure crack_damage_stress;
  Figure post_peak_drop;          ///< peak minus last stress, over peak
  Figure residual_deviator_ratio; ///< deviator at the end over that at the peak
  std::uint64_t n_tension_cracks = 0;
  std::uint64_t n_shear_cracks = 0;
  Figure n_tension_cracks_at_peak;
  Figure n_shear_cracks_at_peak;
  Figure shear_share_at_peak;             ///< of all cracks
  Figure n_smooth_tension_cracks_at_peak; ///< of smooth joints
  Figure n_smooth_shear_cracks_at_peak;
  Figure smooth_tension_share_at_peak; ///< of all cracks
  double energy_imbalance = 0.0;
  double energy_imbalance_over_work = 0.0;
  Figure kinetic_to_strain_energy; ///< largest from 5 % of the peak to the peak
  Figure end_stress_difference;    ///< largest share of the peak deviator, from 5 % of the peak to the peak
  Figure unbalanced_force_ratio;   ///< mean from 5 % of the peak to the peak
  Figure p_wave_transits_to_peak;
  Figure servo_error;           ///< mean |lateral stress / pressure - 1| from seating to the peak
  Figure servo_error_largest;   ///< largest of the same
  Figure fracture_toughness;    ///< K_IC at the peak [Pa √m]
  Figure fracture_energy;       ///< work of fracture over the ligament [J/m²]
  Figure normal_stress_at_peak; ///< on a plane that is sheared, compression positive [Pa]
  Figure dilation_angle;        ///< of a plane that is sheared, from the peak to the end [rad]
  /// Of the first cracks of a disc that is split, the share at the pads, where tension is low and the disc is crushed.
  Figure first_cracks_at_pads_share;
  Figure n_fragments;            ///< of two grains or more, at the end
  Figure largest_fragment_share; ///< of the grains' volume

  /// Whether the test measured what its kind measures: a disc that breaks at its pads is not split.
  bool is_valid() const { return !(first_cracks_at_pads_share.value.value_or(0.0) > most_first_cracks_at_pads); }
};

/// A stage of a test, read off its curve; compression positive.
struct StageResults
{
  double strain_at_start = 0.0;
  double strain_at_end = 0.0;
  double stress_at_start = 0.0; ///< axial [Pa]
  double stress_at_end = 0.0;   ///< axial [Pa]
  Figure lateral_stress_at_end; ///< of the side walls [Pa]
  Figure slope;                 ///< of axial stress over axial strain, by least squares [Pa]
  std::uint64_t n_cracks = 0;
  double duration = 0.0; ///< [s]
};

/// The first row with 1 % of the cracks at the peak; none if there is no crack up to there.
std::optional<std::size_t> crack_initiation_row(const TestRecord& record, std::size_t peak);

/// Reads the results off the curve (docs/theory.md §5).
TestResults evaluate(const TestRecord& record);

/// One for each stage of the record, whose rows must lie on its curve.
std::vector<StageResults> evaluate_stages(const TestRecord& record);
} // namespace feldspar
