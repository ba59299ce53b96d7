#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace feldspar
{
/// Limits of what a child process may use.
struct ProcessLimits
{
  std::uint64_t seconds;      ///< of processor time
  std::uint64_t bytes_beyond; ///< of memory, beyond what the program has when the child begins
};

/// Text that `work` makes in a child process, for work that may crash or find no end. `check` is called while the child
/// works and may throw to end it. Throws InputError with what `work` threw, or says how `worker` (the library that reads a damaged
/// file) came to its end; runtime_error where there is no child to be had.
std::string made_by_child(const std::string& worker, const ProcessLimits& limits,
                          const std::function<std::string()>& work, const std::function<void()>& check);
} // namespace feldspar
