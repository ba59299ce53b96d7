#include "app/jobs.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace feldspar
{
void for_each_job(const std::size_t n, const std::function<void(std::size_t)>& job)
{
  const std::size_t n_workers = std::min(n, std::size_t(oneapi::tbb::this_task_arena::max_concurrency()));
  std::atomic<std::size_t> next = 0;
  oneapi::tbb::parallel_for(
    std::size_t(0), n_workers,
    [&](std::size_t) {
      for (std::size_t k = next++; k < n; k = next++)
        // Waiting inside a job's own loops must not begin another worker on top of it.
        oneapi::tbb::this_task_arena::isolate([&] { job(k); });
    },
    oneapi::tbb::simple_partitioner());
}
} // namespace feldspar
