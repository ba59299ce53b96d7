#pragma once

#include "laboratory/record.h"

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Mechanisms, magnitudes and b-values of a catalogue of acoustic emission; docs/theory.md §4.14.
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

/// The magnitudes of events of one test, in their order; NaN without a moment.
std::vector<double> magnitudes_of(const std::vector<EmissionEvent>& events, int dimension);

/// The place of an event in the plot of Hudson, Pearce and Rogers (1989), by the eigenvalues M_1 ≥ M_2 ≥ M_3 over the largest
/// magnitude of them: u = −⅔ (M_1 + M_3 − 2 M_2), v = ⅓ (M_1 + M_2 + M_3). NaN without a moment.
struct HudsonPlace
{
  double u;
  double v;
};

HudsonPlace hudson_place(const EmissionEvent& event, int dimension);

/// M_e = ⅔ log10 E − 2.9, E in J (Choy and Boatwright 1995), of all the energy that the breaks released, of which a part is
/// radiated; NaN without any.
double energy_magnitude(double energy);

/// The fall of the number of events with their magnitude: log10 N = a − b M.
struct MagnitudeFrequency
{
  double
    completeness; ///< magnitude from which on events count: the lower end of the fullest tenth (Wiemer and Wyss 2000)
  double b;       ///< by the mean magnitude (Aki 1965, Utsu 1965)
  double error;   ///< standard deviation of b (Shi and Bolt 1982)
  double b_positive; ///< by the rises from each event that counts to the next (van der Elst 2021)
  std::size_t n;     ///< events that count
};

/// The events of a test before its peak, or those of them while the highest deviator so far lies between two shares of that at the
/// peak; none where there is no peak. `strain_at_peak`: positive in the sense of the test.
std::vector<EmissionEvent> events_up_to_peak(const TestRecord& record, const std::optional<double>& strain_at_peak,
                                             double from = -std::numeric_limits<double>::infinity(),
                                             double to = std::numeric_limits<double>::infinity());

/// The fall for magnitudes in the order of the events, those of several tests parted by NaN; none with fewer than 30 that count.
/// `step`: between magnitudes that are multiples of one, as of amplitudes in whole decibels; a magnitude stands for those within
/// half a step of it.
std::optional<MagnitudeFrequency> magnitude_frequency(const std::vector<double>& magnitudes, double step = 0.0);

/// An event or a hit that a laboratory has recorded.
struct RecordedEmission
{
  double stress;    ///< axial or deviator, as the file has it; NaN where it has none [Pa]
  double magnitude; ///< of an amplitude A/20, A in dB; of an energy as energy_magnitude(); NaN without energy
};

/// The acoustic emission of a laboratory, in the order of its file.
struct EmissionCatalogue
{
  std::string name;  ///< of its file
  std::string scale; ///< of its magnitudes, in words
  std::vector<RecordedEmission> events;

  /// Magnitudes of the events up to that with the highest stress; of a catalogue without stresses all.
  std::vector<double> magnitudes_to_peak() const;

  /// Smallest difference of two magnitudes, the step of those that are multiples of one.
  double step() const;
};
} // namespace feldspar
