#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <thread>

namespace feldspar
{
/// That may work at a time: as many as --threads allows and the machine has. An arena of TBB tells of the machine alone.
inline std::size_t number_of_threads()
{
  using oneapi::tbb::global_control;
  return std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()),
                               global_control::active_value(global_control::max_allowed_parallelism));
}

/// Entries worked on together. Fixed, so that nothing depends on the number of threads.
inline constexpr std::size_t block_size = 1024;

inline std::size_t n_blocks(const std::size_t n) { return (n + block_size - 1) / block_size; }

/// Whether for_each_block() does a job of this size on this thread alone. Small jobs are not handed out, which costs more.
inline bool stays_on_this_thread(const std::size_t n)
{
  constexpr std::size_t few_blocks = 8;
  return n_blocks(n) <= few_blocks;
}

/// Calls work(block, begin, end) for every block of 0 … n.
template <typename Work>
void for_each_block(const std::size_t n, Work&& work)
{
  const auto one = [&](const std::size_t block) {
    work(block, block * block_size, std::min(n, (block + 1) * block_size));
  };
  if (stays_on_this_thread(n))
    for (std::size_t block = 0; block < n_blocks(n); ++block)
      one(block);
  else
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, n_blocks(n), 4), [&](const auto& range) {
      for (std::size_t block = range.begin(); block != range.end(); ++block)
        one(block);
    });
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
