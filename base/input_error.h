#pragma once

#include <stdexcept>

namespace feldspar
{
/// The user's mistake, reported in one line: what, where, what is allowed. The command ends with exit code 2.
struct InputError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};
} // namespace feldspar
