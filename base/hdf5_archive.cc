#include "base/hdf5_archive.h"

#include "base/seal.h"
#include "base/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <system_error>

namespace feldspar
{
namespace
{
void add_notice(const H5::Group& root)
{
  std::uint32_t sealed = 1;
  Hdf5Writer(root).value(std::string(seal_notice), sealed);
}

/// A file that HDF5 writes by way of us. Its own driver hides why a disk refuses bytes, and the library does not get over
/// a write that failed. This one notes the first error and lets all later writes pass for done.
struct WatchedFile
{
  H5FD_t of_library; ///< first, as the library asks
  int descriptor;
  int* error; ///< number of the system's first, 0 while there is none
  haddr_t end_of_addresses;
  haddr_t end_of_file;
};

/// How a WatchedFile is opened.
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

/// In the order of the file as HDF5's own driver of files has it.
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
                     std::size_t size, const void* const buffer)
{
  WatchedFile& into = watched(file);
  into.end_of_file = std::max(into.end_of_file, address + size);
  const auto* from = static_cast<const char*>(buffer);
  for (auto to = off_t(address); size > 0 && *into.error == 0;)
    if (const ssize_t n = pwrite(into.descriptor, from, size, to); n >= 0)
      {
        from += n;
        to += n;
        size -= std::size_t(n);
      }
    else if (errno != EINTR)
      *into.error = errno;
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

/// Fills a file by `write`, without an image of it in memory. Returns 0 or the error number of the system.
int fill(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0)
    return errno;
  int error = 0;
  const WatchedDriver driver;
  try
    {
      const WatchedAccess how{descriptor, &error};
      H5::FileAccPropList access;
      access.setDriver(driver.number, &how);
      H5::H5File out(file.string(), H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, access);
      {
        const H5::Group root = out.openGroup("/");
        add_notice(root);
        Hdf5Writer writer(root);
        write(writer);
      }
      out.close();
    }
  catch (const H5::Exception& problem) // which is no std::exception
    {
      if (error == 0)
        {
          close(descriptor);
          throw std::runtime_error(fmt::format("{}: {}", file.string(), problem.getDetailMsg()));
        }
    }
  catch (...)
    {
      close(descriptor);
      throw;
    }
  if (close(descriptor) != 0 && error == 0)
    error = errno;
  return error;
}

void read(const std::filesystem::path& file, const std::string& expected, const bool may_lack_seal,
          const std::function<void(Hdf5Reader&)>& use)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  std::string problem = "no such file";
  if (std::filesystem::is_regular_file(file))
    try
      {
        // Before HDF5 sees it, which is not made for damaged files.
        const Seal seal = examine_seal(file);
        if (seal == Seal::broken)
          throw InputError("damaged or cut short: its content is not that of its checksum");
        if (seal == Seal::none && !may_lack_seal)
          throw InputError("damaged or cut short, or not of this version of the program: it has no checksum");
        const H5::H5File in(file.string(), H5F_ACC_RDONLY);
        Hdf5Reader reader(in.openGroup("/"), std::filesystem::file_size(file));
        use(reader);
        return;
      }
    catch (const H5::Exception&)
      {
        problem = fmt::format("not an HDF5 file, cut short, or not {}", expected);
      }
    catch (const InputError& error)
      {
        problem = error.what();
      }
  throw InputError(fmt::format("{}: {}; {} is expected", file.string(), problem, expected));
}
} // namespace

void write_hdf5(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write)
{
  write_whole_file(file, [&](const std::filesystem::path& unfinished) {
    const int error = fill(unfinished, write);
    return error != 0 ? error : append_seal(unfinished);
  });
}

void seal_hdf5(const std::filesystem::path& file)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  try
    {
      const H5::H5File opened(file.string(), H5F_ACC_RDWR);
      add_notice(opened.openGroup("/"));
    }
  catch (const H5::Exception& error)
    {
      throw OutputError(fmt::format("{}: cannot be sealed: {}", file.string(), error.getDetailMsg()));
    }
  if (const int error = append_seal(file); error != 0)
    throw OutputError(fmt::format("{}: cannot be sealed: {}", file.string(), std::generic_category().message(error)));
}

void read_hdf5(const std::filesystem::path& file, const std::string& expected,
               const std::function<void(Hdf5Reader&)>& use)
{
  read(file, expected, false, use);
}

void read_foreign_hdf5(const std::filesystem::path& file, const std::string& expected,
                       const std::function<void(Hdf5Reader&)>& use)
{
  read(file, expected, true, use);
}
} // namespace feldspar
