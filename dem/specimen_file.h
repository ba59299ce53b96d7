#pragma once

#include "dem/specimen.h"

#include <filesystem>

namespace feldspar
{
/// Writes specimen.h5 whole or not at all (by way of a temporary file).
template <int dim>
void write_specimen(const Specimen<dim>& specimen, const std::filesystem::path& file);

/// Reads what write_specimen wrote. Throws InputError where the file is missing, foreign, cut short or inconsistent.
template <int dim>
Specimen<dim> read_specimen(const std::filesystem::path& file);
} // namespace feldspar
