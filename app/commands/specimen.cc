#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/programme/specimen_source.h"
#include "app/run/interrupt.h"
#include "app/run/output_folder.h"
#include "app/screen/print_result.h"
#include "app/screen/progress.h"
#include "base/contains.h"
#include "base/quoted.h"
#include "base/whole_file.h"
#include "dem/genesis/packing_export.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <vector>

namespace feldspar
{
namespace
{
template <int dim>
int make_specimens(const CommonOptions& options, const Input& input)
{
  const OutputFolder folder(options.output, options.input, write_over(options, places_of_specimens, input));
  const FolderLock lock(folder.path());
  const FileList list(folder.path());
  Progress progress(options.quiet);
  watch_for_interrupt(!options.quiet);

  const RunPlan plan(input);
  for (const SpecimenOrder& order : plan.orders) // with --force: one that lies there already is another input's
    std::filesystem::remove(folder.path() / (order.name + ".h5"));
  std::vector<Specimen<dim>> specimens;
  try
    {
      specimens = provide_specimens<dim>(plan, folder.path(), progress);
    }
  catch (const Interrupted&)
    {
      if (std::filesystem::is_empty(folder.path()))
        throw;
      fmt::print(stderr, "feldspar: interrupted; the finished specimens are kept in {}\n",
                 printable(folder.path().string()));
      return exit_code::interrupted;
    }
  for (std::size_t k = 0; k < specimens.size(); ++k)
    {
      if (!options.quiet)
        print_result("\nSeed {}\n{}{}", specimens[k].seed, describe(specimens[k].report), describe(specimens[k].flaws));
      print_result("{}\n", (folder.path() / (plan.orders[k].name + ".h5")).string());
      for (const PackingForm& form : packing_forms)
        if (contains(options.packings, form.name))
          {
            const auto file = folder.path() / "packings" / (plan.orders[k].name + std::string(form.ending));
            std::filesystem::create_directories(file.parent_path());
            write_whole_file(file, packing_text(specimens[k], form.name));
            print_result("{}\n", file.string());
          }
    }
  return 0;
}
} // namespace

int run_specimen(const CommonOptions& options)
{
  const Input input = read_input(options.input, {}, options.settings);
  return input.specimen.dimension == 2 ? make_specimens<2>(options, input) : make_specimens<3>(options, input);
}
} // namespace feldspar
