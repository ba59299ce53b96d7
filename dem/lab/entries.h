#pragma once

#include "base/entries.h"
#include "dem/lab/parameters.h"

#include <vector>

/// The entries of the laboratory tests.
namespace feldspar
{
/// The entries of section Tests.
inline std::vector<Entry<TestParameters>> test_entries()
{
  using P = TestParameters;
  const EntryFlags varies{.varies = true};
  const EntryFlags of_grains{.varies = true,
                             .bodies = {Body::plane_box, Body::box, Body::cylinder},
                             .needs = "is of tests on specimens of grains"};
  const EntryFlags of_grains_alike{.bodies = of_grains.bodies, .needs = of_grains.needs};
  const EntryFlags of_platens{.bodies = {Body::plane_box, Body::box, Body::cylinder, Body::sample},
                              .needs = "is of tests on bodies between platens"};
  const EntryFlags of_cylinder{.varies = true,
                               .bodies = {Body::cylinder},
                               .needs = "goes round a cylinder of grains: Shape = cylinder, Dimension = 3"};
  const EntryFlags of_box{.varies = true,
                          .bodies = {Body::box},
                          .needs = "presses on two sides of a box of grains in space: Shape = box, Dimension = 3"};
  const EntryFlags in_space{.varies = true,
                            .bodies = {Body::box, Body::cylinder},
                            .needs = "is the length of a disc in space, Dimension = 3; in the plane discs have none"};
  const auto as_basic = [](EntryFlags flags) {
    flags.basic = true;
    return flags;
  };
  const Range sampling{'(', 0.0, 0.01, ']'}; // a curve of two rows to the peak tells nothing
  return {
    entry::quantity("Compression strain rate", &P::compression_strain_rate, Measure::rate, "1/s", ranges::above_zero,
                    "magnitude", as_basic(of_grains)),
    entry::quantity("Tension strain rate", &P::tension_strain_rate, Measure::rate, "1/s", ranges::above_zero,
                    "magnitude", as_basic(of_grains)),
    entry::quantity("Brazilian strain rate", &P::brazilian_strain_rate, Measure::rate, "1/s", ranges::above_zero,
                    "of the loaded diameter; magnitude", as_basic(of_grains)),
    entry::number("Compression sampling strain", &P::compression_sampling_strain, sampling,
                  "axial strain between two rows of the curve", of_grains),
    entry::number("Tension sampling strain", &P::tension_sampling_strain, sampling,
                  "axial strain between two rows of the curve", of_grains),
    entry::number("Brazilian sampling strain", &P::brazilian_sampling_strain, sampling,
                  "strain of the diameter between two rows of the curve", of_grains),
    entry::quantity("Bending strain rate", &P::bending_strain_rate, Measure::rate, "1/s", ranges::above_zero,
                    "of the deflection over the depth of the bent body; magnitude", of_grains),
    entry::number("Bending sampling strain", &P::bending_sampling_strain, sampling,
                  "deflection over depth between two rows of the curve", of_grains),
    entry::number(
      "Notch ratio", &P::notch_ratio, {'[', 0.05, 0.8, ']'},
      "depth of the notch of a bent body over that of the body (over the radius of a half disc, "
      "which has a toughness from 0.4 to 0.6 only); of a centre-cracked plate the whole length of its crack over its width",
      of_grains),
    entry::quantity("Shear strain rate", &P::shear_strain_rate, Measure::rate, "1/s", ranges::above_zero,
                    "of the shear displacement over the length of the plane; magnitude", of_grains),
    entry::number("Shear sampling strain", &P::shear_sampling_strain, sampling,
                  "shear displacement over the length of the plane between two rows of the curve", of_grains),
    entry::optional_quantity("Shear normal stiffness", &P::shear_normal_stiffness, Measure::stiffness, "GPa/mm",
                             ranges::above_zero,
                             "of the rock around the plane of direct shear: the normal stress grows by this times the "
                             "opening of the box since its seating; none: the normal stress is constant",
                             of_grains),
    entry::file(
      "Loading table", &P::loading_table,
      "CSV of the stages of own_loading, a row each, with the columns axial_strain, axial_stress_Pa, hold_s, "
      "confining_pressure_Pa, strain_rate_per_s, lateral_strain; compression positive; on a sample of finite elements "
      "rates only say how long a strain takes beside a hold",
      as_basic(of_platens)),
    entry::integer("Snapshots", &P::n_snapshots, {'[', 2.0, 1000.0, ']'},
                   "states of the grains kept in the folder fields, at most; the start and the end are among them",
                   as_basic(of_grains_alike)),
    entry::number(
      "Platen friction", &P::platen_friction, ranges::from_zero,
      "coefficient of the platens in compression. 0: smooth, as in the flat-joint paper; those of a laboratory hold the "
      "ends of a specimen, and raise the uniaxial strength most",
      as_basic(of_grains)),
    entry::number("Seating transits", &P::seating_transits, {'(', 0.0, 1e4, ']'},
                  "travel times of a wave along the specimen over which the confinement is raised", of_grains),
    entry::choice("Lateral boundary", &P::lateral_boundary,
                  {{"wall", LateralBoundary::wall}, {"membrane", LateralBoundary::membrane}},
                  "of a cylinder in triaxial compression: a rigid wall held at the pressure, or the pressure "
                  "itself on the outer grains",
                  of_cylinder),
    entry::optional_quantity(
      "Intermediate stress", &P::intermediate_stress, Measure::stress, "MPa", ranges::above_zero,
      "on the second pair of sides of a box in three dimensions (true triaxial compression); none: "
      "the confinement",
      of_box),
    entry::number(
      "Brazilian length ratio", &P::brazilian_length_ratio, ranges::above_zero,
      "length of the disc, or half disc, that is cut from a cylinder over its diameter, in three dimensions", in_space),
    entry::number("Grip ratio", &P::grip_ratio, {'(', 0.0, 0.4, ']'}, "height of each grip over that of the specimen",
                  of_grains),
    entry::number(
      "Stop strain over peak strain", &P::stop_strain_over_peak_strain, {'(', 1.0, ranges::infinity, ')'},
      "a test stops at this many times the strain of its peak, once the stress has fallen after the peak; a test whose "
      "stress is rising goes on",
      as_basic(varies)),
    entry::optional_quantity(
      "Least peak stress", &P::least_peak_stress, Measure::stress, "MPa", ranges::from_zero,
      "a lower highest stress (beyond the confinement) is no peak. none: on grains twice ρ c × strain rate × "
      "height, which waves can bring about in a body that nothing holds (each platen sends a wave of a quarter of "
      "this, which the other platen doubles); on samples 0",
      varies),
    entry::number(
      "Least transits to peak", &P::least_transits_to_peak, ranges::from_zero,
      "a highest stress that comes before so many travel times of a wave along the specimen is no peak; after three "
      "to four of them the stress is uniform (Davies and Hunter 1963)",
      of_grains),
    entry::number(
      "Least fall after peak", &P::least_fall_after_peak, {'[', 0.0, 1.0, ')'},
      "a highest stress (beyond the confinement) is no peak if the stress then falls by less than this share of it, "
      "unless the curve stays level up to the end by the rule above. 0.05: single cracks and waves make smaller falls "
      "in a curve that rises",
      varies),
    entry::optional_number("Stop strain", &P::stop_strain, {'(', 0.0, 1.0, ']'},
                           "a test stops at this axial strain, instead of the rule above", varies),
    entry::optional_number(
      "Stop stress over peak", &P::stop_stress_over_peak, {'(', 0.0, 1.0, ')'},
      "a test stops when its deviator has fallen to this share of the peak's, instead of at a "
      "multiple of the strain there (a Brazilian disc: or at that multiple after its first fall); with Stop strain too, "
      "whichever comes first; a stage of own_loading "
      "towards a higher axial stress is given up when its stress, after cracks, has fallen back "
      "to this share of its rise in the stage, none: 0.5",
      varies)};
}
} // namespace feldspar
