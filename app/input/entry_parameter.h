#pragma once

#include "app/input/parameter_table.h"

#include <string_view>

namespace feldspar
{
/// From an entry beside its struct to a parameter of the input: text to values in SI, and back.
Parameter parameter_of(std::string_view section, const Entry<Input>& entry);
} // namespace feldspar
