#pragma once

#include "results/curve.h"
#include "results/runs/series.h"
#include "results/runs/test_groups.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace feldspar
{
/// The tests of one kind and pressure in one of the series.
struct SeriesGroup
{
  const Series* series;
  std::size_t n; ///< of the series
  TestGroup group;

  /// And energies.
  bool counts_cracks() const;
};

/// Of every series that has them.
using SameTests = std::vector<SeriesGroup>;

using Quantity = std::function<double(const CurveSample&)>;

bool any_has_several(const SameTests& same);

/// The meaning of lines and bands, for captions: with one specimen there is nothing to average.
std::string means_of_several(const SameTests& same, bool shows_single_tests = false);

/// Of what the quantities of a test are followed along, and of its axis.
std::string abscissa_name(const SameTests& same);
std::string abscissa_label(const SameTests& same);
} // namespace feldspar
