#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
struct CommandWithInput
{
  std::string_view name;
  bool tests_rock;
};

/// The commands that take an input file.
inline constexpr std::array commands_with_input{
  CommandWithInput{"lab", true},       CommandWithInput{"rve", true},       CommandWithInput{"multiscale", true},
  CommandWithInput{"calibrate", true}, CommandWithInput{"specimen", false}, CommandWithInput{"contact", true}};

/// `feldspar parameters --check INPUT`: whether a command would take the input, by the checks that it makes itself before
/// any work. Without a command says of all of them which do, and throws InputError where none that tests rock does.
void check_input(const std::filesystem::path& file, const std::vector<std::string>& settings,
                 const std::string& command);
} // namespace feldspar
