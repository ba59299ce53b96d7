#include "base/system/hdf5_archive.h"

#include "base/checksum/seal.h"
#include "base/readable_file.h"
#include "base/system/child_process.h"
#include "base/system/watched_file.h"
#include "base/whole_file.h"

#include <sys/mman.h>

#include <mutex>
#include <stdexcept>

namespace feldspar
{
namespace
{
std::mutex of_library; // which is not made for several threads at once

/// Writes an HDF5 file with its notice into an empty open file. Returns 0 or the error number of the system. The caller
/// holds the lock of the library.
int fill(const int descriptor, const std::string& name, const std::function<void(const H5::Group&)>& write)
{
  return make_hdf5(descriptor, name, [&](const H5::Group& root) {
    std::uint32_t sealed = 1;
    Hdf5Writer(root).value(std::string(seal_notice), sealed);
    write(root);
  });
}

void write_sealed_hdf5(const std::filesystem::path& file, const std::function<void(const H5::Group&)>& write)
{
  write_whole_file(file, [&](const int descriptor) {
    std::unique_lock lock(of_library);
    H5::Exception::dontPrint();
    const int error = fill(descriptor, file.string(), write);
    lock.unlock();
    return error != 0 ? error : append_seal(descriptor);
  });
}

void copy_array(const H5::DataSet& array, const std::string& name, const H5::Group& to)
{
  const H5::DataType type = array.getDataType();
  const H5::DataSpace shape = array.getSpace();
  std::vector<char> values(array.getInMemDataSize());
  array.read(values.data(), type);
  H5::DSetCreatPropList properties;
  forget_times(properties);
  to.createDataSet(name, type, shape, properties).write(values.data(), type);
}

/// Throws InputError for what is wrong in the file, without its name.
void read_from(const std::filesystem::path& file, const std::uint64_t size, const std::string& expected,
               const std::function<void(Hdf5Reader&)>& use, std::optional<H5::Group> copy = {},
               const H5::FileAccPropList& access = H5::FileAccPropList::DEFAULT)
{
  try
    {
      const H5::H5File in(file.string(), H5F_ACC_RDONLY, H5::FileCreatPropList::DEFAULT, access);
      Hdf5Reader reader(in.openGroup("/"), size, std::move(copy));
      use(reader);
    }
  catch (const H5::Exception&)
    {
      throw InputError("not an HDF5 file, cut short, or not {}", expected);
    }
}

/// A copy of what `use` reads, as the bytes of a file, which this program wrote. Throws InputError for what is wrong in the
/// file, without its name. Under the lock.
std::string copy_by_child(const std::filesystem::path& file, const std::string& expected,
                          const std::function<void(Hdf5Reader&)>& use, const std::function<void()>& check)
{
  const std::uint64_t size = std::filesystem::file_size(file);
  constexpr std::uint64_t megabyte = std::uint64_t(1) << 20;
  // Limits with much to spare: a second reads some 500 MB.
  const ProcessLimits limits{2 + size / (10 * megabyte), 256 * megabyte + 16 * size};
  return made_by_child(
    "the HDF5 library", limits,
    [&] {
      const int copy = memfd_create("copy", 0);
      if (copy < 0 ||
          fill(copy, file.string(), [&](const H5::Group& root) { read_from(file, size, expected, use, root); }) != 0)
        throw InputError("cannot be read safely: there is no memory for a copy");
      return content_of(fmt::format("/proc/self/fd/{}", copy));
    },
    check);
}

/// `foreign`: how a file without a seal is read; where there is none it is refused.
void read(const std::filesystem::path& file, const std::string& expected, const std::function<void(Hdf5Reader&)>& use,
          const std::function<void()>& foreign)
{
  const std::lock_guard lock(of_library);
  H5::Exception::dontPrint();
  try
    {
      if (const std::string objection = objection_to_reading(file); !objection.empty())
        throw InputError(objection);
      // Before HDF5 sees it, which is not made for damaged files.
      const Seal seal = examine_seal(file);
      if (seal == Seal::broken)
        throw InputError("damaged or cut short: its content is not that of its checksum");
      if (seal == Seal::none && !foreign)
        throw InputError("damaged or cut short, or not of this version of the program: it has no checksum");
      if (seal == Seal::none)
        foreign();
      else
        read_from(file, std::filesystem::file_size(file), expected, use);
    }
  catch (const InputError& error)
    {
      throw InputError("{}: {}; {} is expected", file.string(), error.what(), expected);
    }
}
} // namespace

void write_hdf5(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write)
{
  write_sealed_hdf5(file, [&](const H5::Group& root) {
    Hdf5Writer writer(root);
    write(writer);
  });
}

void seal_hdf5(const std::filesystem::path& file)
{
  write_sealed_hdf5(file, [&](const H5::Group& root) {
    try
      {
        const H5::H5File written(file.string(), H5F_ACC_RDONLY);
        for (hsize_t k = 0; k < written.getNumObjs(); ++k)
          copy_array(written.openDataSet(written.getObjnameByIdx(k)), written.getObjnameByIdx(k), root);
      }
    catch (const H5::Exception& error)
      {
        throw OutputError(fmt::format("{}: cannot be sealed: {}", file.string(), error.getDetailMsg()));
      }
  });
}

void read_hdf5(const std::filesystem::path& file, const std::string& expected,
               const std::function<void(Hdf5Reader&)>& use)
{
  read(file, expected, use, nullptr);
}

void read_foreign_hdf5(const std::filesystem::path& file, const std::string& expected,
                       const std::function<void(Hdf5Reader&)>& use, const std::function<void()>& check)
{
  read(file, expected, use, [&] {
    const std::string image = copy_by_child(file, expected, use, check);
    H5::FileAccPropList in_memory;
    in_memory.setCore(std::size_t(1) << 20, false);
    if (H5Pset_file_image(in_memory.getId(), const_cast<char*>(image.data()), image.size()) < 0)
      throw std::runtime_error(fmt::format("{}: HDF5 takes no image of the file", file.string()));
    // An image has a name under which there is no file.
    read_from(file / "copy", image.size(), expected, use, {}, in_memory);
  });
}
} // namespace feldspar
