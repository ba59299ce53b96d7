#pragma once

#include "laboratory/record.h"

#include <optional>
#include <string_view>
#include <vector>

/// What a catalogue of acoustic emission tells; docs/theory.md §4.14.
namespace feldspar
{
/// The mechanism of an event, by its moment tensor. In the plane the eigenvalue across the plane is not known: it is taken as the mean
/// of the other two, so that no share is CLVD, and left out of the scalar moment.
struct SourceMechanism
{
  double scalar_moment; ///< M_0 = (Σ m²/2)^½ [N m]
  double magnitude;     ///< M_w = ⅔ log10 M_0 − 6.07, M_0 in N m (Hanks and Kanamori 1979); NaN without a moment
  double isotropic;     ///< shares of the moment (Vavryčuk 2015), of magnitudes that add up to 1; an explosion > 0
  double clvd;          ///< compensated linear vector dipole
  double double_couple;
  std::string_view kind; ///< tensile, shear or implosive, by ±30 % of Feignier and Young (1992); empty without a moment
};

SourceMechanism mechanism(const EmissionEvent& event, int dimension);

/// M_e = ⅔ log10 E − 2.9, E in J (Choy and Boatwright 1995), of the energy that the breaks released; NaN without any.
double energy_magnitude(const EmissionEvent& event);

/// The fall of the number of events with their magnitude: log10 N = a − b M.
struct MagnitudeFrequency
{
  double
    completeness; ///< magnitude from which on events count: the lower end of the fullest tenth (Wiemer and Wyss 2000)
  double b;       ///< by the mean magnitude (Aki 1965, Utsu 1965)
  double error;   ///< standard deviation of b (Shi and Bolt 1982)
  double b_positive; ///< by the rises from each event to the next (van der Elst 2021)
  std::size_t n;     ///< events that count
};

/// The events of a test from one share of its peak deviator to another, before the peak; of a test without a peak, `strain_at_peak`
/// (positive in the sense of the test) is none, and so are they.
std::vector<EmissionEvent> events_between(const TestRecord& record, const std::optional<double>& strain_at_peak,
                                          double from, double to);

/// Of magnitudes in the order of the events; none with fewer than 30 that count.
std::optional<MagnitudeFrequency> magnitude_frequency(const std::vector<double>& magnitudes);
} // namespace feldspar
