#include "base/hdf5_archive.h"

#include "base/readable_file.h"
#include "base/seal.h"
#include "base/whole_file.h"

#include <stdexcept>

namespace feldspar
{
namespace
{
void add_notice(const H5::Group& root)
{
  std::uint32_t sealed = 1;
  Hdf5Writer(root).value(std::string(seal_notice), sealed);
}

/// The bytes of a file that `write` fills. In memory, because the library hides why a disk refused them, and does not
/// get over it.
std::string image_of(const std::filesystem::path& file, const std::function<void(const H5::Group&)>& write)
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
        const H5::Group root = out.openGroup("/");
        add_notice(root);
        write(root);
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

void write_sealed(const std::filesystem::path& file, const std::function<void(const H5::Group&)>& write)
{
  std::string image = image_of(file, write);
  image += seal_of(image);
  write_whole_file(file, image);
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

void read(const std::filesystem::path& file, const std::string& expected, const bool may_lack_seal,
          const std::function<void(Hdf5Reader&)>& use)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  std::string problem = objection_to_reading(file);
  if (problem.empty())
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
  write_sealed(file, [&](const H5::Group& root) {
    Hdf5Writer writer(root);
    write(writer);
  });
}

void seal_hdf5(const std::filesystem::path& file)
{
  write_sealed(file, [&](const H5::Group& root) {
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
  read(file, expected, false, use);
}

void read_foreign_hdf5(const std::filesystem::path& file, const std::string& expected,
                       const std::function<void(Hdf5Reader&)>& use)
{
  read(file, expected, true, use);
}
} // namespace feldspar
