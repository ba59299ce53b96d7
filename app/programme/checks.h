#pragma once

#include "app/input/input.h"
#include "base/body.h"
#include "results/folder/reference.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Inputs that a command cannot run: all that can be told before any work. Each function throws InputError, with the
/// input's name in front where an entry of it is wrong.
namespace feldspar
{
/// Runs a check, and puts the name of the input in front of what it refuses.
void with_name_of(const std::filesystem::path& input_file, const std::function<void()>& check);

/// Does some work. Returns what it refuses by InputError; empty: nothing.
std::string refusal_of(const std::function<void()>& work);

/// The reference of an input, if it names one; a file that does not serve is reported by its own name.
std::optional<Reference> reference_of(const Input& input);

/// Refuses clumps and mineral grains in representative volumes, which do not have them; to be called before the check
/// of the shape, which is another for them.
void check_no_groups(const Input& input);

/// Representative volumes find equilibria event by event, which not every joint law allows.
void check_equilibria(const SpecimenParameters& specimen, std::string_view remedy);

/// Checks the boundary of representative volumes.
void check_boundary(const Input& input);

/// A remark for each entry of section Tests that is set, and is of none of the tests.
std::vector<std::string> entries_without_effect(const std::vector<Variant>& variants);

/// Refuses tests that are not made on specimens of this shape, and entries that have no use there.
void check_on_body(const Input& input, Body body);

/// A specimen that grains can be tested on in the laboratory, and tests that can be made on it.
void check_specimen_and_tests(const Input& input);

/// A specimen out of a file, which brought its own shape, for `feldspar lab`.
void check_specimen_of_file(const Input& input, BodyShape shape);

/// A specimen as the representative volume of `needed_by`: a cell that repeats itself.
void check_cell(BodyShape shape, std::string_view needed_by);

/// Refuses what an RVE cannot take that stands where it stood in its sample.
void check_rve_out_of_sample(const Input& input);

/// Checks an input of `feldspar lab`.
void check_laboratory_input(const Input& input, const std::filesystem::path& input_file);

/// Checks an input of `feldspar rve`.
void check_rve_input(const Input& input, const std::filesystem::path& input_file);
} // namespace feldspar
