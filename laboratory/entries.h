#pragma once

#include "laboratory/own_entries.h"

#include <vector>

/// The entries of all laboratory tests.
namespace feldspar
{
/// The entry of tests between platens, or on a plate.
inline std::vector<Entry<TestParameters>> platen_entries()
{
  return {entry::number(
    "Platen friction", &TestParameters::platen_friction, ranges::from_zero,
    "coefficient of the platens in compression. 0: smooth, as in the flat-joint paper; those of a laboratory hold the "
    "ends of a specimen, and raise the uniaxial strength most",
    tests_flags::as_basic(tests_flags::of_grains))};
}

/// The entry of tests with a pressure, or a weight, that is raised before they begin.
inline std::vector<Entry<TestParameters>> seating_entries()
{
  return {entry::number("Seating transits", &TestParameters::seating_transits, {'(', 0.0, 1e4, ']'},
                        "travel times of a wave along the specimen over which the confinement is raised",
                        tests_flags::of_grains)};
}

/// The entries of section Tests that every test takes.
inline std::vector<Entry<TestParameters>> common_test_entries()
{
  using P = TestParameters;
  using namespace tests_flags;
  const EntryFlags of_grains_alike{.bodies = of_grains.bodies, .needs = of_grains.needs};
  const EntryFlags varies{.varies = true};
  return {
    entry::integer(
      "Snapshots", &P::n_snapshots, {'[', 2.0, 1000.0, ']'},
      "states of the grains kept in the folder fields, at most; the start and the end are among them; above 100 000 "
      "grains fewer, in inverse proportion to their number, but not below 4",
      as_basic(of_grains_alike)),
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
