#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"

#include <utility>

namespace feldspar
{
namespace
{
template <int dim>
SetUpTest<dim> set_up_direct_tension(Specimen<dim> specimen, double /*confining_pressure*/,
                                     const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  return pull(std::move(specimen), wanted, dynamics);
}
} // namespace

constinit const LaboratoryProtocol direct_tension = complete({
  .kind = {.name = "direct_tension",
           .title = "Direct tension",
           .strength = "tensile strength",
           .sign = 1.0,
           .envelope_role = EnvelopeRole::tension,
           .has_uniform_stress = true,
           .runs_on_finite_elements = true,
           .strength_decimals = 2},
  .strain_rate = rate_of<TensionParameters>,
  .own_entries = {tension_entries},
  .forecast = {PeakForecast::With::tension},
  .takes_cylinders = true,
  .takes_clumps = true,
  .set_up_2d = set_up_direct_tension<2>,
  .set_up_3d = set_up_direct_tension<3>,
});
} // namespace feldspar
