#pragma once

#include "dem/specimen.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace feldspar
{
/// Writes specimen.h5 whole or not at all (by way of a temporary file).
template <int dim>
void write_specimen(const Specimen<dim>& specimen, const std::filesystem::path& file);

/// specimen.h5, or with several specimens in one folder specimen_seed_7.h5.
std::string specimen_file_name(std::uint64_t seed, std::size_t n_specimens);

/// Reads what write_specimen wrote. Throws InputError where the file is missing, foreign, cut short or inconsistent.
template <int dim>
Specimen<dim> read_specimen(const std::filesystem::path& file);
} // namespace feldspar
