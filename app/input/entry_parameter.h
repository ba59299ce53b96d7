#pragma once

#include "app/input/parameter_table.h"

#include <string_view>

namespace feldspar
{
/// Makes a parameter of the input from an entry beside its struct: text to values in SI, and back.
Parameter parameter_of(std::string_view section, const Entry<Input>& entry);
} // namespace feldspar
