#pragma once

#include <string>

namespace feldspar
{
/// Goes on as another program of Feldspar, which lies beside this one, with the same command line: statistics (OpenTURNS)
/// and finite elements (deal.II) take tenths of a second to load, and no command carries them that does not use them.
/// Throws InputError.
[[noreturn]] void go_on_as(const std::string& program);
} // namespace feldspar
