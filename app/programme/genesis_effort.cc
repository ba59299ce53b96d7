#include "app/programme/genesis_effort.h"

#include "app/programme/checks.h"
#include "base/input_error.h"
#include "base/parallel.h"
#include "base/readable_file.h"
#include "base/text.h"
#include "dem/specimen/specimen_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <thread>

namespace feldspar
{
namespace
{
/// Number of lines of a packing file, which has one grain in a line. Says nothing about a file that cannot be read,
/// which its reader will do.
double n_lines(const std::string& path)
{
  if (!objection_to_reading(path).empty())
    return 0.0;
  ReadableFile file(path);
  std::array<char, 1 << 16> piece{};
  double n = 0.0;
  while (file.read(piece.data(), piece.size()) || file.gcount() > 0)
    n += double(std::count(piece.data(), piece.data() + file.gcount(), '\n'));
  return n;
}

/// Number of grains of a specimen file, which is read once. Says nothing about a file that cannot be read, which its reader will
/// do.
double n_grains_in(const std::string& file)
{
  static std::map<std::string, double> known;
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const auto [place, is_new] = known.try_emplace(file, 0.0);
  if (is_new)
    refusal_of([&, &place = place] { place->second = double(head_of_specimen(file).n_grains); });
  return place->second;
}
} // namespace

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

namespace
{
/// Processes that run or wait for a processor, as a mean over a minute. The value is that of the beginning of the run:
/// later it counts the run itself.
double load_at_start()
{
  static const double load = [] {
    double of_minute = 0.0;
    std::ifstream("/proc/loadavg") >> of_minute;
    return of_minute;
  }();
  return load;
}

double n_processors() { return std::max(1u, std::thread::hardware_concurrency()); }
} // namespace

double n_threads_served()
{
  const auto n = double(number_of_threads());
  return n * std::min(1.0, n_processors() / (n + load_at_start()));
}

std::string load_in_words(const double bytes)
{
  std::string words;
  if (const auto free = free_memory(); free && bytes > 0.5 * *free)
    words += fmt::format("; {:.1f} GB of memory are free", *free / 1e9);
  if (load_at_start() > 0.5 * n_processors())
    words += fmt::format("; other programs use {:.1f} of {:.0f} processors", std::min(load_at_start(), n_processors()),
                         n_processors());
  return words;
}

// The peak of `feldspar specimen` less that of a tiny specimen, over the number of grains: 970 bytes (79 000 discs) and 2800
// (24 000 spheres), rounded up.
double bytes_of_grain(const int dimension) { return dimension == 2 ? 1.2e3 : 3.5e3; }

/// The grain, 2.2 joints of 236 bytes or, in space, 3.5 of 484, and the longest column of the file while it is read.
constexpr double bytes_of_grain_in_file(const int dimension) { return dimension == 2 ? 800.0 : 2.3e3; }

GenesisEffort expected_effort(const SpecimenParameters& specimen)
{
  if (!specimen.specimen_file.empty())
    {
      const double n = n_grains_in(specimen.specimen_file); // it brings them
      return {n, 0.0, n * bytes_of_grain_in_file(specimen.dimension), 0.0};
    }
  if (!specimen.packing_file.empty())
    {
      // Nothing moves. A dense packing has many neighbours: 1180 and 4530 bytes of a grain on lattices in which each has all
      // that it can (100 000 discs, 40 000 spheres), rounded up.
      const double n = n_lines(specimen.packing_file);
      return {n, 0.0, n * (specimen.dimension == 2 ? 1.5e3 : 5.5e3), n * 1e-5};
    }
  // Steps: measured on two seeds each of 100 to 2000 discs and 250 to 4500 spheres, within a factor of two; a cell that
  // repeats itself takes longer to come to rest. Seconds: of these on one core of 2020s' servers.
  const bool plane = specimen.dimension == 2;
  const double n_of_all = expected_grains(specimen), bytes = n_of_all * bytes_of_grain(specimen.dimension);
  const double n = // that are packed
    n_of_all / (std::pow(specimen.cells_across, specimen.dimension - 1) * specimen.cells_along);
  if (specimen.packed_by_descent)
    {
      // Measured on 90 to 1950 discs and 140 to 49 000 spheres, three seeds each, again within a factor of two.
      const double n_iterations = plane ? 250.0 * std::pow(n, 0.36) : 900.0 * std::pow(n, 0.22);
      return {n_of_all, n_iterations, bytes, n * n_iterations * (plane ? 4e-8 : 1.2e-7)};
    }
  const double longer = is_periodic(specimen.shape_when_packed()) ? 1.8 : 1.0;
  const double n_steps = longer * (plane ? 900.0 * std::pow(n, 0.45) : 2400.0 * std::pow(n, 0.38));
  const double seconds_of_grain_and_step = plane ? 4e-8 : 1.6e-7;
  return {n_of_all, n_steps, bytes, n * n_steps * seconds_of_grain_and_step};
}

namespace
{
/// Number of grains of the largest, and memory of all, which lie there at the same time.
GenesisEffort together(const RunPlan& plan, const std::vector<SpecimenOrder>& orders)
{
  GenesisEffort sum;
  for (const SpecimenOrder& order : orders)
    {
      const GenesisEffort one = expected_effort(plan.input_of(order).specimen);
      sum.n_grains = std::max(sum.n_grains, one.n_grains);
      sum.bytes += one.bytes;
      sum.seconds += one.seconds;
    }
  return sum;
}
} // namespace

std::string describe_effort(const RunPlan& plan, const std::vector<SpecimenOrder>& orders)
{
  const GenesisEffort sum = together(plan, orders);
  if (sum.n_grains == 0.0)
    return "";
  const double n_at_a_time = std::min(double(orders.size()), n_threads_served());
  return fmt::format("genesis of {} specimen{}, some {:.0f} grains{}: about {:.0f} MB, {}{}", orders.size(),
                     orders.size() == 1 ? "" : "s", sum.n_grains, orders.size() == 1 ? "" : " each at most",
                     std::max(1.0, sum.bytes / 1e6), duration_in_words(sum.seconds / n_at_a_time),
                     load_in_words(sum.bytes));
}

void check_memory(const RunPlan& plan, const std::vector<SpecimenOrder>& orders)
{
  const std::optional<double> free = free_memory();
  const GenesisEffort sum = together(plan, orders);
  if (free && sum.bytes > *free)
    throw InputError("Specimen: {} specimen(s) of some {:.1e} grains need some {:.1f} GB of memory, and "
                     "{:.1f} GB are free; make them smaller, the grains larger or the seeds fewer",
                     orders.size(), sum.n_grains, sum.bytes / 1e9, *free / 1e9);
}
} // namespace feldspar
