#include "coupling/rve/path_checkpoint.h"

#include "base/parameter_id.h"

namespace feldspar
{
void write_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                           const std::function<void(Hdf5Writer&)>& transfer)
{
  write_hdf5(file, [&](Hdf5Writer& root) {
    std::string of_run = identity;
    root.text("identity", of_run);
    transfer(root);
  });
}

void read_path_checkpoint(const std::filesystem::path& file, const std::string& identity,
                          const std::function<void(Hdf5Reader&)>& transfer)
{
  read_hdf5(file, "a checkpoint of " + in_words(Work::strain_path), [&](Hdf5Reader& root) {
    std::string of_run;
    root.text("identity", of_run);
    if (of_run != identity)
      throw InputError("of another input or program");
    transfer(root);
  });
}
} // namespace feldspar
