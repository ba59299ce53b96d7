#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace feldspar::tests
{
/// A fresh folder that goes with all that is in it.
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "feldspar-test-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw std::runtime_error("no temporary folder");
    folder = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(folder); }

  const std::filesystem::path& path() const { return folder; }
  operator const std::filesystem::path&() const { return folder; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return folder / name; }

  std::filesystem::path write(const std::string_view name, const std::string_view text) const
  {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }

private:
  std::filesystem::path folder;
};

/// Makes the locale de_DE.UTF-8, whose decimal sign is a comma, in a folder to be named by LOCPATH.
inline void make_german_locale(const std::filesystem::path& folder)
{
  const std::string command =
    "localedef -c -i de_DE -f UTF-8 " + (folder / "de_DE.UTF-8").string() + " >/dev/null 2>&1";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("the locale de_DE.UTF-8 cannot be made; is the package locales installed?");
}
} // namespace feldspar::tests
