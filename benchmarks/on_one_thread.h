#pragma once

#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

namespace feldspar
{
/// Runs the benchmarks of a program on one thread.
inline int run_on_one_thread(int argc, char** argv)
{
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
} // namespace feldspar
