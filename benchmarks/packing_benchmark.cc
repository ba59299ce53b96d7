// Grains come to rest by descent, or by damped motion: the same grains in the same box both ways, with their joints, on one
// core. The specimen of Beishan granite in the plane, and the cylinder of 20 mm.

#include "benchmarks/on_one_thread.h"
#include "dem/genesis/genesis.h"

#include <benchmark/benchmark.h>

namespace feldspar
{
namespace
{
template <int dim>
void pack(benchmark::State& state, const bool by_descent)
{
  SpecimenParameters wanted;
  wanted.packed_by_descent = by_descent;
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.05;
  if (dim == 3)
    {
      wanted.dimension = 3;
      wanted.shape = BodyShape::cylinder;
      wanted.width = 0.020;
      wanted.height = 0.040;
      wanted.porosity = 0.39; // the walls of so narrow a cylinder leave voids
    }
  double n_grains = 0.0;
  for (auto _ : state)
    {
      const auto specimen = make_specimen<dim>(wanted, joint, {}, 1);
      n_grains = specimen.report.n_grains;
      benchmark::DoNotOptimize(n_grains);
    }
  state.counters["grains"] = n_grains;
}

template <int dim>
void by_descent(benchmark::State& state)
{
  pack<dim>(state, true);
}

template <int dim>
void by_motion(benchmark::State& state)
{
  pack<dim>(state, false);
}

BENCHMARK(by_descent<2>);
BENCHMARK(by_motion<2>);
BENCHMARK(by_descent<3>);
BENCHMARK(by_motion<3>);
} // namespace
} // namespace feldspar

int main(int argc, char** argv) { return feldspar::run_on_one_thread(argc, argv); }
