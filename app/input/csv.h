#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// The first line of a table, without the byte-order mark that spreadsheets set before it. Throws InputError.
std::string read_csv_header(const std::filesystem::path& file);

/// Reads a table of numbers whose first line is `header`; [rows][columns]. The decimal sign is a point in every locale.
/// Throws InputError with file and line.
std::vector<std::vector<double>> read_csv(const std::filesystem::path& file, std::string_view header);
} // namespace feldspar
