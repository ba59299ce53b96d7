// One whole step of the same 1 950 grains under each contact model, intact and on one thread, in the same run. The counter
// ns_per_pair counts the pairs that the flat joint joins, so that the models stand beside one another.

#include "benchmarks/on_one_thread.h"
#include "dem/dynamics/dynamics.h"
#include "dem/flaws/clumps.h"
#include "dem/flaws/mineral_grains.h"
#include "dem/genesis/genesis.h"

#include <benchmark/benchmark.h>

#include <functional>

namespace feldspar
{
namespace
{
constexpr double gap_ratio = 0.0457; // that of the granite of the examples

/// Packed as the examples' granite from its first seed, and moved so slowly that nothing breaks.
Specimen<2> specimen_of(const JointParameters& joint)
{
  auto specimen = make_specimen<2>({}, joint, {}, 1);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    specimen.grains.velocity[1][i] = -0.01 * specimen.grains.position[1][i];
  return specimen;
}

Specimen<2> of_flat_joints()
{
  FlatJointParameters joint;
  joint.installation_gap_ratio = gap_ratio;
  return specimen_of(joint);
}

Specimen<2> of_softening_flat_joints()
{
  SofteningFlatJointParameters joint;
  joint.installation_gap_ratio = gap_ratio;
  return specimen_of(joint);
}

Specimen<2> of_parallel_bonds()
{
  ParallelBondParameters bond;
  bond.installation_gap_ratio = gap_ratio;
  return specimen_of(bond);
}

Specimen<2> of_clumps()
{
  Specimen<2> specimen = of_parallel_bonds();
  put_in_clumps(specimen, {0.004});
  return specimen;
}

Specimen<2> of_mineral_grains()
{
  Specimen<2> specimen = of_parallel_bonds();
  SmoothJointParameters boundary;
  boundary.tensile_strength = boundary.cohesion = 20e6;
  put_in_mineral_grains(specimen, {0.005}, boundary);
  return specimen;
}

void step(benchmark::State& state, const std::function<Specimen<2>()>& make)
{
  static const std::size_t n_pairs = of_flat_joints().joints.size();
  Dynamics<2> dynamics(make(), {}, ZeroForce::as_placed);
  for (auto _ : state)
    dynamics.step();
  state.counters["joints"] = double(dynamics.specimen().n_joints());
  state.counters["ns_per_pair"] = benchmark::Counter(
    1e-9 * double(n_pairs), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(step, flat_joint, of_flat_joints);
BENCHMARK_CAPTURE(step, softening_flat_joint, of_softening_flat_joints);
BENCHMARK_CAPTURE(step, parallel_bond, of_parallel_bonds);
BENCHMARK_CAPTURE(step, clumps, of_clumps);
BENCHMARK_CAPTURE(step, grain_based, of_mineral_grains);
} // namespace
} // namespace feldspar

int main(int argc, char** argv) { return feldspar::run_on_one_thread(argc, argv); }
