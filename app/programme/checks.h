#pragma once

#include "app/input/input.h"
#include "app/input/parameter_table.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Inputs that a command cannot run: all that can be told before any work. Each function throws InputError, with the
/// input's name in front where an entry of it is wrong.
namespace feldspar
{
/// Runs a check, and puts the name of the input in front of what it refuses.
void with_name_of(const std::filesystem::path& input_file, const std::function<void()>& check);

/// Refuses tests that are not made on specimens of this shape, and entries that have no use there.
void check_on_body(const Input& input, Body body);

/// A specimen that grains can be tested on in the laboratory, and tests that can be made on it.
void check_specimen_and_tests(const Input& input);

/// For `feldspar lab`.
void check_laboratory_input(const Input& input, const std::filesystem::path& input_file);

/// For `feldspar rve`.
void check_rve_input(const Input& input, const std::filesystem::path& input_file);

/// For `feldspar multiscale`. Collective; returns remarks that a user should know.
std::vector<std::string> check_sample_input(const Input& input, const std::filesystem::path& input_file);
} // namespace feldspar
