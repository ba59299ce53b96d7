// One sweep over the joints and one whole step in three dimensions, on 5 000, 50 000 and 400 000 grains, and a triad that
// streams as much memory: what the machine's memory allows. Run on one thread by default:
//
//   space_benchmark [--benchmark_filter=...]      FELDSPAR_THREADS=2 for two threads

#include "base/parallel.h"
#include "base/random.h"
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
/// A specimen whose making takes no time: a face-centred lattice of uneven grains, jointed to a coordination number near
/// that of a packing, with waves running through it, so that the joints carry load.
const Specimen<3>& lattice(const std::size_t n_grains, const double bond_strength_factor = 1.0)
{
  static std::map<std::pair<std::size_t, double>, Specimen<3>> made;
  if (const auto found = made.find({n_grains, bond_strength_factor}); found != made.end())
    return found->second;

  Random random(1, RandomStream::radii);
  const double edge = 1.65e-3 * std::sqrt(2.0);
  const auto n_cells = std::size_t(std::cbrt(double(n_grains) / 4.0));
  const std::array<std::array<double, 3>, 4> corners{
    {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}}};
  std::vector<double> radii;
  Components<3> positions;
  for (std::size_t cell = 0; cell < n_cells * n_cells * n_cells; ++cell)
    for (const auto& corner : corners)
      {
        radii.push_back(0.5 * 1.65e-3 * random.uniform(0.9, 1.0));
        const std::array<std::size_t, 3> number{cell % n_cells, cell / n_cells % n_cells, cell / n_cells / n_cells};
        for (int c = 0; c < 3; ++c)
          positions[c].push_back(edge * (double(number[c]) + corner[c] + 0.3 + random.uniform(0.0, 0.02)));
      }
  Specimen<3> specimen;
  specimen.size.setConstant(edge * double(n_cells + 1));
  // In the order of space, as genesis leaves its grains.
  Grains<3> loose;
  loose.place(radii, positions);
  std::vector<double> sorted_radii;
  Components<3> sorted_positions;
  for (const std::uint32_t i : spatial_order(loose))
    {
      sorted_radii.push_back(radii[i]);
      for (int c = 0; c < 3; ++c)
        sorted_positions[c].push_back(positions[c][i]);
    }
  specimen.grains.place(sorted_radii, sorted_positions);
  specimen.grains.set_density(3200.0, specimen.thickness);
  FlatJointParameters flat_joint;
  flat_joint.coordination_number = 7.4;
  for (double* const strength : {&flat_joint.bond_tensile_strength, &flat_joint.bond_tensile_strength_deviation,
                                 &flat_joint.bond_cohesion, &flat_joint.bond_cohesion_deviation})
    *strength *= bond_strength_factor;
  install_joints(specimen, flat_joint);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    specimen.grains.velocity[2][i] = -1.0 * specimen.grains.position[2][i];
  return made.emplace(std::pair(n_grains, bond_strength_factor), std::move(specimen)).first->second;
}

/// Bytes a sweep reads and writes for a joint whose bonds all hold, as the triad counts its own; gathers of grains come on top.
constexpr std::size_t bytes_per_whole_joint()
{
  using Row = JointTables<3>::Row; // without what it has dissipated; from the normal on all change
  constexpr std::size_t n_read = Row::slip_energy + SweepMemory<3>::n_weakest + JointTables<3>::n_response_rows;
  constexpr std::size_t n_written = Row::slip_energy - Row::normal + JointTables<3>::n_response_rows;
  return (n_read + n_written) * sizeof(double) + 2 * sizeof(std::uint32_t);
}

void report(benchmark::State& state, const Joints<3>& joints)
{
  const auto per = [&](const double n) {
    return benchmark::Counter(1e-9 * n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  };
  state.counters["joints"] = double(joints.size());
  state.counters["ns_per_joint"] = per(double(joints.size()));
  state.counters["ns_per_element"] = per(double(joints.size()) * joints.n_segments);
}

void space_step(benchmark::State& state)
{
  Dynamics<3> dynamics(lattice(std::size_t(state.range(0))), {}, ZeroForce::as_placed);
  dynamics.step();
  for (auto _ : state)
    dynamics.step();
  report(state, dynamics.specimen().joints);
}

/// The same lattice, its bonds without tensile strength and cohesion: they break as soon as they are pulled or slide.
void space_step_broken(benchmark::State& state)
{
  Dynamics<3> dynamics(lattice(std::size_t(state.range(0)), 0.0), {}, ZeroForce::as_placed);
  for (int k = 0; k < 50; ++k)
    dynamics.step();
  for (auto _ : state)
    dynamics.step();
  report(state, dynamics.specimen().joints);
}

void space_sweep(benchmark::State& state)
{
  Specimen<3> specimen = lattice(std::size_t(state.range(0)));
  SweepMemory<3> memory(specimen.joints);
  for (auto _ : state)
    benchmark::DoNotOptimize(sweep_joints(specimen.joints, specimen.grains, 5e-8, memory));
  report(state, specimen.joints);
  state.counters["bytes_per_joint"] = bytes_per_whole_joint();
  state.counters["GB_per_s"] = benchmark::Counter(1e-9 * bytes_per_whole_joint() * double(specimen.joints.size()),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

/// a = b + 3c over arrays larger than the caches, in the blocks and by the threads of the sweeps.
void triad(benchmark::State& state)
{
  const std::size_t n = 20'000'000;
  std::vector<double> a(n, 1.0), b(n, 2.0), c(n, 3.0);
  for (auto _ : state)
    {
      for_each_block(n, [&](std::size_t, const std::size_t begin, const std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          a[i] = b[i] + 3.0 * c[i];
      });
      benchmark::ClobberMemory();
    }
  // The old a is read before it is written over.
  state.counters["GB_per_s"] =
    benchmark::Counter(1e-9 * 4.0 * sizeof(double) * double(n), benchmark::Counter::kIsIterationInvariantRate);
}

} // namespace
} // namespace feldspar

int main(int argc, char** argv)
{
  using namespace feldspar;
  const char* const threads = std::getenv("FELDSPAR_THREADS");
  const std::size_t n_threads = threads ? std::size_t(std::atoi(threads)) : 1;
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, n_threads);
  // One thread by its own processor time, which others on the machine disturb least; several by the clock.
  const auto timed = [&](benchmark::internal::Benchmark* one) {
    return (n_threads > 1 ? one->UseRealTime() : one)->Unit(benchmark::kMillisecond);
  };
  timed(benchmark::RegisterBenchmark("triad", triad));
  timed(benchmark::RegisterBenchmark("space_sweep", space_sweep))->Arg(5000)->Arg(50000)->Arg(400000);
  timed(benchmark::RegisterBenchmark("space_step", space_step))->Arg(5000)->Arg(50000)->Arg(400000);
  timed(benchmark::RegisterBenchmark("space_step_broken", space_step_broken))->Arg(5000)->Arg(50000);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
