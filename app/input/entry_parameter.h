#pragma once

#include "app/input/parameter_table.h"

#include <string>
#include <string_view>

namespace feldspar
{
/// Makes a parameter of the input from an entry beside its struct: text to values in SI, and back.
Parameter parameter_of(const std::string& section, const Entry<Input>& entry);

/// Reads a number in SI; its range is given in `unit`. Throws InputError, which says the range and `or_else`.
double read_number(std::string_view text, Measure measure, std::string_view unit, const Range& range,
                   std::string_view or_else = "");

/// The path of a file that an entry names; empty where it names none. Throws InputError where it cannot be read.
std::string readable_file(const Input& input, std::string_view text);
} // namespace feldspar
