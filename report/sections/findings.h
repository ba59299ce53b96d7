#pragma once

#include "report/page/page.h"
#include "report/pictures/figures.h"
#include "report/sections/comparison.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Largest number of series that a page shows in full. With more series, each is a row of its tables, and only so many
/// have pictures. So many of a small rock take some 5 MB of the 10 MB of a page.
inline constexpr std::size_t most_series_in_full = 12;

/// Everything that sections are made of, computed once. The series and references that it refers to must outlive it.
struct Findings
{
  const std::vector<Series>& all;
  const std::vector<Series>& pictured; ///< those of them that are in full, in pictures of several
  const std::optional<Reference>& reference;
  const std::string& reference_problem;
  bool one_folder;
  std::vector<std::vector<ComparisonRow>> comparisons; ///< of each series
  std::vector<StrengthEnvelopes> envelopes;            ///< of each series
  std::vector<std::string> repeats = {};               ///< sentences on entries of a study that have no effect
  const CalibrationRecord* calibration = nullptr;      ///< of which the first series tests the answer
  std::vector<EmissionCatalogue> catalogues = {};      ///< of acoustic emission, recorded in a laboratory

  bool has_several() const { return all.size() > 1; }
  /// Returns whether the series are the variants of one run.
  bool is_study() const { return one_folder && has_several() && !all.front().tests.front().settings.empty(); }
  bool has_many() const { return all.size() > most_series_in_full; }

  /// Returns whether the n-th series has blocks and pictures of its own: one of the first, or measured on rock.
  bool is_in_full(std::size_t n) const
  {
    return n < most_series_in_full || all[n].kind == SeriesKind::laboratory_curve;
  }

  SeriesAmong among(std::size_t n) const { return {all, n, envelopes[n], reference}; }

  /// Envelopes of the pictured series.
  std::vector<StrengthEnvelopes> pictured_envelopes() const;

  /// A block that says which series pictures show, and `others`, a sentence; empty where all are there.
  std::vector<PageBlock> remark_on_pictures(const std::string& others) const;

  /// Text that tells the files of the n-th series apart; empty for a single series.
  std::string ending_of_files(std::size_t n) const;

  /// The heading of what belongs to the n-th of several series; an empty block of a single one.
  PageBlock heading_of(std::size_t n) const;

  /// A title of a picture or a test, with the series where there are several: `Direct tension, out`.
  std::string titled(const std::string& title, const Series& series) const;
};
} // namespace feldspar
