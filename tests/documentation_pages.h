#pragma once

#include <filesystem>
#include <vector>

namespace feldspar::tests
{
/// All pages of the tree that a reader has: those at its root and below docs, examples and benchmarks.
inline std::vector<std::filesystem::path> documentation_pages(const std::filesystem::path& root)
{
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(root))
    if (entry.path().extension() == ".md")
      found.push_back(entry.path());
  for (const char* folder : {"docs", "examples", "benchmarks"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md")
        found.push_back(entry.path());
  return found;
}
} // namespace feldspar::tests
