#pragma once

#include "app/input/input.h"
#include "coupling/network/network.h"

#include <filesystem>
#include <string>
#include <vector>

/// Inputs that `feldspar multiscale` cannot run, as those of other commands in checks.h.
namespace feldspar
{
/// Refuses, for a sample, an RVE that stands where it stood in another: a sample begins with intact ones.
template <int dim>
void check_intact(const Input& input, const Network<dim>& network);

/// Checks an input of `feldspar multiscale` as far as no mesh is needed.
void check_sample_entries(const Input& input, const std::filesystem::path& input_file);

/// Checks all of an input of `feldspar multiscale`. MPI is up. Collective; returns remarks that a user should know.
std::vector<std::string> check_sample_input(const Input& input, const std::filesystem::path& input_file);
} // namespace feldspar
