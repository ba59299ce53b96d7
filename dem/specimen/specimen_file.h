#pragma once

#include "dem/specimen/specimen.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace feldspar
{
class Hdf5Writer;

/// Writes specimen.h5 whole or not at all (by way of a temporary file). `made_of`: a name for what it was made of, or empty. `more` may add to it what read_specimen() does not look at.
template <int dim>
void write_specimen(const Specimen<dim>& specimen, const std::filesystem::path& file, const std::string& made_of = {},
                    const std::function<void(Hdf5Writer&)>& more = {});

/// Reads what write_specimen wrote. Throws InputError where the file is missing, foreign, cut short or inconsistent. `check`
/// is called while a file without a seal is read and may throw to end it.
template <int dim>
Specimen<dim> read_specimen(
  const std::filesystem::path& file, const std::function<void()>& check = [] {});

/// Checks a specimen beyond types, for a file whose bytes may come from anywhere. Throws InputError, which says what is wrong.
template <int dim>
void check_specimen(const Specimen<dim>& specimen);

struct SpecimenHead
{
  std::uint32_t dimension; ///< 2 or 3
  std::uint64_t n_grains;
  std::string made_of; ///< as of whoever wrote the file; empty where it is not told
};

/// Reads nothing else of a file. Throws InputError, and calls `check`, as read_specimen().
SpecimenHead head_of_specimen(
  const std::filesystem::path& file, const std::function<void()>& check = [] {});
} // namespace feldspar
