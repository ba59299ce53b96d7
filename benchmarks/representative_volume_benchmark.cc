#include "coupling/representative_volume.h"
#include "dem/genesis.h"

#include <benchmark/benchmark.h>

#include <memory>

/// A representative volume of Table 1, some 400 discs, on one core: what an update costs before and after its first
/// crack, and what a copy remembers.
namespace feldspar
{
namespace
{
std::shared_ptr<const Network<2>> network()
{
  static const auto shared = [] {
    SpecimenParameters wanted;
    wanted.shape = "periodic";
    wanted.width = wanted.height = 0.0325;
    FlatJointParameters joint;
    joint.coordination_number = 4.2;
    return std::make_shared<const Network<2>>(make_specimen<2>(wanted, joint, {}, 1, [](std::string_view, double) {}));
  }();
  return shared;
}

std::size_t bytes(const NetworkState<2>& state)
{
  return sizeof(RepresentativeVolume<2>) + state.motions.capacity() * sizeof(double) +
         state.unbonded.capacity() * sizeof(UnbondedSegment<2>);
}

void note_size(benchmark::State& state, const RepresentativeVolume<2>& volume)
{
  state.counters["grains"] = double(volume.network().n_grains());
  state.counters["bytes"] = double(bytes(volume.state()));
  state.counters["cracks"] = volume.state().n_tension_breaks + volume.state().n_shear_breaks;
}

/// Stress and the check for the first break, at `range` per cent of the strain at it.
void intact_update(benchmark::State& state)
{
  RepresentativeVolume<2> volume(network());
  const Voigt<2> direction(0.0, 1.0, 0.0);
  const Voigt<2> strain = 0.01 * double(state.range(0)) * volume.network().first_break(direction).factor * direction;
  for (auto _ : state)
    benchmark::DoNotOptimize(volume.trial(strain));
  note_size(state, volume);
}
BENCHMARK(intact_update)->Arg(10)->Arg(50)->Arg(99)->Unit(benchmark::kMicrosecond);

/// With the sides free, pulled to `range` per cent of the strain at its first break in steps of 2e-6; then the next.
RepresentativeVolume<2> pulled(const std::int64_t percent, Control<2>& next)
{
  RepresentativeVolume<2> volume(network());
  Control<2> control;
  control.stress_given = {true, false, true};
  constexpr double step = 2e-6;
  const double end = 0.01 * double(percent) * volume.network().first_break(Voigt<2>(0.0, 1.0, 0.0)).factor;
  while (control.strain[1] + step < end)
    {
      control.strain[1] += step;
      volume.accept(volume.trial(control));
    }
  next = control;
  next.strain[1] += step;
  return volume;
}

void damaged_increment(benchmark::State& state)
{
  Control<2> next;
  const RepresentativeVolume<2> volume = pulled(state.range(0), next);
  std::size_t n_breaks = 0;
  for (auto _ : state)
    {
      const auto trial = volume.trial(next);
      n_breaks = trial.breaks.size();
    }
  note_size(state, volume);
  state.counters["breaks"] = double(n_breaks);
}
BENCHMARK(damaged_increment)->Arg(120)->Arg(150)->Arg(200)->Arg(250)->Unit(benchmark::kMillisecond);

void damaged_tangent(benchmark::State& state)
{
  Control<2> next;
  const RepresentativeVolume<2> volume = pulled(state.range(0), next);
  for (auto _ : state)
    benchmark::DoNotOptimize(Equilibrium<2>(volume.network(), volume.state(), {}).tangent());
  note_size(state, volume);
}
BENCHMARK(damaged_tangent)->Arg(150)->Arg(250)->Unit(benchmark::kMillisecond);

/// Factor, unit responses and bounds: once per specimen.
void reference(benchmark::State& state)
{
  SpecimenParameters wanted;
  wanted.shape = "periodic";
  wanted.width = wanted.height = 0.0325;
  FlatJointParameters joint;
  joint.coordination_number = 4.2;
  const auto specimen = make_specimen<2>(wanted, joint, {}, 1, [](std::string_view, double) {});
  for (auto _ : state)
    benchmark::DoNotOptimize(Network<2>(specimen));
}
BENCHMARK(reference)->Unit(benchmark::kMillisecond);
} // namespace
} // namespace feldspar

BENCHMARK_MAIN();
