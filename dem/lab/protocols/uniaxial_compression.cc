#include "dem/lab/laboratory_run.h"
#include "dem/lab/machine.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/compression.h"
#include "laboratory/entries.h"

#include <utility>

namespace feldspar
{
namespace
{
template <int dim>
SetUpTest<dim> set_up_uniaxial_compression(Specimen<dim> specimen, double /*confining_pressure*/,
                                           const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  const double area = specimen.volume() / specimen.size[dim - 1];
  SetUpTest<dim> test{Dynamics<dim>(std::move(specimen), dynamics, ZeroForce::as_placed), {}};
  const auto platens = add_platens(test, wanted.platen_friction);
  const Machine machine = machine_of(test, platens, wanted.of<CompressionParameters>());
  start(test.dynamics, machine);
  if (!machine.is_rigid())
    test.loading.drive = [=](Dynamics<dim>& state, const SinceStart& since) {
      press(state, machine, 0.0, area, since);
    };

  test.loading.end_stress = [=](const Dynamics<dim>& state) { return stress_of(state, platens, area); };
  return test;
}
} // namespace

constinit const LaboratoryProtocol uniaxial_compression = complete({
  .kind = {.name = "uniaxial_compression",
           .title = "Uniaxial compression",
           .strength = "uniaxial compressive strength",
           .sign = -1.0,
           .envelope_role = EnvelopeRole::compression,
           .has_uniform_stress = true,
           .runs_on_finite_elements = true,
           .duration_rank = 1},
  .strain_rate = rate_of<CompressionParameters>,
  .own_entries = {compression_entries, machine_entries, platen_entries},
  .forecast = {PeakForecast::With::compression},
  .takes_cylinders = true,
  .takes_clumps = true,
  .set_ups = {set_up_uniaxial_compression<2>, set_up_uniaxial_compression<3>},
});
} // namespace feldspar
