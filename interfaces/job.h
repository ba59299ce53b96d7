#pragma once

#include "interfaces/points.h"

#include <string>

/// The input of a material, for interfaces to all codes.
namespace feldspar::interfaces
{
/// The input of a material in the working folder; names in the input of a job may have lost their case. Throws Error.
std::string input_file_of(const std::string& material);
} // namespace feldspar::interfaces
