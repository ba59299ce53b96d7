#pragma once

#include "results/runs/run.h"

#include <chrono>
#include <filesystem>
#include <string_view>

namespace feldspar
{
/// The place and the time on earth of the origin of a body's axes when the strain of its test is zero.
struct QuakemlOrigin
{
  double latitude;  ///< positive in the north [deg]
  double longitude; ///< positive in the east [deg]
  double depth;     ///< [m]
  std::chrono::sys_seconds time;
};

/// Reads `41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z`. Throws InputError.
QuakemlOrigin parse_quakeml_origin(std::string_view text);

/// Writes the events of acoustic emission of a test as QuakeML, Basic Event Description 1.2: origins, moment tensors and
/// magnitudes. x points to the east, y to the north, z up; in the plane x to the east and y up. Throws InputError for a time beyond
/// years, and OutputError.
void write_quakeml(const FinishedTest& test, const QuakemlOrigin& origin, const std::filesystem::path& file);
} // namespace feldspar
