#pragma once

#include "report/pictures/picture.h"
#include "results/emission.h"
#include "results/fits/strength_envelopes.h"
#include "results/folder/calibration_record.h"
#include "results/folder/reference.h"
#include "results/runs/series.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// The figures of a report. Each is a function in a source of its own, declared and listed here; the page and the folder
/// show them in the order of the lists. A function returns no picture where its results have none.
namespace feldspar
{
using Pictures = std::vector<Picture>;

// Curves: the tests of one kind and under the same pressures in all series.
struct SeriesGroup;
using FigureOfSameTests = Pictures(const std::vector<SeriesGroup>&);
FigureOfSameTests stress_picture;      ///< stress over axial, lateral and volumetric strain
FigureOfSameTests crack_count_picture; ///< broken segments
FigureOfSameTests energy_picture;      ///< partition of the energy in one of the series
FigureOfSameTests crack_rate_picture;  ///< cracks and released energy per strain
FigureOfSameTests emission_picture;    ///< stress, hits and their energy, each over its highest
FigureOfSameTests magnitude_picture;   ///< number of events of acoustic emission over their magnitude
FigureOfSameTests source_picture;      ///< mechanisms of the events in a Hudson plot
inline constexpr std::array curve_figures{stress_picture,     crack_count_picture, energy_picture, emission_picture,
                                          crack_rate_picture, magnitude_picture,   source_picture};

// One test, under a title.
using FigureOfTest = Pictures(const FinishedTest&, const std::string&);
FigureOfTest crack_map;      ///< at crack initiation, peak and end; of finite elements a damage_map()
FigureOfTest damage_map;     ///< broken segments at each point of a sample
FigureOfTest fragment_map;   ///< grains at the end, coloured by the size of their fragment
FigureOfTest sample_picture; ///< cells of finite elements, displaced, by the share of their segments that broke
FigureOfTest rve_picture;    ///< grains and cracks of a few representative volumes of a sample
inline constexpr std::array crack_figures{crack_map};
inline constexpr std::array fragment_figures{fragment_map};
inline constexpr std::array sample_figures{sample_picture, rve_picture};

// One series, the n-th of all.
struct SeriesAmong
{
  const std::vector<Series>& all;
  std::size_t n;
  const StrengthEnvelopes& envelopes; ///< of this one
  const std::optional<Reference>& reference;

  const Series& series() const { return all[n]; }
};
using FigureOfSeries = Pictures(const SeriesAmong&);
FigureOfSeries envelope_pictures;     ///< strengths over confinement, the whole range and near the uniaxial test
FigureOfSeries mohr_picture;          ///< Mohr circles with the envelopes and the direct shear tests
FigureOfSeries compression_curves;    ///< stress over axial strain at every confinement
FigureOfSeries residual_picture;      ///< strength of each point less that of each envelope
FigureOfSeries rose_picture;          ///< directions of the crack normals, weighted by length
FigureOfSeries fragment_size_picture; ///< share of the volume in fragments smaller than a size
inline constexpr std::array strength_figures{envelope_pictures, mohr_picture};
inline constexpr std::array confinement_figures{compression_curves};
inline constexpr std::array residual_figures{residual_picture};
inline constexpr std::array crack_figures_of_series{rose_picture, fragment_size_picture};

// All series.
struct AllSeries
{
  const std::vector<Series>& all;
  const std::vector<StrengthEnvelopes>& envelopes; ///< of each
  const std::optional<Reference>& reference;
};
using FigureOfAll = Pictures(const AllSeries&);
FigureOfAll combined_envelope_picture; ///< strengths of several series, each with its envelope
FigureOfAll p_q_picture;               ///< q = σ₁ − σ₃ over the mean stress p = (σ₁ + σ₂ + σ₃)/3
FigureOfAll shear_share_picture;       ///< share of shear cracks at the peak over confinement
inline constexpr std::array strength_figures_of_all{combined_envelope_picture, p_q_picture};
inline constexpr std::array crack_figures_of_all{shear_share_picture};

/// Number of events over their magnitude above completeness of catalogues that a laboratory has recorded, beside that of the
/// model's tests.
Pictures catalogue_picture(const std::vector<Series>& all, const std::vector<EmissionCatalogue>& catalogues);

/// Results over each entry that takes two numbers or more: mean and standard deviation over the seeds, a line for each
/// test of the programme. Where other entries take several values too, each of their combinations has lines of its own;
/// entries that go along with the number have none. Where no two tests differ in one entry alone, as in a table of
/// samples, points without lines. More than six lines are shown by the kind of test, and thinned out. Over two entries a map.
Pictures study_pictures(const std::vector<Series>& all);

/// Every pair of sampled parameters, with the histogram of each.
Pictures pair_picture(const CalibrationRecord& record);

/// The stress–strain curve and the crack maps of every test.
Pictures single_test_pictures(const Series& series);

/// The pictures of all functions of a list.
template <typename Figures, typename... Arguments>
Pictures pictures_of(const Figures& figures, const Arguments&... arguments)
{
  Pictures all;
  for (const auto figure : figures)
    for (Picture& picture : figure(arguments...))
      all.push_back(std::move(picture));
  return all;
}
} // namespace feldspar
