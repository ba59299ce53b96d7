#pragma once

#include <filesystem>
#include <string_view>

namespace feldspar
{
/// Writes a file whole or not at all, by way of a temporary one. Throws std::runtime_error.
void write_text_file(const std::filesystem::path& file, std::string_view text);
} // namespace feldspar
