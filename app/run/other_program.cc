#include "app/run/other_program.h"

#include "base/input_error.h"
#include "feldspar_version.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace feldspar
{
namespace
{
constexpr const char* version_of_caller = "FELDSPAR_VERSION_OF_CALLER";
} // namespace

void check_version_of_caller()
{
  const char* const wanted = std::getenv(version_of_caller);
  if (!wanted)
    return;
  const std::string of_caller = wanted;
  unsetenv(version_of_caller);
  if (of_caller != version)
    throw InputError("{} is of version {}, and feldspar of {}; build or install both anew",
                     std::filesystem::read_symlink("/proc/self/exe").string(), version, of_caller);
}

void go_on_as(const std::string& program)
{
  const std::filesystem::path file = std::filesystem::read_symlink("/proc/self/exe").replace_filename(program);
  std::ifstream command_line("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(command_line, word, '\0');)
    words.push_back(word);
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  setenv(version_of_caller, std::string(version).c_str(), 1);
  execv(file.c_str(), arguments.data());
  throw InputError("{}: cannot be run ({}); it is built and installed beside feldspar", file.string(),
                   std::strerror(errno));
}
} // namespace feldspar
