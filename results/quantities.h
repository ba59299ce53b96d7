#pragma once

#include "results/test_quantity.h"

/// The quantities of a test and the properties of the rock that follow from them: each is a row of a table, which
/// evaluation, result files, comparison, studies, calibration and docs/results.md walk.
namespace feldspar
{
/// A splitting test is valid as long as no more than this share of the first cracks lies at the pads (docs/theory.md §4.4).
inline constexpr double most_first_cracks_at_pads = 0.5;

/// The results of a test; stresses and strains positive in the sense of the test. Their meaning stands in the table.
struct TestResults
{
  Figure peak_stress;
  Figure strain_at_peak;
  Figure youngs_modulus_initial;
  Figure youngs_modulus_tangent;
  Figure youngs_modulus_secant;
  Figure poissons_ratio_initial;
  Figure poissons_ratio_secant;
  Figure crack_initiation_stress;
  Figure crack_initiation_stress_lateral;
  Figure crack_initiation_stress_emission;
  Figure crack_damage_stress;
  Figure crack_damage_stress_emission;
  Figure post_peak_drop;
  Figure residual_deviator_ratio;
  std::uint64_t n_tension_cracks = 0;
  std::uint64_t n_shear_cracks = 0;
  Figure n_tension_cracks_at_peak;
  Figure n_shear_cracks_at_peak;
  Figure shear_share_at_peak;
  Figure n_smooth_tension_cracks_at_peak;
  Figure n_smooth_shear_cracks_at_peak;
  Figure smooth_tension_share_at_peak;
  Figure boundary_crack_share_at_peak;
  Figure n_events_at_peak;
  Figure b_value;
  Figure b_value_error;
  Figure b_positive;
  Figure fracture_toughness;
  Figure fracture_energy;
  Figure normal_stress_at_peak;
  Figure dilation_angle;
  Figure sliding_angle;
  Figure first_cracks_at_pads_share;
  Figure n_fragments;
  Figure largest_fragment_share;
  double energy_imbalance = 0.0;
  double energy_imbalance_over_work = 0.0;
  Figure kinetic_to_strain_energy;
  Figure unbalanced_force_ratio;
  Figure end_stress_difference;
  Figure p_wave_transits_to_peak;
  Figure stress_rate_error;
  Figure servo_error;
  Figure servo_error_largest;

