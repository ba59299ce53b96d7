#include "report/result_table.h"

#include <cmath>

namespace feldspar
{
namespace
{
using Value = std::function<Figure(const FinishedTest&)>;

Value result(Figure TestResults::*member)
{
  return [member](const FinishedTest& test) { return test.results.*member; };
}

/// A number that is always there, or NaN with the reason for it.
template <typename Get>
Value number(Get&& get, std::string reason_for_nan = "")
{
  return [get, reason_for_nan](const FinishedTest& test) -> Figure {
    const auto value = double(get(test));
    if (std::isnan(value))
      return {std::nullopt, reason_for_nan};
    return {value, ""};
  };
}

template <typename T>
Value of_specimen(T SpecimenReport::*member, std::string reason_for_nan = "")
{
  return number([member](const FinishedTest& test) { return test.record.specimen.*member; }, reason_for_nan);
}
} // namespace

const std::vector<ResultEntry>& result_table()
{
  static const std::vector<ResultEntry> table{
    {"confining_pressure_Pa", number([](const FinishedTest& test) { return test.record.confining_pressure; })},
    {"strain_rate_per_s", number([](const FinishedTest& test) { return test.record.strain_rate; })},
    {"peak_stress_Pa", result(&TestResults::peak_stress)},
    {"strain_at_peak", result(&TestResults::strain_at_peak)},
    {"youngs_modulus_initial_Pa", result(&TestResults::youngs_modulus_initial)},
    {"youngs_modulus_tangent_Pa", result(&TestResults::youngs_modulus_tangent)},
    {"youngs_modulus_secant_Pa", result(&TestResults::youngs_modulus_secant)},
    {"poissons_ratio_initial", result(&TestResults::poissons_ratio_initial)},
    {"poissons_ratio_secant", result(&TestResults::poissons_ratio_secant)},
    {"crack_initiation_stress_Pa", result(&TestResults::crack_initiation_stress)},
    {"crack_damage_stress_Pa", result(&TestResults::crack_damage_stress)},
    {"post_peak_drop", result(&TestResults::post_peak_drop)},
    {"residual_deviator_ratio", result(&TestResults::residual_deviator_ratio)},
    {"n_tension_cracks", number([](const FinishedTest& test) { return test.results.n_tension_cracks; })},
    {"n_shear_cracks", number([](const FinishedTest& test) { return test.results.n_shear_cracks; })},
    {"n_tension_cracks_at_peak", result(&TestResults::n_tension_cracks_at_peak)},
    {"n_shear_cracks_at_peak", result(&TestResults::n_shear_cracks_at_peak)},
    {"shear_share_at_peak", result(&TestResults::shear_share_at_peak)},
    {"n_fragments", number([](const FinishedTest& test) { return test.results.n_fragments; })},
    {"largest_fragment_share", number([](const FinishedTest& test) { return test.results.largest_fragment_share; })},
    {"n_grains", of_specimen(&SpecimenReport::n_grains)},
    {"n_joints", of_specimen(&SpecimenReport::n_joints)},
    {"coordination_number", of_specimen(&SpecimenReport::coordination_number)},
    {"coordination_number_core", of_specimen(&SpecimenReport::coordination_number_core,
                                             "no grain lies more than three mean diameters from the walls")},
    {"installation_gap_ratio", of_specimen(&SpecimenReport::installation_gap_ratio)},
    {"porosity", of_specimen(&SpecimenReport::porosity)},
    {"mean_overlap_ratio", of_specimen(&SpecimenReport::mean_overlap_ratio)},
    {"resolution", of_specimen(&SpecimenReport::resolution)},
    {"radius_multiplier", of_specimen(&SpecimenReport::radius_multiplier)},
    {"energy_imbalance", number([](const FinishedTest& test) { return test.results.energy_imbalance; })},
    {"energy_imbalance_over_work",
     number([](const FinishedTest& test) { return test.results.energy_imbalance_over_work; })},
    {"kinetic_to_strain_energy", result(&TestResults::kinetic_to_strain_energy)},
    {"unbalanced_force_ratio", result(&TestResults::unbalanced_force_ratio)},
    {"end_stress_difference", result(&TestResults::end_stress_difference)},
    {"p_wave_transits_to_peak", result(&TestResults::p_wave_transits_to_peak)},
    {"servo_error", result(&TestResults::servo_error)},
    {"servo_error_largest", result(&TestResults::servo_error_largest)},
    {"steps", number([](const FinishedTest& test) { return test.record.steps; })},
    {"time_step_s", number([](const FinishedTest& test) { return test.record.time_step; })},
    {"wall_time_s", number([](const FinishedTest& test) { return test.record.wall_time; })}};
  return table;
}
} // namespace feldspar
