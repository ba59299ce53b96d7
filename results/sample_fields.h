#pragma once

#include "laboratory/appearance.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace feldspar
{
/// Reads FOLDER/NAME.xdmf and what it names of the last time. Throws InputError, one line, where a file is missing or cannot be
/// read.
SampleFields read_sample_fields(const std::filesystem::path& folder, const std::string& name);

/// Reads the same of all times before the last, as long as they have at most `most_cells` together; else of none.
std::vector<SampleFields> read_earlier_sample_fields(const std::filesystem::path& folder, const std::string& name,
                                                     std::size_t most_cells);

/// Reads the same of every time, from the first on, one at a time.
void for_each_time(const std::filesystem::path& folder, const std::string& name,
                   const std::function<void(const SampleFields&)>& use);
} // namespace feldspar
