#pragma once

#include "laboratory/curve.h"
#include "report/chart/chart.h"
#include "report/pictures/picture.h"
#include "results/runs/series.h"
#include "results/runs/test_groups.h"

#include <array>
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

  /// Returns whether the series counts cracks, and therefore energies.
  bool counts_cracks() const;
};

/// Tests of one kind and pressure, of every series that has them.
using SameTests = std::vector<SeriesGroup>;

using Quantity = std::function<double(const CurveSample&)>;

bool any_has_several(const SameTests& same);

/// The meaning of lines and bands, for captions: with one specimen there is nothing to average.
std::string means_of_several(const SameTests& same, bool shows_single_tests = false);

/// Name of the abscissa of a test, along which its quantities are followed, and label of its axis.
std::string abscissa_name(const SameTests& same);
std::string abscissa_label(const SameTests& same);

/// Adds a mean and, where there are deviations from its points, the band around it.
void add_mean(Chart& chart, ChartSeries mean, const std::vector<std::array<double, 2>>& deviations);

/// The picture of a chart: bands below thin lines, below the others, below those of the axis on the right. An empty
/// chart has none. The name of the picture begins with that of the tests.
std::vector<Picture> curve_picture(Chart chart, const SameTests& same, const std::string& ending,
                                   const std::string& caption, const std::string& alternative);

/// The curves in compression under one pressure, and their colour wherever they are drawn together.
struct ConfinedCurves
{
  TestGroup group;
  std::string colour;
};

/// Returns those of a series that have curves, by rising pressure.
std::vector<ConfinedCurves> confined_curves(const Series& series);

/// The pictures of one test of the programme: the tests of one kind and pressure.
struct GroupPictures
{
  std::string title;
  bool on_page; ///< else as files only
  std::vector<Picture> pictures;
};

/// Pictures of each test of the programme: stress against axial, lateral and volumetric strain, the count of cracks,
/// the partition of the energy and the crack rate, each over all series. Means as lines, standard deviations as bands,
/// single tests thin behind them.
std::vector<GroupPictures> curve_pictures(const std::vector<Series>& all);
} // namespace feldspar
