#pragma once

#include "laboratory/curve.h"
#include "laboratory/kinds.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// Writes the fields that a test on finite elements has left in FOLDER (results/sample_fields.h) once more, as ParaView and VTK
/// read them by default: NAME.pvd, a time series over the strain of the test (in percent, positive in its sense; of a test that
/// follows stages over the rows of its curve) of the files in a folder NAME, and NAME_paraview.py, which shows them. The
/// displacement is a vector of the nodes; stress, strain and crack orientation are tensors of the cells. A section has r for x,
/// its axis for y. Throws InputError where there are no fields, OutputError.
void write_sample_fields(const std::string& name, const TestKind& kind, const std::vector<CurveSample>& curve,
                         const std::filesystem::path& folder);
} // namespace feldspar
