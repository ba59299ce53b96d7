#include "base/hdf5_archive.h"

#include "base/whole_file.h"

#include <stdexcept>

namespace feldspar
{
namespace
{
/// The bytes of a file that `write` fills. In memory, because the library hides why a disk refused them, and does not
/// get over it.
std::string image_of(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  try
    {
      constexpr std::size_t growth = std::size_t(1) << 20;
      H5::FileAccPropList in_memory;
      in_memory.setCore(growth, false);
      const H5::H5File out(file.string(), H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, in_memory);
      {
        Hdf5Writer writer(out.openGroup("/"));
        write(writer);
      }
      out.flush(H5F_SCOPE_GLOBAL);
      const ssize_t size = H5Fget_file_image(out.getId(), nullptr, 0);
      std::string image(std::size_t(std::max(ssize_t(0), size)), '\0');
      if (size <= 0 || H5Fget_file_image(out.getId(), image.data(), image.size()) != size)
        throw std::runtime_error(fmt::format("{}: HDF5 gives no image of the file", file.string()));
      return image;
    }
  catch (const H5::Exception& error) // which is no std::exception
    {
      throw std::runtime_error(fmt::format("{}: {}", file.string(), error.getDetailMsg()));
    }
}
} // namespace

void write_hdf5(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write)
{
  write_whole_file(file, image_of(file, write));
}

void read_hdf5(const std::filesystem::path& file, const std::string& expected,
               const std::function<void(Hdf5Reader&)>& read)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  std::string problem = "no such file";
  if (std::filesystem::is_regular_file(file))
    try
      {
        const H5::H5File in(file.string(), H5F_ACC_RDONLY);
        Hdf5Reader reader(in.openGroup("/"));
        read(reader);
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
} // namespace feldspar