  /// Returns whether the test measured what its kind measures: a disc that breaks at its pads is not split.
  bool is_valid() const { return !(first_cracks_at_pads_share.value.value_or(0.0) > most_first_cracks_at_pads); }
};

/// Reads a figure off the rising branch; for tests to which the kinds of the quantity's row apply.
namespace evaluation
{
Figure peak_stress(const RisingBranch& branch);
Figure strain_at_peak(const RisingBranch& branch);
Figure youngs_modulus_initial(const RisingBranch& branch);
Figure youngs_modulus_tangent(const RisingBranch& branch);
Figure youngs_modulus_secant(const RisingBranch& branch);
Figure poissons_ratio_initial(const RisingBranch& branch);
Figure poissons_ratio_secant(const RisingBranch& branch);
Figure crack_initiation_stress(const RisingBranch& branch);
Figure crack_initiation_stress_lateral(const RisingBranch& branch);
Figure crack_initiation_stress_emission(const RisingBranch& branch);
Figure crack_damage_stress(const RisingBranch& branch);
Figure crack_damage_stress_emission(const RisingBranch& branch);
Figure post_peak_drop(const RisingBranch& branch);
Figure residual_deviator_ratio(const RisingBranch& branch);
Figure n_tension_cracks_at_peak(const RisingBranch& branch);
Figure n_shear_cracks_at_peak(const RisingBranch& branch);
Figure shear_share_at_peak(const RisingBranch& branch);
Figure n_smooth_tension_cracks_at_peak(const RisingBranch& branch);
Figure n_smooth_shear_cracks_at_peak(const RisingBranch& branch);
Figure smooth_tension_share_at_peak(const RisingBranch& branch);
Figure boundary_crack_share_at_peak(const RisingBranch& branch);
Figure n_events_at_peak(const RisingBranch& branch);
Figure b_value(const RisingBranch& branch);
Figure b_value_error(const RisingBranch& branch);
Figure b_positive(const RisingBranch& branch);
Figure fracture_toughness(const RisingBranch& branch);
Figure fracture_energy(const RisingBranch& branch);
Figure normal_stress_at_peak(const RisingBranch& branch);
Figure dilation_angle(const RisingBranch& branch);
Figure sliding_angle(const RisingBranch& branch);
Figure first_cracks_at_pads_share(const RisingBranch& branch);
Figure kinetic_to_strain_energy(const RisingBranch& branch);
Figure unbalanced_force_ratio(const RisingBranch& branch);
Figure end_stress_difference(const RisingBranch& branch);
Figure p_wave_transits_to_peak(const RisingBranch& branch);
Figure stress_rate_error(const RisingBranch& branch);
Figure servo_error(const RisingBranch& branch);
Figure servo_error_largest(const RisingBranch& branch);
/// The same of all tests, with a peak or without.
Figure n_fragments(const TestRecord& record);
Figure largest_fragment_share(const TestRecord& record);
} // namespace evaluation

inline constexpr const char* not_under_load_control = "not under load control";
inline constexpr const char* no_laboratory_rate = "no rate of a laboratory was asked for";
inline constexpr const char* without_time = "equilibrium is sought without time";
inline constexpr const char* without_energies = "its material does not tell its energies";

/// The tests that give a quantity, and the reasons of others.
namespace tests_with
{
inline constexpr const char* no_monotonic_curve = "the curve goes back and forth; each stage has a slope of its own";

inline constexpr TestsThatGive one_peak{"all but own_loading", [](const TestRecord& test) {
                                          return test.kind.follows_stages ? no_monotonic_curve : nullptr;
                                        }};
inline constexpr TestsThatGive fall{
  "all but own_loading, Brazilian and those under load control", [](const TestRecord& test) {
    return test.kind.peak_rule == PeakRule::first_before_a_fall
             ? "the strength is the stress before the first fall, and what is left of the body may bear more"
           : test.stress_rate > 0.0 ? "under load control the strain runs away at the peak"
                                    : one_peak.objection(test);
  }};
inline constexpr TestsThatGive load_control{"under load control", [](const TestRecord& test) {
                                              return test.stress_rate > 0.0 ? nullptr : not_under_load_control;
                                            }};
inline constexpr TestsThatGive uniform_stress{
  "direct tension, uniaxial and triaxial compression", [](const TestRecord& test) {
    return test.kind.has_uniform_stress ? nullptr
           : test.kind.follows_stages   ? no_monotonic_curve
                                        : "the stress in this test is not uniform";
  }};
inline constexpr TestsThatGive compression{"uniaxial and triaxial compression", [](const TestRecord& test) {
                                             const bool is_pressed =
                                               test.kind.sign < 0.0 &&
                                               test.kind.has_uniform_stress; // the volume shrinks until cracks open
                                             return test.kind.follows_stages || is_pressed
                                                      ? one_peak.objection(test)
                                                      : "of uniaxial and triaxial compression only";
                                           }};
inline constexpr TestsThatGive smooth_joints{"of bodies with smooth joints", [](const TestRecord& test) {
                                               return test.specimen.n_smooth_joints > 0 ? nullptr : "no smooth joints";
                                             }};
inline constexpr TestsThatGive minerals{
  "of rocks of minerals", [](const TestRecord& test) { return test.minerals.empty() ? "no minerals" : nullptr; }};
inline constexpr TestsThatGive notch{
  "of notched bodies", [](const TestRecord& test) { return test.notch ? nullptr : "the test has no notch"; }};
inline constexpr TestsThatGive sheared_plane{"direct shear", [](const TestRecord& test) {
                                               return test.kind.pressure_acts_across ? nullptr
                                                                                     : "the test shears no plane";
                                             }};
inline constexpr TestsThatGive tilted_plate{
  "tilt", [](const TestRecord& test) { return test.kind.tilts ? nullptr : "the test tilts no plate"; }};
inline constexpr TestsThatGive split_disc{"Brazilian", [](const TestRecord& test) {
                                            return test.kind.peak_rule == PeakRule::first_before_a_fall
                                                     ? nullptr
                                                     : "the test splits no disc"; // rule of discs
                                          }};
inline constexpr TestsThatGive motion{
  "on grains", [](const TestRecord& test) { return test.body == TestBody::grains ? nullptr : without_time; }};
inline constexpr TestsThatGive grains{
  "on grains", [](const TestRecord& test) { return test.fragments ? nullptr : "there are no grains to be counted"; }};
} // namespace tests_with

namespace row
{
/// A figure that is read off; `further`: what the row has besides.
template <typename... Further>
constexpr TestQuantity figure(Figure TestResults::*member, const TestQuantity::Evaluation& evaluate,
                              const std::string_view name, const std::string_view title, const ShownIn& shown,
                              const std::string_view meaning, const Further&... further)
{
  TestQuantity made{member, evaluate, name, title, shown, meaning};
  (made.set(further), ...);
  return made;
}

/// A number that is always there, or NaN.
template <typename... Further>
constexpr TestQuantity number(const TestQuantity::Member& member, const QuantityOf of, const std::string_view name,
                              const std::string_view title, const ShownIn& shown, const std::string_view meaning,
                              const Further&... further)
{
  TestQuantity made{member, {}, name, title, shown, meaning, of};
  (made.set(further), ...);
  return made;
}
} // namespace row

/// Quantities of a test, in the order of summary.json.
inline constexpr TestQuantity test_quantities[] = {
  row::number(&TestRecord::confining_pressure, QuantityOf::loading, "confining_pressure_Pa", "confining pressure",
              display::megapascals(), "compression positive"),
  row::number(&TestRecord::strain_rate, QuantityOf::method, "strain_rate_per_s", "strain rate", display::plain(3),
              "magnitude; under load control, of the stress rate over the modulus of the particle contacts",
              NanMeans{without_time}),
  row::number(&TestRecord::stress_rate, QuantityOf::method, "stress_rate_Pa_per_s", "stress rate",
              ShownIn{"MPa/s", mega, 0}, "of the platens under load control", NanMeans{not_under_load_control}),
  row::number(&TestRecord::rate_over_laboratory, QuantityOf::method, "rate_over_laboratory",
              "rate over that of the laboratory", display::plain(0), "of stress or travel",
              NanMeans{no_laboratory_rate}),
  row::number(&RunBookkeeping::steps_at_laboratory_rate, QuantityOf::method, "steps_at_laboratory_rate",
              "steps at the rate of the laboratory", display::plain(0), "that the loading would take",
              NanMeans{no_laboratory_rate}),
  row::figure(&TestResults::peak_stress, evaluation::peak_stress, "peak_stress_Pa", "strength", display::megapascals(),
              "at the peak of the curve; of a body with flaws nominal", PageColumn::always, InStudies{"strength"}),
  row::figure(&TestResults::strain_at_peak, evaluation::strain_at_peak, "strain_at_peak", "strain at peak",
              display::thousandths, "axial strain of the platens or grips at the peak", PageColumn::always,
              InStudies{"strain_at_peak"}),
  row::figure(&TestResults::youngs_modulus_initial, evaluation::youngs_modulus_initial, "youngs_modulus_initial_Pa",
              "Young's modulus, initial", display::gigapascals,
              "slope of stress over gauge axial strain, 5-20 % of the peak deviator; of a test without a peak, from a "
              "quarter of the highest deviator before the first crack to the whole of it",
              tests_with::uniform_stress, NeedsNoPeak{}, PageColumn::always, InStudies{"youngs_modulus"}),
  row::figure(&TestResults::youngs_modulus_tangent, evaluation::youngs_modulus_tangent, "youngs_modulus_tangent_Pa",
              "Young's modulus, tangent 40-60 % of peak", display::gigapascals,
              "slope of stress over axial strain, 40-60 % of the peak deviator", tests_with::uniform_stress,
              PageColumn::always),
  row::figure(&TestResults::youngs_modulus_secant, evaluation::youngs_modulus_secant, "youngs_modulus_secant_Pa",
              "Young's modulus, secant at 50 % of peak", display::gigapascals,
              "deviator over axial strain at 50 % of the peak deviator", tests_with::uniform_stress),
  row::figure(&TestResults::poissons_ratio_initial, evaluation::poissons_ratio_initial, "poissons_ratio_initial",
              "Poisson's ratio, initial", display::plain(3),
              "slope of lateral expansion over axial strain, both of the gauge, between the same stresses",
              tests_with::uniform_stress, NeedsNoPeak{}, NeedsBesidesCurve::lateral_strain, PageColumn::always,
              InStudies{"poissons_ratio"}, at_most(0.5)),
  row::figure(&TestResults::poissons_ratio_secant, evaluation::poissons_ratio_secant, "poissons_ratio_secant",
              "Poisson's ratio, secant at 50 % of peak", display::plain(3),
              "lateral expansion over axial strain, both of the gauge, at 50 % of the peak deviator",
              tests_with::uniform_stress, NeedsBesidesCurve::lateral_strain, InStudies{"poissons_ratio_secant"},
              at_most(0.5)),
  row::figure(&TestResults::crack_initiation_stress, evaluation::crack_initiation_stress, "crack_initiation_stress_Pa",
              "crack initiation stress", display::megapascals(),
              "stress at which the number of cracks reaches 1 % of that at the peak", tests_with::one_peak,
              NeedsBesidesCurve::cracks, PageColumn::always, InStudies{"crack_initiation"}),
  row::figure(&TestResults::crack_initiation_stress_lateral, evaluation::crack_initiation_stress_lateral,
              "crack_initiation_stress_lateral_Pa", "crack initiation stress, lateral strain", display::megapascals(),
              "where the lateral expansion lies furthest below the straight line from the start to crack damage",
              tests_with::compression, NeedsBesidesCurve::lateral_strain),
  row::figure(&TestResults::crack_initiation_stress_emission, evaluation::crack_initiation_stress_emission,
              "crack_initiation_stress_emission_Pa", "crack initiation stress, acoustic emission",
              display::megapascals(),
              "where the number of cracks lies furthest below the straight line from the start to crack damage",
              tests_with::compression, NeedsBesidesCurve::cracks),
  row::figure(&TestResults::crack_damage_stress, evaluation::crack_damage_stress, "crack_damage_stress_Pa",
              "crack damage stress", display::megapascals(), "stress at which the volume of the gauge is smallest",
              tests_with::compression, NeedsBesidesCurve::lateral_strain, PageColumn::always,
              InStudies{"crack_damage"}),
  row::figure(&TestResults::crack_damage_stress_emission, evaluation::crack_damage_stress_emission,
              "crack_damage_stress_emission_Pa", "crack damage stress, acoustic emission", display::megapascals(),
              "where the energy released by breaks lies furthest below the straight line from the start to the peak",
              tests_with::compression, NeedsBesidesCurve::cracks),
  row::figure(&TestResults::post_peak_drop, evaluation::post_peak_drop, "post_peak_drop",
              "drop of the stress after the peak, over the peak", display::plain(3),
              "peak minus last stress, over peak", tests_with::fall, NeedsBesidesCurve::fall,
              InStudies{"post_peak_drop"}),
  row::figure(&TestResults::residual_deviator_ratio, evaluation::residual_deviator_ratio, "residual_deviator_ratio",
              "deviator at the end over peak", display::plain(2),
              "deviator at the end of the test over that at the peak", tests_with::fall, NeedsBesidesCurve::fall),
  row::number(&TestResults::n_tension_cracks, QuantityOf::rock, "n_tension_cracks", "tension cracks", display::plain(0),
              "segments broken in tension, at the end", PageColumn::always),
  row::number(&TestResults::n_shear_cracks, QuantityOf::rock, "n_shear_cracks", "shear cracks", display::plain(0),
              "segments broken in shear, at the end", PageColumn::always),
  row::figure(&TestResults::n_tension_cracks_at_peak, evaluation::n_tension_cracks_at_peak, "n_tension_cracks_at_peak",
              "tension cracks at the peak", display::plain(0), "segments broken in tension up to the peak",
              NeedsBesidesCurve::cracks),
  row::figure(&TestResults::n_shear_cracks_at_peak, evaluation::n_shear_cracks_at_peak, "n_shear_cracks_at_peak",
              "shear cracks at the peak", display::plain(0), "segments broken in shear up to the peak",
              NeedsBesidesCurve::cracks),
  row::figure(&TestResults::shear_share_at_peak, evaluation::shear_share_at_peak, "shear_share_at_peak",
              "shear share of cracks at the peak", display::percent(1), "shear cracks over all cracks up to the peak",
              NeedsBesidesCurve::cracks, InStudies{"shear_share"}),
  row::figure(&TestResults::n_smooth_tension_cracks_at_peak, evaluation::n_smooth_tension_cracks_at_peak,
              "n_smooth_tension_cracks_at_peak", "tension cracks of smooth joints at the peak", display::plain(0),
              "smooth joints broken in tension up to the peak: of flaws, or between mineral grains",
              tests_with::smooth_joints, NeedsBesidesCurve::cracks),
  row::figure(&TestResults::n_smooth_shear_cracks_at_peak, evaluation::n_smooth_shear_cracks_at_peak,
              "n_smooth_shear_cracks_at_peak", "shear cracks of smooth joints at the peak", display::plain(0),
              "smooth joints broken in shear up to the peak", tests_with::smooth_joints, NeedsBesidesCurve::cracks),
  row::figure(&TestResults::smooth_tension_share_at_peak, evaluation::smooth_tension_share_at_peak,
              "smooth_tension_share_at_peak", "share of tension cracks of smooth joints at the peak",
              display::percent(1), "tension cracks of smooth joints over all cracks up to the peak",
              tests_with::smooth_joints, NeedsBesidesCurve::cracks),
  row::figure(&TestResults::boundary_crack_share_at_peak, evaluation::boundary_crack_share_at_peak,
              "boundary_crack_share_at_peak", "share of cracks between mineral grains at the peak", display::percent(1),
              "cracks between mineral grains over all cracks up to the peak", tests_with::minerals,
              NeedsBesidesCurve::cracks, InStudies{"boundary_cracks"}),
  row::figure(&TestResults::n_events_at_peak, evaluation::n_events_at_peak, "n_events_at_peak",
              "events of acoustic emission up to the peak", display::plain(0),
              "breaks near each other in place and time", tests_with::one_peak),
  row::figure(&TestResults::b_value, evaluation::b_value, "b_value", "b-value of the emission up to the peak",
              display::plain(2),
              "fall of log10 of the number of events with the moment magnitude, by the mean magnitude",
              tests_with::one_peak, InStudies{"b_value"}),
  row::figure(&TestResults::b_value_error, evaluation::b_value_error, "b_value_error", "error of the b-value",
              display::plain(2), "standard deviation (Shi and Bolt 1982)", tests_with::one_peak),
  row::figure(&TestResults::b_positive, evaluation::b_positive, "b_positive", "b-value by rises of the magnitude",
              display::plain(2), "b-positive (van der Elst 2021)", tests_with::one_peak),
  row::figure(&TestResults::fracture_toughness, evaluation::fracture_toughness, "fracture_toughness_Pa_sqrt_m",
              "fracture toughness", ShownIn{"MPa √m", mega, 3}, "stress intensity K_IC at the peak", tests_with::notch,
              PageColumn::where_given, InStudies{"toughness"}),
  row::figure(&TestResults::fracture_energy, evaluation::fracture_energy, "fracture_energy_J_per_m2",
              "work of fracture", ShownIn{"J/m²", 1.0, 1},
              "work of the load until it has fallen to a tenth of its peak, over the ligament", tests_with::notch,
              InStudies{"work_of_fracture"}),
  row::figure(&TestResults::normal_stress_at_peak, evaluation::normal_stress_at_peak, "normal_stress_at_peak_Pa",
              "normal stress at the peak", display::megapascals(), "on the sheared plane, compression positive",
              tests_with::sheared_plane),
  row::figure(&TestResults::dilation_angle, evaluation::dilation_angle, "dilation_angle_rad", "dilation angle",
              display::degrees,
              "of the sheared plane: slope of opening over shear displacement from the strength to the end",
              tests_with::sheared_plane),
  row::figure(&TestResults::sliding_angle, evaluation::sliding_angle, "sliding_angle_rad",
              "friction angle on the plate", display::degrees,
              "arctangent of shear over normal stress where the shear stress is highest", tests_with::tilted_plate,
              PageColumn::where_given),
  row::figure(&TestResults::first_cracks_at_pads_share, evaluation::first_cracks_at_pads_share,
              "first_cracks_at_pads_share", "first cracks of a disc that is split, share at its pads",
              display::percent(0),
              "of the first third of the cracks up to the peak, those at the pads, where the disc is crushed",
              tests_with::split_disc, NeedsBesidesCurve::cracks, at_most(most_first_cracks_at_pads)),
  row::figure(&TestResults::n_fragments, evaluation::n_fragments, "n_fragments", "fragments", display::plain(0),
              "of two grains or more, at the end", tests_with::grains),
  row::figure(&TestResults::largest_fragment_share, evaluation::largest_fragment_share, "largest_fragment_share",
              "largest fragment", display::percent(1), "share of the grains' volume, at the end", tests_with::grains),
  row::number(&SpecimenReport::n_grains, QuantityOf::specimen, "n_grains", "grains", display::plain(0),
              "of the body; of a sample, of a representative volume"),
  row::number(&SpecimenReport::n_joints, QuantityOf::specimen, "n_joints", "joints", display::plain(0),
              "the smooth ones among them"),
  row::number(&SpecimenReport::n_smooth_joints, QuantityOf::specimen, "n_smooth_joints", "smooth joints",
              display::plain(0), "of flaws and of the boundaries of mineral grains"),
  row::number(&SpecimenReport::n_clumps, QuantityOf::specimen, "n_clumps", "clumps", display::plain(0),
              "rigid groups of grains, single grains among them; 0: each grain moves for itself"),
  row::number(&SpecimenReport::coordination_number, QuantityOf::specimen, "coordination_number", "coordination number",
              display::plain(3), "joints of a grain"),
  row::number(&SpecimenReport::coordination_number_core, QuantityOf::specimen, "coordination_number_core",
              "coordination number in the bulk", display::plain(2),
              "the same of grains more than three mean diameters from the walls",
              NanMeans{"no grain lies more than three mean diameters from the walls"}),
  row::number(&SpecimenReport::installation_gap_ratio, QuantityOf::specimen, "installation_gap_ratio",
              "installation gap over mean radius", display::plain(4), "largest gap between grains that got a joint"),
  row::number(&SpecimenReport::porosity, QuantityOf::specimen, "porosity", "porosity", display::plain(3),
              "share of the body that is no grain"),
  row::number(&SpecimenReport::mean_overlap_ratio, QuantityOf::specimen, "mean_overlap_ratio",
              "mean overlap over mean radius", display::plain(5), "of overlapping pairs of grains"),
  row::number(&SpecimenReport::resolution, QuantityOf::specimen, "resolution", "width over mean grain diameter",
              display::plain(1), "of the body"),
  row::number(&SpecimenReport::radius_multiplier, QuantityOf::specimen, "radius_multiplier",
              "radii over those of the input", display::plain(4), "factor by which genesis scaled the drawn radii"),
  row::number(&SpecimenReport::n_cut_joints, QuantityOf::specimen, "n_cut_joints", "joints cut", display::plain(0),
              "by coring; 0 of a specimen that was packed between walls"),
  row::number(&SpecimenReport::n_removed_grains, QuantityOf::specimen, "n_removed_grains", "grains removed",
              display::plain(0), "that coring left without a connection to the rest of the body"),
  row::number(&TestResults::energy_imbalance, QuantityOf::method, "energy_imbalance",
              "energy imbalance over the sum of all terms", display::percent(2),
              "energy unaccounted for at the end, over the sum of the sizes of all terms", NanMeans{without_energies}),
  row::number(&TestResults::energy_imbalance_over_work, QuantityOf::method, "energy_imbalance_over_work",
              "energy imbalance over boundary work", display::percent(2),
              "energy unaccounted for at the end, over the work of the boundaries", PageColumn::always, at_most(1e-2),
              NanMeans{without_energies}),
  row::figure(&TestResults::kinetic_to_strain_energy, evaluation::kinetic_to_strain_energy, "kinetic_to_strain_energy",
              "kinetic over strain energy, largest over the rows up to the peak", display::percent(3),
              "from 5 % of the peak deviator on", QuantityOf::method, tests_with::motion, NeedsBesidesCurve::motion,
              at_most(1e-2)),
  row::figure(&TestResults::unbalanced_force_ratio, evaluation::unbalanced_force_ratio, "unbalanced_force_ratio",
              "unbalanced over contact force, mean over the rows up to the peak", display::percent(3),
              "mean unbalanced over mean contact force, from 5 % of the peak deviator on", QuantityOf::method,
              NeedsBesidesCurve::motion, at_most(1e-2)),
  row::figure(&TestResults::end_stress_difference, evaluation::end_stress_difference, "end_stress_difference",
              "difference of the end stresses over the peak, largest over the rows", display::percent(1),
              "over the peak deviator, from 5 % of it on", QuantityOf::method, NeedsBesidesCurve::motion,
              at_most(5e-2)),
  row::figure(&TestResults::p_wave_transits_to_peak, evaluation::p_wave_transits_to_peak, "p_wave_transits_to_peak",
              "P-wave transits up to the peak", display::plain(0),
              "time up to the peak over the time in which a P-wave crosses the body", QuantityOf::method,
              tests_with::uniform_stress, NeedsBesidesCurve::motion, at_least(20.0)),
  row::figure(&TestResults::stress_rate_error, evaluation::stress_rate_error, "stress_rate_error",
              "stress beside that of the machine under load control, largest over the rows up to the peak",
              display::percent(1), "over the peak deviator, from 5 % of it on", QuantityOf::method,
              tests_with::load_control, NeedsBesidesCurve::motion, at_most(5e-2)),
  row::figure(&TestResults::servo_error, evaluation::servo_error, "servo_error",
              "servo error of the confinement, mean over the rows up to the peak", display::percent(2),
              "mean magnitude of lateral stress / pressure - 1", QuantityOf::method, at_most(1e-2)),
  row::figure(&TestResults::servo_error_largest, evaluation::servo_error_largest, "servo_error_largest",
              "servo error of the confinement, largest over the rows up to the peak", display::percent(1),
              "largest magnitude of the same", QuantityOf::method, at_most(3e-2)),
  row::number(&RunBookkeeping::largest_residual, QuantityOf::method, "largest_residual",
              "unbalanced over internal force of a sample, largest of its steps", display::percent(5),
              "residual of Newton's method at the end of a step, both forces as Euclidean norms", at_most(1e-3),
              NanMeans{"of samples of finite elements only"}),
  row::number(&RunBookkeeping::steps, QuantityOf::effort, "steps", "steps", display::plain(0),
              "in time; of a sample, equilibria"),
  row::number(&RunBookkeeping::time_step, QuantityOf::effort, "time_step_s", "time step", display::plain(3),
              "the last one", NanMeans{without_time}),
  row::number(&RunBookkeeping::wall_time, QuantityOf::effort, "wall_time_s", "wall time", ShownIn{"s", 1.0, 0},
              "of the test", PageColumn::always)};

constexpr const TestQuantity& quantity_of(const TestQuantity::Member member)
{
  for (const TestQuantity& one : test_quantities)
    if (one.member == member)
      return one;
  throw "the table has no such quantity";
}

namespace row
{
/// A property that tests of one kind give, by the title and unit of its quantity unless `further` has others.
template <typename... Further>
constexpr RockProperty measured(const std::string_view key, const PropertySource source, const double least,
                                const double most, Figure TestResults::*figure, const Further&... further)
{
  const TestQuantity& quantity = quantity_of(figure);
  RockProperty made{key, source, least, most, figure, quantity.title, quantity.shown, {quantity.shown.scale}};
  (made.set(further), ...);
  return made;
}

/// A property that is given or follows from several tests.
constexpr RockProperty derived(const std::string_view key, const PropertySource source, const double least,
                               const double most, const std::string_view title, const ShownIn& shown,
                               const std::optional<ResponseScale>& scale = {})
{
  return {key, source, least, most, nullptr, title, shown, {shown.scale}, scale};
}
} // namespace row

/// Properties of a rock, in the order of comparisons, source by source.
inline constexpr RockProperty rock_properties[] = {
  row::derived("density_kg_per_m3", PropertySource::given, 500.0, 10000.0, "density", ShownIn{"kg/m³", 1.0, 0}),
  row::measured("tensile_strength_MPa", PropertySource::tension, 1e-3, 1000.0, &TestResults::peak_stress,
                "tensile strength", display::megapascals(2), ResponseScale::strength),
  row::measured("strain_at_tensile_peak", PropertySource::tension, 1e-7, 0.1, &TestResults::strain_at_peak,
                "strain at tensile peak", ShownIn{"1e-4", 1e-4, 2}, KeyIn{1.0}),
  row::measured("uniaxial_compressive_strength_MPa", PropertySource::compression, 0.25 /* below it is a soil */, 5000.0,
                &TestResults::peak_stress, "uniaxial compressive strength", ResponseScale::strength),
  row::derived("tension_to_compression", PropertySource::fit, 1e-4, 1.0, "tensile over compressive strength",
               display::plain(3)),
  row::measured("strain_at_compressive_peak", PropertySource::compression, 1e-6, 0.2, &TestResults::strain_at_peak,
                "strain at peak, compression", KeyIn{1.0}),
  row::measured("youngs_modulus_GPa", PropertySource::compression, 1e-3, 1000.0, &TestResults::youngs_modulus_tangent,
                ResponseScale::modulus, Choice{"tangent"}),
  row::measured("youngs_modulus_GPa", PropertySource::compression, 1e-3, 1000.0, &TestResults::youngs_modulus_initial,
                ResponseScale::modulus, Choice{"initial"}),
  row::measured("youngs_modulus_GPa", PropertySource::compression, 1e-3, 1000.0, &TestResults::youngs_modulus_secant,
                ResponseScale::modulus, Choice{"secant", true}),
  row::measured("poissons_ratio", PropertySource::compression, -1.0, 1.0, &TestResults::poissons_ratio_secant,
                ResponseScale::none, Choice{"secant"}),
  row::measured("poissons_ratio", PropertySource::compression, -1.0, 1.0, &TestResults::poissons_ratio_initial,
                ResponseScale::none, Choice{"initial"}),
  row::measured("crack_initiation_stress_MPa", PropertySource::compression, 1e-2, 5000.0,
                &TestResults::crack_initiation_stress, ResponseScale::strength),
  row::measured("crack_initiation_stress_lateral_MPa", PropertySource::compression, 1e-2, 5000.0,
                &TestResults::crack_initiation_stress_lateral),
  row::measured("crack_damage_stress_MPa", PropertySource::compression, 1e-2, 5000.0, &TestResults::crack_damage_stress,
                ResponseScale::strength),
  row::measured("brazilian_strength_MPa", PropertySource::indirect_tension, 1e-3, 1000.0, &TestResults::peak_stress,
                "Brazilian strength", display::megapascals(2), ResponseScale::strength),
  row::measured("fracture_toughness_MPa_sqrt_m", PropertySource::notch, 1e-3, 100.0, &TestResults::fracture_toughness),
  row::measured("fracture_energy_J_per_m2", PropertySource::notch, 1e-2, 1e5, &TestResults::fracture_energy),
  row::measured("plate_friction_angle_deg", PropertySource::tilt, 0.1, 89.0, &TestResults::sliding_angle),
  row::derived("friction_angle_deg", PropertySource::fit, 1.0, 89.0, "friction angle, Mohr-Coulomb", display::degrees),
  row::derived("cohesion_MPa", PropertySource::fit, 1e-3, 2000.0, "cohesion, Mohr-Coulomb", display::megapascals()),
  row::derived("direct_shear_friction_angle_deg", PropertySource::fit, 1.0, 89.0, "friction angle, direct shear",
               display::degrees),
  row::derived("direct_shear_cohesion_MPa", PropertySource::fit, 0.0 /* without a filling */, 2000.0,
               "cohesion, direct shear", display::megapascals(2)),
  row::derived("m_i", PropertySource::fit, 0.1, 200.0, "m_i of Hoek and Brown", display::plain(1),
               ResponseScale::ratio)};

/// The first of a key.
constexpr const RockProperty& rock_property(const std::string_view key)
{
  for (const RockProperty& one : rock_properties)
    if (one.key == key)
      return one;
  throw "the table has no such property";
}
} // namespace feldspar
