#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"

namespace feldspar
{
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
  .set_ups = {pull<2>, pull<3>},
});
} // namespace feldspar
