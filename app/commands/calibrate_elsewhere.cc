#include "app/commands/commands.h"
#include "base/input_error.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace feldspar
{
/// The command in the program that has the statistics, with the same words. OpenTURNS brings a second HDF5, a second MUMPS
/// and a tenth of a second to each start; no other command carries them.
int run_calibrate(const CommonOptions& /*options*/)
{
  const std::filesystem::path program =
    std::filesystem::read_symlink("/proc/self/exe").replace_filename("feldspar-calibrate");
  std::ifstream command_line("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(command_line, word, '\0');)
    words.push_back(word);
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw InputError(fmt::format("{}: cannot be run ({}); it is built and installed beside feldspar", program.string(),
                               std::strerror(errno)));
}
} // namespace feldspar
