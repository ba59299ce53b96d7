#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// `feldspar parameters --check INPUT`: whether a command would take the input, by the checks that it makes itself before
/// any work. Without a command says of all of them which do, and throws InputError where none that tests rock does.
void check_input(const std::filesystem::path& file, const std::vector<std::string>& settings,
                 const std::string& command);
} // namespace feldspar
