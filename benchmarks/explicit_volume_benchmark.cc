// A representative volume of some 400 discs pulled apart at uniaxial strain, event by event and by explicit dynamics
// at falling rates: what equal accuracy costs. One thread. The counters are what came out: peak stress [MPa], cracks,
// boundary work and dissipated energy [J].

#include "benchmarks/on_one_thread.h"
#include "coupling/rve/explicit_run.h"
#include "dem/genesis/genesis.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

namespace feldspar
{
namespace
{
constexpr double final_strain = 4e-4;

const Specimen<2>& specimen()
{
  static const auto made = [] {
    SpecimenParameters wanted;
    wanted.shape = BodyShape::periodic;
    wanted.width = wanted.height = 0.0325;
    FlatJointParameters joint;
    joint.coordination_number = 4.2;
    return make_specimen<2>(wanted, joint, {}, 1);
  }();
  return made;
}

std::vector<PathLeg<2>> pull() { return {{strain_control<2>(Voigt<2>(0.0, final_strain, 0.0)), false}}; }

template <typename Run>
void go(benchmark::State& state, Run&& run)
{
  while (!run.has_ended())
    run.advance();
  double peak = 0.0;
  for (const auto& sample : run.record().samples)
    peak = std::max(peak, sample.stress[1]);
  const auto& last = run.record().samples.back();
  state.counters["peak"] = peak / 1e6;
  state.counters["cracks"] = double(last.n_tension_cracks + last.n_shear_cracks);
  state.counters["work"] = last.work.boundary;
  state.counters["dissipated"] = last.work.slip + last.work.released + last.work.settled;
}

const std::shared_ptr<const Network<2>>& network()
{
  static const auto made = std::make_shared<const Network<2>>(specimen());
  return made;
}

/// `range`: largest step of the strain, in 1e-6.
void from_break_to_break(benchmark::State& state)
{
  for (auto _ : state)
    go(state, PathRun<2>(network(), pull(), {.largest_step = 1e-6 * double(state.range(0))}));
}
BENCHMARK(from_break_to_break)->Arg(2)->Arg(10)->Arg(20)->Unit(benchmark::kSecond);

/// `range`: steps per 1e-3 of strain.
void by_explicit_dynamics(benchmark::State& state)
{
  for (auto _ : state)
    go(state, ExplicitRun<2>(specimen(), network(), pull(),
                             {.largest_step = 1e-6, .steps_per_millistrain = std::uint64_t(state.range(0))}));
}
BENCHMARK(by_explicit_dynamics)->Arg(1000)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kSecond);
} // namespace
} // namespace feldspar

int main(int argc, char** argv) { return feldspar::run_on_one_thread(argc, argv); }
