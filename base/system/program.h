#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace feldspar
{
/// The end of a program that was started.
enum class ProgramEnd
{
  done,
  failed, ///< or there is no such program
  hung,
  called_off
};

/// Runs a program in a folder, without a shell, with a process group of its own so that what it starts ends with it. Its
/// output goes into a file. A program that takes longer than `longest`, or runs when is_over() says so, is ended.
ProgramEnd run_program(std::vector<std::string> command, const std::filesystem::path& folder,
                       std::chrono::milliseconds longest, const std::function<bool()>& is_over,
                       const std::filesystem::path& output = "/dev/null");

/// Returns whether PATH has a program of this name.
bool is_installed(const std::string& program);
} // namespace feldspar
