#pragma once

#include "dem/whole_file.h"

namespace feldspar
{
/// Writes a file whole or not at all, by way of a temporary one. Throws OutputError, which names file and cause.
inline void write_text_file(const std::filesystem::path& file, const std::string_view text)
{
  write_whole_file(file, text);
}
} // namespace feldspar
