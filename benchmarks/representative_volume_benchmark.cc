#include "coupling/rve/representative_volume.h"
#include "dem/genesis/genesis.h"

#include <benchmark/benchmark.h>

#include <memory>

/// A representative volume of Table 1, some 400 discs or 600 spheres, on one core: what an update costs before and after its
/// first crack, and what a copy keeps.
namespace feldspar
{
namespace
{
template <int dim>
Specimen<dim> specimen()
{
  SpecimenParameters wanted;
  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = dim == 2 ? 0.0325 : 0.0133;
  wanted.packed_by_descent = false; // as in the results that are committed
  FlatJointParameters joint;
  if constexpr (dim == 2)
    joint.coordination_number = 4.2;
  else
    {
      wanted.dimension = 3;
      wanted.porosity = 0.36;
      joint.installation_gap_ratio = 0.05;
    }
  return make_specimen<dim>(wanted, joint, {}, 1);
}

template <int dim>
std::shared_ptr<const Network<dim>> network()
{
  static const auto shared = std::make_shared<const Network<dim>>(specimen<dim>());
  return shared;
}

template <int dim>
std::size_t bytes(const NetworkState<dim>& state)
{
  return sizeof(RepresentativeVolume<dim>) + state.motions.capacity() * sizeof(double) +
         state.unbonded.capacity() * sizeof(UnbondedSegment<dim>);
}

template <int dim>
void note_size(benchmark::State& state, const RepresentativeVolume<dim>& rve)
{
  state.counters["grains"] = double(rve.network().n_grains());
  state.counters["bytes"] = double(bytes(rve.state()));
  state.counters["cracks"] = rve.state().n_tension_breaks + rve.state().n_shear_breaks;
}

/// Stress and the check for the first break, at `range` per cent of the strain at it.
template <int dim>
void intact_update(benchmark::State& state)
{
  RepresentativeVolume<dim> rve(network<dim>());
  const Voigt<dim> direction = Voigt<dim>::Unit(dim - 1);
  const Voigt<dim> strain = 0.01 * double(state.range(0)) * rve.network().first_break(direction).factor * direction;
  for (auto _ : state)
    benchmark::DoNotOptimize(rve.trial(strain));
  note_size(state, rve);
}
BENCHMARK(intact_update<2>)->Arg(10)->Arg(50)->Arg(99)->Unit(benchmark::kMicrosecond);
BENCHMARK(intact_update<3>)->Arg(10)->Arg(50)->Arg(99)->Unit(benchmark::kMicrosecond);

/// With the sides free, pulled to `range` per cent of the strain at its first break in steps of 2e-6; then the next.
template <int dim>
RepresentativeVolume<dim> pulled(const std::int64_t percent, Control<dim>& next)
{
  constexpr int axis = dim - 1;
  RepresentativeVolume<dim> rve(network<dim>());
  Control<dim> control;
  control.stress_given.fill(true);
  control.stress_given[axis] = false;
  constexpr double step = 2e-6;
  const double end = 0.01 * double(percent) * rve.network().first_break(Voigt<dim>::Unit(axis)).factor;
  while (control.strain[axis] + step < end)
    {
      control.strain[axis] += step;
      rve.accept(rve.trial(control));
    }
  next = control;
  next.strain[axis] += step;
  return rve;
}

template <int dim>
void damaged_increment(benchmark::State& state)
{
  Control<dim> next;
  const RepresentativeVolume<dim> rve = pulled<dim>(state.range(0), next);
  std::size_t n_breaks = 0;
  for (auto _ : state)
    {
      const auto trial = rve.trial(next);
      n_breaks = trial.breaks.size();
    }
  note_size(state, rve);
  state.counters["breaks"] = double(n_breaks);
}
BENCHMARK(damaged_increment<2>)->Arg(120)->Arg(150)->Arg(200)->Arg(250)->Unit(benchmark::kMillisecond);
BENCHMARK(damaged_increment<3>)->Arg(110)->Arg(120)->Arg(150)->Unit(benchmark::kMillisecond);

template <int dim>
void damaged_tangent(benchmark::State& state)
{
  Control<dim> next;
  const RepresentativeVolume<dim> rve = pulled<dim>(state.range(0), next);
  for (auto _ : state)
    benchmark::DoNotOptimize(Equilibrium<dim>(rve.network(), rve.state(), {}).tangent());
  note_size(state, rve);
}
BENCHMARK(damaged_tangent<2>)->Arg(150)->Arg(250)->Unit(benchmark::kMillisecond);
BENCHMARK(damaged_tangent<3>)->Arg(150)->Unit(benchmark::kMillisecond);

/// Factor, unit responses and bounds: once per specimen.
template <int dim>
void reference(benchmark::State& state)
{
  const auto of = specimen<dim>();
  for (auto _ : state)
    benchmark::DoNotOptimize(Network<dim>(of));
}
BENCHMARK(reference<2>)->Unit(benchmark::kMillisecond);
BENCHMARK(reference<3>)->Unit(benchmark::kMillisecond);
} // namespace
} // namespace feldspar

BENCHMARK_MAIN();
