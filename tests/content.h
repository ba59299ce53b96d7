#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace feldspar::tests
{
/// The bytes of a file; empty where there is none.
inline std::string content(const std::filesystem::path& file)
{
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
} // namespace feldspar::tests
