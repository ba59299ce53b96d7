#pragma once

#include "report/pictures/gnuplot.h"
#include "results/runs/run.h"

#include <string>
#include <vector>

namespace feldspar
{
/// A test in space as it stands: its cracks as discs of their size and direction at the peak and at the end, and the
/// fragments at the end, cut open at the mid-plane. Nothing of a test in the plane or one without grains.
std::vector<Picture> space_picture(const FinishedTest& test, const std::string& title);

/// The RVEs at points of a sample in space, each under its heading: the grains behind the mid-plane, with the cracks as
/// discs. Without name and texts.
Picture space_picture_of_rves(const std::vector<PointRve>& rves, const std::vector<std::string>& headings);
} // namespace feldspar
