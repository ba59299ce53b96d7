#include "app/jobs.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

namespace feldspar
{
void for_each_job(const std::size_t n, const std::function<void(std::size_t)>& job)
{
  oneapi::tbb::parallel_for(
    std::size_t(0), n,
    [&](const std::size_t k) {
      // Waiting inside a job's own loops must not begin another job on top of it.
      oneapi::tbb::this_task_arena::isolate([&] { job(k); });
    },
    oneapi::tbb::simple_partitioner());
}
} // namespace feldspar
