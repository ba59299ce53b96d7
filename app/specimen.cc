#include "app/commands.h"
#include "app/input.h"
#include "app/interrupt.h"
#include "app/output_folder.h"
#include "app/progress.h"
#include "app/specimen_source.h"
#include "dem/specimen_file.h"

#include <fmt/format.h>

namespace feldspar
{
int run_specimen(const CommonOptions& options)
{
  const Input input = read_input(options.input);
  const OutputFolder folder(options.output, options.input, options.force);
  Progress progress(options.quiet);
  watch_for_interrupt();

  const auto specimens = provide_specimens<2>(input, progress);
  for (const auto& specimen : specimens)
    {
      const auto file = folder.path() / specimen_file_name(specimen.seed, specimens.size());
      write_specimen(specimen, file);
      if (!options.quiet)
        fmt::print("\nSeed {}\n{}", specimen.seed, describe(specimen.report));
      fmt::print("{}\n", file.string());
    }
  return 0;
}
} // namespace feldspar
