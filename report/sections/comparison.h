#pragma once

#include "results/folder/calibration_record.h"
#include "results/folder/reference.h"
#include "results/runs/run.h"
#include "results/statistics.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Verdict on a mean beside the range of the experiment. It rests on the 95 % interval of the mean by Student's t.
enum class RangeVerdict
{
  within,     ///< the mean lies in the range
  outside,    ///< neither the mean nor any part of its interval lies there
  not_decided ///< the mean lies outside; its interval reaches into the range, or one specimen has none
};

/// Name in tables: within, outside, not decided.
std::string name(RangeVerdict verdict);

/// One property of the rock: ours beside the references, all in `unit`.
struct ComparisonRow
{
  std::string property;
  std::string unit;
  int decimals;
  std::optional<Statistics> ours;      ///< over the seeds
  std::optional<ReferenceValue> model; ///< of the paper
  std::optional<ReferenceValue> experiment;
  std::string key = {};         ///< of a reference file; empty where it has no such property
  std::string why_missing = {}; ///< of ours, where its tests were made

  /// The deviation of our mean from that of the experiment, over the latter; none without either.
  std::optional<double> deviation() const;
  /// Returns whether our mean lies in the range of the experiment; none without either.
  std::optional<bool> in_range() const;
  /// The verdict on our mean; none without either.
  std::optional<RangeVerdict> against_range() const;
  /// Returns whether all of the 95 % interval of our mean lies in that range; none without either or from one specimen.
  std::optional<bool> surely_in_range() const;
};

/// Sets the results of one rock beside a reference; without one its columns stay empty. `elastic` says which modulus and
/// which ratio the reference has. `beside_flaws`: it stands beside a body with flaws, so that its strengths are called as
/// theirs are, highest nominal stresses.
std::vector<ComparisonRow> compare(const std::vector<FinishedTest>& tests, const std::optional<Reference>& reference,
                                   const ElasticFigures& elastic = {}, bool beside_flaws = false);

/// A figure of a reference as the row writes numbers: mean (low to high), or a dash; with the unit behind, before a number
/// of tests.
std::string as_text(const ComparisonRow& row, const std::optional<ReferenceValue>& value, const std::string& unit = "");

/// Properties that the experiment gives and no test of these rows was made for, by their names in the reference file.
/// The density is not among them, because it is given to a model.
std::vector<std::string> properties_without_a_test(const std::vector<ComparisonRow>& rows,
                                                   const std::optional<Reference>& reference);

/// Sentences on properties that the experiment gives and these rows do not: why tests gave no figure, and which
/// properties were not tested.
std::vector<std::string> sentences_on_missing(const std::vector<ComparisonRow>& rows,
                                              const std::optional<Reference>& reference);

/// The comparison for a terminal, with these sentences.
std::string as_text(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference);

/// These sentences for a terminal; empty where there are none.
std::string text_of_missing(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference);
} // namespace feldspar
