#include "base/system/watched_file.h"

#include "base/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace feldspar
{
namespace
{
/// A file that HDF5 writes through the driver below. The library's own driver hides why a disk refuses bytes, and the
/// library does not recover from a write that failed. This driver keeps the first error and reports all later writes as
/// done.
struct WatchedFile
{
  H5FD_t of_library; ///< first, as the library asks
  int descriptor;
  int* error; ///< number of the system's first, 0 while there is none
  haddr_t end_of_addresses;
  haddr_t end_of_file;
};

/// Descriptor and place for the error with which a WatchedFile is opened.
struct WatchedAccess
{
  int descriptor;
  int* error;
};

WatchedFile& watched(H5FD_t* const file) { return *reinterpret_cast<WatchedFile*>(file); }
const WatchedFile& watched(const H5FD_t* const file) { return *reinterpret_cast<const WatchedFile*>(file); }

H5FD_t* open_watched(const char* /*name*/, unsigned /*flags*/, const hid_t access, haddr_t /*most*/)
{
  const auto& how = *static_cast<const WatchedAccess*>(H5Pget_driver_info(access));
  return &(new WatchedFile{{}, how.descriptor, how.error, 0, 0})->of_library;
}

herr_t close_watched(H5FD_t* const file)
{
  delete &watched(file);
  return 0;
}

/// Sets the features that HDF5's own driver of files has, so that both give a file the same order.
herr_t tell_features(const H5FD_t* /*file*/, unsigned long* const features)
{
  *features =
    H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t end_of_addresses(const H5FD_t* const file, H5FD_mem_t /*type*/) { return watched(file).end_of_addresses; }
haddr_t end_of_file(const H5FD_t* const file, H5FD_mem_t /*type*/) { return watched(file).end_of_file; }

herr_t set_end_of_addresses(H5FD_t* const file, H5FD_mem_t /*type*/, const haddr_t end)
{
  watched(file).end_of_addresses = end;
  return 0;
}

/// Bytes that were never written are zero.
herr_t read_watched(H5FD_t* const file, H5FD_mem_t /*type*/, hid_t /*transfer*/, const haddr_t address,
                    std::size_t size, void* const buffer)
{
  auto* to = static_cast<char*>(buffer);
  std::fill_n(to, size, '\0');
  for (auto from = off_t(address); size > 0;)
    if (const ssize_t n = pread(watched(file).descriptor, to, size, from); n > 0)
      {
        to += n;
        from += n;
        size -= std::size_t(n);
      }
    else if (n == 0 || errno != EINTR)
      break;
  return 0;
}

herr_t write_watched(H5FD_t* const file, H5FD_mem_t /*type*/, hid_t /*transfer*/, const haddr_t address,
                     const std::size_t size, const void* const buffer)
{
  WatchedFile& into = watched(file);
  into.end_of_file = std::max(into.end_of_file, address + size);
  if (*into.error == 0)
    *into.error = write_at(into.descriptor, address, {static_cast<const char*>(buffer), size});
  return 0;
}

/// The library may have taken addresses behind what it wrote last.
herr_t lengthen_watched(H5FD_t* const file, hid_t /*transfer*/, hbool_t /*closing*/)
{
  WatchedFile& into = watched(file);
  if (into.end_of_file != into.end_of_addresses && *into.error == 0 &&
      ftruncate(into.descriptor, off_t(into.end_of_addresses)) != 0)
    *into.error = errno;
  into.end_of_file = into.end_of_addresses;
  return 0;
}

/// The driver of watched files, known to HDF5 for as long as this lives.
class WatchedDriver
{
public:
  WatchedDriver()
  {
    H5FD_class_t driver{};
    driver.name = "feldspar";
    driver.maxaddr = haddr_t(std::numeric_limits<off_t>::max());
    driver.fc_degree = H5F_CLOSE_WEAK;
    driver.fapl_size = sizeof(WatchedAccess);
    driver.open = open_watched;
    driver.close = close_watched;
    driver.query = tell_features;
    driver.get_eoa = end_of_addresses;
    driver.set_eoa = set_end_of_addresses;
    driver.get_eof = end_of_file;
    driver.read = read_watched;
    driver.write = write_watched;
    driver.truncate = lengthen_watched;
    const H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(kinds), std::end(kinds), std::begin(driver.fl_map));
    number = H5FDregister(&driver);
  }
  WatchedDriver(const WatchedDriver&) = delete;
  WatchedDriver& operator=(const WatchedDriver&) = delete;
  ~WatchedDriver() { H5FDunregister(number); }

  hid_t number;
};

} // namespace

int make_hdf5(const int descriptor, const std::string& name, const std::function<void(const H5::Group&)>& write)
{
  int error = 0;
  const WatchedDriver driver;
  try
    {
      const WatchedAccess how{descriptor, &error};
      H5::FileAccPropList access;
      access.setDriver(driver.number, &how);
      H5::H5File out(name, H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, access);
      write(out.openGroup("/"));
      out.close();
    }
  catch (const H5::Exception& problem) // which is no std::exception
    {
      if (error == 0)
        throw std::runtime_error(fmt::format("{}: {}", name, problem.getDetailMsg()));
    }
  return error;
}
} // namespace feldspar
