// One sweep of contact forces and one whole step, on 2 000, 20 000 and 200 000 grains: the engine beside plain scalar
// code in the same run. Times are in ns per joint (the counter ns_per_joint). Run on one thread by default:
//
//   dynamics_benchmark [--benchmark_filter=...]      FELDSPAR_THREADS=2 for two threads

#include "base/random.h"
#include "benchmarks/plain_laboratory.h"
#include "dem/dynamics/dynamics.h"
#include "dem/genesis/genesis.h"

#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
/// A specimen whose making takes no time: a hexagonal lattice of uneven grains, jointed to a coordination number of 4.2,
/// sheared, so that the joints carry load and some of them break.
const Specimen<2>& lattice(const std::size_t n_grains, const double bond_strength_factor = 1.0)
{
  static std::map<std::pair<std::size_t, double>, Specimen<2>> made;
  if (const auto found = made.find({n_grains, bond_strength_factor}); found != made.end())
    return found->second;

  Random random(1, RandomStream::radii);
  const double spacing = 1.65e-3;
  const auto n_columns = std::size_t(std::sqrt(0.5 * double(n_grains)));
  std::vector<double> radii;
  Components<2> positions;
  for (std::size_t i = 0; i < n_grains; ++i)
    {
      const std::size_t row = i / n_columns;
      radii.push_back(0.5 * spacing * random.uniform(0.9, 1.0));
      positions[0].push_back(spacing * (double(i % n_columns) + 0.5 * double(row % 2) + random.uniform(0.6, 0.64)));
      positions[1].push_back(spacing * (std::sqrt(0.75) * double(row) + random.uniform(0.6, 0.64)));
    }
  Specimen<2> specimen;
  specimen.size = {spacing * double(n_columns + 1), spacing * (double(n_grains) / double(n_columns) + 2.0)};
  specimen.grains.place(radii, positions);
  specimen.grains.set_density(3200.0, specimen.thickness);
  FlatJointParameters flat_joint;
  flat_joint.coordination_number = 4.2;
  for (double* const strength : {&flat_joint.bond_tensile_strength, &flat_joint.bond_tensile_strength_deviation,
                                 &flat_joint.bond_cohesion, &flat_joint.bond_cohesion_deviation})
    *strength *= bond_strength_factor;
  install_joints(specimen, flat_joint);
  for (std::size_t i = 0; i < n_grains; ++i)
    specimen.grains.velocity[1][i] = -1.0 * specimen.grains.position[1][i];
  return made.emplace(std::pair(n_grains, bond_strength_factor), std::move(specimen)).first->second;
}

void report(benchmark::State& state, const std::size_t n_joints)
{
  state.counters["joints"] = double(n_joints);
  state.counters["ns_per_joint"] = benchmark::Counter(
    1e-9 * double(n_joints), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void engine_step(benchmark::State& state)
{
  Dynamics<2> dynamics(lattice(std::size_t(state.range(0))), {}, ZeroForce::as_placed);
  dynamics.step(); // which looks for contacts
  for (auto _ : state)
    dynamics.step();
  report(state, dynamics.specimen().joints.size());
}

/// The same lattice, its bonds without tensile strength and cohesion: they break as soon as they are pulled or slide.
void engine_step_broken(benchmark::State& state)
{
  Dynamics<2> dynamics(lattice(std::size_t(state.range(0)), 0.0), {}, ZeroForce::as_placed);
  for (int k = 0; k < 200; ++k)
    dynamics.step();
  for (auto _ : state)
    dynamics.step();
  report(state, dynamics.specimen().joints.size());
}

void plain_step(benchmark::State& state)
{
  plain::Body body(lattice(std::size_t(state.range(0))), plain::Loading::none, 0.0, 0.7);
  body.step(); // which looks for contacts
  for (auto _ : state)
    body.step();
  report(state, body.joints.size());
}

void engine_sweep(benchmark::State& state)
{
  Specimen<2> specimen = lattice(std::size_t(state.range(0)));
  SweepMemory<2> memory(specimen.joints);
  for (auto _ : state)
    benchmark::DoNotOptimize(sweep_joints(specimen.joints, specimen.grains, 5e-8, memory));
  report(state, specimen.joints.size());
}

void plain_sweep(benchmark::State& state)
{
  plain::Body body(lattice(std::size_t(state.range(0))), plain::Loading::none, 0.0, 0.7);
  for (auto _ : state)
    {
      body.sweep(5e-8);
      benchmark::ClobberMemory();
    }
  report(state, body.joints.size());
}

BENCHMARK(plain_sweep)->Arg(2000)->Arg(20000)->Arg(200000)->UseRealTime();
BENCHMARK(engine_sweep)->Arg(2000)->Arg(20000)->Arg(200000)->UseRealTime();
BENCHMARK(plain_step)->Arg(2000)->Arg(20000)->Arg(200000)->UseRealTime();
BENCHMARK(engine_step)->Arg(2000)->Arg(20000)->Arg(200000)->UseRealTime();
BENCHMARK(engine_step_broken)->Arg(2000)->Arg(200000)->UseRealTime();
} // namespace
} // namespace feldspar

int main(int argc, char** argv)
{
  const char* const threads = std::getenv("FELDSPAR_THREADS");
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          threads ? std::size_t(std::atoi(threads)) : 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
