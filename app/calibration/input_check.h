#pragma once

#include "app/input/input.h"

#include <filesystem>

namespace feldspar::calibration
{
/// Refuses what `feldspar calibrate` cannot run, before any work; throws InputError. It needs no statistics, so that the
/// program without them can ask it too.
void check_input(const Input& input, const std::filesystem::path& input_file);
} // namespace feldspar::calibration
