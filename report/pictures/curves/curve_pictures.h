#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/series.h"

#include <string>
#include <vector>

namespace feldspar
{
/// The pictures of one test of the programme: the tests of one kind and pressure.
struct GroupPictures
{
  std::string title;
  bool on_page; ///< else as files only
  std::vector<Picture> pictures;
};

/// For each test of the programme: stress against axial, lateral and volumetric strain, the count of cracks, the
/// partition of the energy and the crack rate, each over all series. Means as lines, standard deviations as bands,
/// single tests thin behind them.
std::vector<GroupPictures> curve_pictures(const std::vector<Series>& all);
} // namespace feldspar
