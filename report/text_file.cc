#include "report/text_file.h"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

namespace feldspar
{
void write_text_file(const std::filesystem::path& file, const std::string_view text)
{
  std::filesystem::path unfinished = file;
  unfinished += ".unfinished";
  std::ofstream out(unfinished, std::ios::binary);
  out << text;
  out.close();
  if (!out)
    {
      std::error_code ignored;
      std::filesystem::remove(unfinished, ignored);
      throw std::runtime_error(fmt::format("{} cannot be written: is the disk full?", file.string()));
    }
  std::filesystem::rename(unfinished, file);
}
} // namespace feldspar
