#pragma once

#include "report/pictures/sample_view.h"

#include <string>
#include <vector>

namespace feldspar
{
/// The cells of a sample in the plane of its picture, at rest and at each time displaced `scale` times, with every field of
/// them and the places of the RVEs: JSON for the page (report/page/sample.js). Empty of more than 20 000 cells.
std::string sample_data(const FinishedTest& test, const SampleView& view, const std::vector<SamplePiece>& pieces,
                        double scale);
} // namespace feldspar
