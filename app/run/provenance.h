#pragma once

#include "app/input/input.h"
#include "results/runs/run.h"

#include <filesystem>

namespace feldspar
{
/// Version, input as understood, machine.
Provenance provenance(const Input& input, const std::filesystem::path& input_file);
} // namespace feldspar
