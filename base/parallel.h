#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <thread>

namespace feldspar
{
/// Number of threads that may work at a time: as many as --threads allows and the machine has. An arena of TBB tells of
/// the machine alone.
inline std::size_t number_of_threads()
{
  using oneapi::tbb::global_control;
  return std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()),
                               global_control::active_value(global_control::max_allowed_parallelism));
}

/// Entries worked on together. Fixed, so that nothing depends on the number of threads.
inline constexpr std::size_t block_size = 1024;

inline std::size_t n_blocks(const std::size_t n) { return (n + block_size - 1) / block_size; }

/// Blocks that a thread works on one after the other, at least.
inline constexpr std::size_t fewest_blocks_in_a_row = 4;

/// Returns whether for_each_block() and for_each_run_of_blocks() do a job of this size on this thread alone. Small jobs
/// are not distributed, which would cost more.
inline bool stays_on_this_thread(const std::size_t n)
{
  constexpr std::size_t few_blocks = 8;
  return n_blocks(n) <= few_blocks;
}

/// Calls work(block, begin, end) for every block of 0 … n: `in_a_row` blocks one after the other by the same thread.
template <typename Work>
void for_each_run_of_blocks(const std::size_t n, const std::size_t in_a_row, Work&& work)
{
  const auto run = [&](const std::size_t from, const std::size_t to) {
    for (std::size_t block = from; block < to; ++block)
      work(block, block * block_size, std::min(n, (block + 1) * block_size));
  };
  const std::size_t n_all = n_blocks(n);
  if (stays_on_this_thread(n))
    run(0, n_all);
  else
    oneapi::tbb::parallel_for(std::size_t(0), (n_all + in_a_row - 1) / in_a_row,
                              [&](const std::size_t k) { run(k * in_a_row, std::min(n_all, (k + 1) * in_a_row)); });
}

/// Calls work(block, begin, end) for every block of 0 … n.
template <typename Work>
void for_each_block(const std::size_t n, Work&& work)
{
  for_each_run_of_blocks(n, fewest_blocks_in_a_row, work);
}

/// Thrown by work that was left because the run is to end.
struct GivenUp
{
};

/// Throws it where the run is to end. Asked by any thread; empty: never.
inline void leave_if(const std::function<bool()>& gives_up)
{
  if (gives_up && gives_up())
    throw GivenUp();
}
} // namespace feldspar
