#include "runs/jobs.h"

#include "base/parallel.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

namespace feldspar
{
void for_each_job(const std::size_t n, const std::function<void(std::size_t)>& job)
{
  const std::size_t n_workers = std::min(n, number_of_threads());
  std::atomic<std::size_t> next = 0;
  std::exception_ptr first_failure;
  std::mutex failing;
  oneapi::tbb::parallel_for(
    std::size_t(0), n_workers,
    [&](std::size_t) {
      for (std::size_t k = next++; k < n; k = next++)
        // An exception that left this loop would cancel the loops inside the other jobs, which would go on with half
        // of their work: it waits here until they are done.
        try
          {
            // Waiting inside a job's own loops must not begin another worker on top of it.
            oneapi::tbb::this_task_arena::isolate([&] { job(k); });
          }
        catch (...)
          {
            const std::lock_guard lock(failing);
            if (!first_failure)
              first_failure = std::current_exception();
            next = n;
          }
    },
    oneapi::tbb::simple_partitioner());
  if (first_failure)
    std::rethrow_exception(first_failure);
}
} // namespace feldspar
