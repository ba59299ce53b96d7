#include "dem/hdf5_archive.h"

#include <stdexcept>
#include <system_error>

namespace feldspar
{
void write_hdf5(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  std::filesystem::path unfinished = file;
  unfinished += ".unfinished";
  try
    {
      H5::H5File out(unfinished.string(), H5F_ACC_TRUNC);
      {
        Hdf5Writer writer(out.openGroup("/"));
        write(writer);
      }
      // The destructor would keep a failure to itself, and much is written only now.
      out.flush(H5F_SCOPE_GLOBAL);
      out.close();
    }
  catch (...)
    {
      std::error_code ignored;
      std::filesystem::remove(unfinished, ignored);
      throw std::runtime_error(fmt::format("{} cannot be written: is the disk full?", file.string()));
    }
  std::filesystem::rename(unfinished, file);
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
