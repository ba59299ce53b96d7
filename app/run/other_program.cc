#include "app/run/other_program.h"

#include "base/input_error.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace feldspar
{
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
  execv(file.c_str(), arguments.data());
  throw InputError(fmt::format("{}: cannot be run ({}); it is built and installed beside feldspar", file.string(),
                               std::strerror(errno)));
}
} // namespace feldspar
