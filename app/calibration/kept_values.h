#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar::calibration
{
/// Figures that came out of one piece of work; none where a test has not given its own.
using KeptValues = std::vector<std::optional<double>>;

/// n values, if the file is there and was written under this identity (run_identity()). Else the work is to be done again.
/// Throws InputError for a file that was changed since: its seal (base/checksum/seal.h) tells.
std::optional<KeptValues> read_values(const std::filesystem::path& file, const std::string& identity, std::size_t n);

/// All or nothing, to the last bit, with a seal.
void write_values(const std::filesystem::path& file, const std::string& identity, const KeptValues& values);
} // namespace feldspar::calibration
