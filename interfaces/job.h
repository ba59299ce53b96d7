#pragma once

#include "interfaces/points.h"

#include <array>
#include <string>

/// The input of a material and the state variables of its points, for interfaces to all codes.
namespace feldspar::interfaces
{
/// The input of a material in the working folder; names in the input of a job may have lost their case. Throws Error.
std::string input_file_of(const std::string& material);

/// Numbers that a code keeps at a point: the token, then the fields of Damage.
inline constexpr std::size_t n_state_variables = 11;
std::array<double, n_state_variables> state_variables_of(const Answer& answer);
} // namespace feldspar::interfaces
