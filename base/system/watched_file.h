#pragma once

#include <H5Cpp.h>

#include <functional>
#include <string>

namespace feldspar
{
/// Writes an HDF5 file by `write` into an empty file that is open for reading and writing, an array at a time, without an
/// image of it in memory. Returns 0 or the error number of the system. `name` stands in the message of a runtime_error, for
/// what the library cannot do. Under the lock of the library.
int make_hdf5(int descriptor, const std::string& name, const std::function<void(const H5::Group&)>& write);
} // namespace feldspar
