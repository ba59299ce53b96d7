// A representative volume of some 400 discs pulled apart at uniaxial strain, from break to break and by explicit dynamics
// at falling rates: what equal accuracy costs. One thread. The counters are what came out: peak stress [MPa], cracks,
// boundary work and dissipated energy [J].

#include "coupling/path_run.h"
#include "dem/dynamics.h"
#include "dem/genesis.h"

#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

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
    wanted.shape = "periodic";
    wanted.width = wanted.height = 0.0325;
    FlatJointParameters joint;
    joint.coordination_number = 4.2;
    return make_specimen<2>(wanted, joint, {}, 1, [](std::string_view, double) {});
  }();
  return made;
}

/// `range`: largest step of the strain, in 1e-6.
void from_break_to_break(benchmark::State& state)
{
  const auto network = std::make_shared<const Network<2>>(specimen());
  PathParameters parameters;
  parameters.largest_step = 1e-6 * double(state.range(0));
  double peak = 0.0;
  for (auto _ : state)
    {
      PathRun<2> run(network, {{strain_control<2>(Voigt<2>(0.0, final_strain, 0.0)), false}}, parameters);
      while (!run.has_ended())
        run.advance();
      for (const auto& sample : run.record().samples)
        peak = std::max(peak, sample.stress[1]);
      const auto& last = run.record().samples.back();
      state.counters["cracks"] = double(last.n_tension_cracks + last.n_shear_cracks);
      state.counters["work"] = last.work.boundary;
      state.counters["dissipated"] = last.work.slip + last.work.released + last.work.settled;
    }
  state.counters["peak"] = peak / 1e6;
}
BENCHMARK(from_break_to_break)->Arg(2)->Arg(10)->Arg(20)->Unit(benchmark::kSecond);

/// `range`: steps per 1e-3 of strain.
void by_explicit_dynamics(benchmark::State& state)
{
  const auto n_per_millistrain = state.range(0);
  double peak = 0.0;
  for (auto _ : state)
    {
      Dynamics<2> dynamics(specimen(), {}, ZeroForce::as_placed);
      std::size_t n_cracks = dynamics.step().size(); // which finds the time step
      Tensor<2> rate = Tensor<2>::Zero();
      rate(1, 1) = 1e-3 / double(n_per_millistrain) / dynamics.time_step();
      dynamics.deform_cell(rate);
      const auto n_steps = std::int64_t(final_strain / 1e-3 * double(n_per_millistrain));
      const auto n_between_looks = std::max(std::int64_t(1), n_steps / 400);
      for (std::int64_t k = 0; k < n_steps; ++k)
        {
          n_cracks += dynamics.step().size();
          if (k % n_between_looks == 0)
            peak = std::max(peak, dynamics.mean_stress()(1, 1));
        }
      const Energies energies = dynamics.energies();
      state.counters["cracks"] = double(n_cracks);
      state.counters["work"] = energies.boundary_work;
      state.counters["dissipated"] = energies.released + energies.slip + energies.damping;
    }
  state.counters["peak"] = peak / 1e6;
}
BENCHMARK(by_explicit_dynamics)->Arg(1000)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kSecond);
} // namespace
} // namespace feldspar

int main(int argc, char** argv)
{
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
