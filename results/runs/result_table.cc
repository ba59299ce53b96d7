#include "results/runs/result_table.h"

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace feldspar
{
namespace
{
/// A figure that may be missing, with the reason.
ResultEntry result(const std::string_view name, Figure TestResults::*member)
{
  return {name, [member](const FinishedTest& test) { return test.results.*member; },
          [member](FinishedTest& test, const Figure& figure) { test.results.*member = figure; }};
}

/// A number that is always there, or NaN with the reason for it. `part` gives the number's place in a test.
template <typename Part>
ResultEntry number(const std::string_view name, const Part& part, const std::string& reason_for_nan = "")
{
  return {name,
          [=](const FinishedTest& test) -> Figure {
            const auto value = double(part(test));
            if (!std::isfinite(value))
              return {std::nullopt, std::isnan(value) ? reason_for_nan : "it is no finite number"};
            return {value, ""};
          },
          [=](FinishedTest& test, const Figure& figure) {
            auto& place = part(test);
            using Number = std::remove_reference_t<decltype(place)>;
            const double value = figure.value.value_or(std::numeric_limits<double>::quiet_NaN());
            if constexpr (std::is_integral_v<Number>) // 0 of what is no count: foreign files hold anything
              place = value >= 0.0 && value < double(std::numeric_limits<Number>::max()) ? Number(value) : Number(0);
            else
              place = Number(value);
          },
          true};
}

template <typename T>
ResultEntry of_test(const std::string_view name, T TestRecord::*member, const std::string& reason_for_nan = "")
{
  return number(
    name, [member](auto& test) -> auto& { return test.record.*member; }, reason_for_nan);
}

template <typename T>
ResultEntry of_results(const std::string_view name, T TestResults::*member, const std::string& reason_for_nan = "")
{
  return number(
    name, [member](auto& test) -> auto& { return test.results.*member; }, reason_for_nan);
}

template <typename T>
ResultEntry of_specimen(const std::string_view name, T SpecimenReport::*member, const std::string& reason_for_nan = "")
{
  return number(
    name, [member](auto& test) -> auto& { return test.record.specimen.*member; }, reason_for_nan);
}

template <typename T>
ResultEntry of_run(const std::string_view name, T RunBookkeeping::*member, const std::string& reason_for_nan = "")
{
  return number(
    name, [member](auto& test) -> auto& { return test.bookkeeping.*member; }, reason_for_nan);
}

/// The same figures, and none of a test that could not be made: what a record of it holds was not measured.
std::vector<ResultEntry> of_tests_made(std::vector<ResultEntry> entries)
{
  for (ResultEntry& entry : entries)
    entry.value = [value = std::move(entry.value)](const FinishedTest& test) {
      return test.record.failure.empty() ? value(test) : Figure{std::nullopt, test.record.failure};
    };
  entries.insert(entries.begin(), of_test("confining_pressure_Pa", &TestRecord::confining_pressure)); // it was wanted
  entries.front().of_model = false;
  return entries;
}
} // namespace

const std::vector<ResultEntry>& result_table()
{
  static const std::string without_energies = "its material does not tell its energies";
  static const std::string without_time = "equilibrium is sought without time";
  static const std::vector<ResultEntry> table =
    of_tests_made({of_test("strain_rate_per_s", &TestRecord::strain_rate, without_time),
                   result("peak_stress_Pa", &TestResults::peak_stress),
                   result("strain_at_peak", &TestResults::strain_at_peak),
                   result("youngs_modulus_initial_Pa", &TestResults::youngs_modulus_initial),
                   result("youngs_modulus_tangent_Pa", &TestResults::youngs_modulus_tangent),
                   result("youngs_modulus_secant_Pa", &TestResults::youngs_modulus_secant),
                   result("poissons_ratio_initial", &TestResults::poissons_ratio_initial),
                   result("poissons_ratio_secant", &TestResults::poissons_ratio_secant),
                   result("crack_initiation_stress_Pa", &TestResults::crack_initiation_stress),
                   result("crack_initiation_stress_lateral_Pa", &TestResults::crack_initiation_stress_lateral),
                   result("crack_damage_stress_Pa", &TestResults::crack_damage_stress),
                   result("post_peak_drop", &TestResults::post_peak_drop),
                   result("residual_deviator_ratio", &TestResults::residual_deviator_ratio),
                   of_results("n_tension_cracks", &TestResults::n_tension_cracks),
                   of_results("n_shear_cracks", &TestResults::n_shear_cracks),
                   result("n_tension_cracks_at_peak", &TestResults::n_tension_cracks_at_peak),
                   result("n_shear_cracks_at_peak", &TestResults::n_shear_cracks_at_peak),
                   result("shear_share_at_peak", &TestResults::shear_share_at_peak),
                   result("n_smooth_tension_cracks_at_peak", &TestResults::n_smooth_tension_cracks_at_peak),
                   result("n_smooth_shear_cracks_at_peak", &TestResults::n_smooth_shear_cracks_at_peak),
                   result("smooth_tension_share_at_peak", &TestResults::smooth_tension_share_at_peak),
                   result("fracture_toughness_Pa_sqrt_m", &TestResults::fracture_toughness),
                   result("fracture_energy_J_per_m2", &TestResults::fracture_energy),
                   result("normal_stress_at_peak_Pa", &TestResults::normal_stress_at_peak),
                   result("dilation_angle_rad", &TestResults::dilation_angle),
                   result("first_cracks_at_pads_share", &TestResults::first_cracks_at_pads_share),
                   result("n_fragments", &TestResults::n_fragments),
                   result("largest_fragment_share", &TestResults::largest_fragment_share),
                   of_specimen("n_grains", &SpecimenReport::n_grains),
                   of_specimen("n_joints", &SpecimenReport::n_joints),
                   of_specimen("n_smooth_joints", &SpecimenReport::n_smooth_joints),
                   of_specimen("n_clumps", &SpecimenReport::n_clumps),
                   of_specimen("coordination_number", &SpecimenReport::coordination_number),
                   of_specimen("coordination_number_core", &SpecimenReport::coordination_number_core,
                               "no grain lies more than three mean diameters from the walls"),
                   of_specimen("installation_gap_ratio", &SpecimenReport::installation_gap_ratio),
                   of_specimen("porosity", &SpecimenReport::porosity),
                   of_specimen("mean_overlap_ratio", &SpecimenReport::mean_overlap_ratio),
                   of_specimen("resolution", &SpecimenReport::resolution),
                   of_specimen("radius_multiplier", &SpecimenReport::radius_multiplier),
                   of_specimen("n_cut_joints", &SpecimenReport::n_cut_joints),
                   of_specimen("n_removed_grains", &SpecimenReport::n_removed_grains),
                   of_results("energy_imbalance", &TestResults::energy_imbalance, without_energies),
                   of_results("energy_imbalance_over_work", &TestResults::energy_imbalance_over_work, without_energies),
                   result("kinetic_to_strain_energy", &TestResults::kinetic_to_strain_energy),
                   result("unbalanced_force_ratio", &TestResults::unbalanced_force_ratio),
                   result("end_stress_difference", &TestResults::end_stress_difference),
                   result("p_wave_transits_to_peak", &TestResults::p_wave_transits_to_peak),
                   result("servo_error", &TestResults::servo_error),
                   result("servo_error_largest", &TestResults::servo_error_largest),
                   of_run("steps", &RunBookkeeping::steps),
                   of_run("time_step_s", &RunBookkeeping::time_step, without_time),
                   of_run("wall_time_s", &RunBookkeeping::wall_time)});
  return table;
}
} // namespace feldspar
