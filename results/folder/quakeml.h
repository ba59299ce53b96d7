#pragma once

#include "results/runs/series.h"

#include <ctime>
#include <filesystem>
#include <string_view>
#include <vector>

namespace feldspar
{
/// The place on earth of the origin of a body's axes, and the time at which the strain of its test is zero.
struct QuakemlOrigin
{
  double latitude;  ///< positive in the north [deg]
  double longitude; ///< positive in the east [deg]
  double depth;     ///< [m]
  std::time_t time; ///< UTC
};

/// Reads `41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z`. Throws InputError.
QuakemlOrigin parse_quakeml_origin(std::string_view text);

/// Writes the events of acoustic emission of each test into FOLDER/TEST.xml, as QuakeML, Basic Event Description 1.2: origins,
/// moment tensors and magnitudes. x points to the east, y to the north, z up; in the plane x to the east and y up. Throws
/// InputError where there are none, and OutputError.
void write_quakeml(const std::vector<Series>& all, const QuakemlOrigin& origin, const std::filesystem::path& folder);
} // namespace feldspar
