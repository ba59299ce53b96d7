#pragma once

#include <string>

namespace feldspar
{
/// Goes on as another program of Feldspar, which lies beside this one, with the same command line: statistics (OpenTURNS, with
/// a second HDF5 and a second MUMPS) and finite elements (deal.II) take tenths of a second to load, and no command carries
/// them that does not use them. Throws InputError.
[[noreturn]] void go_on_as(const std::string& program);

/// Refuses, by InputError, to be the other program of another version, which a build that did not come to its end
/// leaves there. Every program calls it at its start.
void check_version_of_caller();
} // namespace feldspar
