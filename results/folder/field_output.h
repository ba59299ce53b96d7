#pragma once

#include "laboratory/appearance.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// Writes grains, cracks and events of acoustic emission along a test for ParaView and VTK: NAME_grains.pvd, NAME_cracks.pvd and
/// NAME_emission.pvd, time series over the axial strain (in percent, positive in the sense of the test; of a test that follows
/// stages over its steps) of the files in a folder NAME. Grains are points with their radii; cracks are seen as they are, lines in
/// the plane and squares in space; events are points with the columns of emission.csv, from their first break on. `group`: what
/// the groups of grains are called, where there are any. Throws OutputError.
void write_fields(const std::string& name, const TestKind& kind, const std::vector<Crack>& cracks,
                  const std::vector<EmissionEvent>& events, const TestAppearance& appearance,
                  const std::filesystem::path& folder, const std::string& group = "mineral_grain");
} // namespace feldspar
