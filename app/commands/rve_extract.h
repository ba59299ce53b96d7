#pragma once

#include <filesystem>
#include <string>

namespace feldspar
{
/// `feldspar multiscale --extract CELL:POINT`: of every test in the folder of a run the RVE at that point, in the state
/// of the last row that was kept. FOLDER/extracted/TEST_cell_C_point_P.h5 is what `feldspar rve` takes as Specimen file,
/// and .xdmf beside it what ParaView shows, in the axes of the sample. Returns the exit code; throws InputError.
int extract_rve(const std::filesystem::path& folder, const std::string& cell_and_point, bool quiet);
} // namespace feldspar
