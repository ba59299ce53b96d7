#pragma once

#include "report/page/page.h"
#include "report/sections/comparison.h"
#include "results/fits/strength_envelopes.h"
#include "results/folder/reference.h"
#include "results/series.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Everything that sections are made of, computed once. What it refers to outlives it.
struct Findings
{
  const std::vector<Series>& all;
  const std::optional<Reference>& reference;
  const std::string& reference_problem;
  bool one_folder;
  std::vector<std::vector<ComparisonRow>> comparisons; ///< of each series
  std::vector<StrengthEnvelopes> envelopes;            ///< of each series

  bool has_several() const { return all.size() > 1; }

  /// Nothing of a single series, else something that tells the files of the n-th apart.
  std::string ending_of_files(std::size_t n) const;

  /// The heading of what belongs to the n-th of several series; an empty block of a single one.
  PageBlock heading_of(std::size_t n) const;

  /// A title of a picture or a test, with the series where there are several: `Direct tension, out`.
  std::string titled(const std::string& title, const Series& series) const;
};
} // namespace feldspar
