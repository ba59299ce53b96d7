#pragma once

#include "results/emission.h"

#include <filesystem>

namespace feldspar
{
/// Reads the acoustic emission that a laboratory has recorded: a table (base/table/csv.h) with a row for each event or hit; time,
/// strain or stress, and magnitude, amplitude or energy, each with its unit: `amplitude [dB]` (docs/laboratory-data.md). Throws
/// InputError, one line with file and line.
EmissionCatalogue read_emission_catalogue(const std::filesystem::path& file);
} // namespace feldspar
