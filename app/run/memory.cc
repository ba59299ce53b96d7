#include "app/run/memory.h"

#include "base/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace feldspar
{
namespace
{
/// Of a grain with its joints, in genesis and in a test: the peak of `feldspar specimen` less that of a tiny one, over the
/// number of grains (75 000 discs, 9 000 spheres), rounded up [B].
double bytes_per_grain(const unsigned int dimension) { return dimension == 2 ? 2e3 : 6e3; }

/// Free memory of the machine, or what is left of the limit of the control group [B]; none where that is not told.
std::optional<double> free_memory()
{
  std::optional<double> least;
  const auto take = [&](const double bytes) { least = std::min(least.value_or(bytes), bytes); };
  std::ifstream machine("/proc/meminfo");
  double kilobytes = 0.0;
  for (std::string name; machine >> name >> kilobytes;)
    {
      if (name == "MemAvailable:")
        take(1024.0 * kilobytes);
      machine.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
  double limit = 0.0;
  double used = 0.0;
  // "max" is no number: no limit.
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit && std::ifstream("/sys/fs/cgroup/memory.current") >> used)
    take(std::max(0.0, limit - used));
  return least;
}
} // namespace

void check_memory(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders)
{
  const std::optional<double> free = free_memory();
  if (!free)
    return;
  double needed = 0.0;
  double n_largest = 0.0;
  for (const SpecimenOrder& order : orders)
    {
      const SpecimenParameters& specimen = variants[order.variants.front()].input.specimen;
      if (!specimen.packing_file.empty() || !specimen.specimen_file.empty())
        continue; // these bring their grains
      const double n = expected_grains(specimen);
      n_largest = std::max(n_largest, n);
      needed += n * bytes_per_grain(specimen.dimension);
    }
  if (needed > *free)
    throw InputError(fmt::format("Specimen: {} specimen(s) of some {:.1e} grains need some {:.1f} GB of memory, and "
                                 "{:.1f} GB are free; make them smaller, the grains larger or the seeds fewer",
                                 orders.size(), n_largest, needed / 1e9, *free / 1e9));
}
} // namespace feldspar
