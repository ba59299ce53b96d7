#include "base/input_error.h"
#include "dem/lab/platens.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/test_in_progress.h"

#include <fmt/format.h>

namespace feldspar
{
namespace
{
template <int dim>
SetUpTest<dim> set_up_direct_tension(const Specimen<dim>& specimen, double /*confining_pressure*/,
                                     const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  const double height = specimen.size[axis];
  const double grip_height = wanted.grip_ratio * height;
  const double free_length = height - 2.0 * grip_height;
  const double grip_speed = 0.5 * wanted.tension_strain_rate * free_length;

  std::vector<std::uint32_t> lower_grains, upper_grains;
  for (std::uint32_t i = 0; i < specimen.grains.size(); ++i)
    if (specimen.grains.position[axis][i] < grip_height)
      lower_grains.push_back(i);
    else if (specimen.grains.position[axis][i] > height - grip_height)
      upper_grains.push_back(i);
  if (lower_grains.empty() || upper_grains.empty())
    throw InputError(fmt::format("Tests/Grip ratio = {}: no grain lies in a grip of {:.3g} m; make it larger",
                                 wanted.grip_ratio, grip_height));

  SetUpTest<dim> test{Dynamics<dim>(specimen, dynamics, ZeroForce::as_placed), {}};
  start_steadily(test.dynamics, wanted.tension_strain_rate);
  const Vector<dim> upwards = grip_speed * Vector<dim>::Unit(axis);
  const auto lower = test.dynamics.add_grip(std::move(lower_grains), -upwards);
  const auto upper = test.dynamics.add_grip(std::move(upper_grains), upwards);

  test.loading.strain_rate = wanted.tension_strain_rate;
  test.loading.sampling_strain = wanted.tension_sampling_strain;
  const double area = specimen.volume() / height;
  test.loading.end_stress = [=](const Dynamics<dim>& state) {
    return EndStress{state.grip_force(lower)[axis] / area, -state.grip_force(upper)[axis] / area};
  };
  return test;
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
  .strain_rate = &TestParameters::tension_strain_rate,
  .forecast = {PeakForecast::With::tension},
  .takes_cylinders = true,
  .takes_clumps = true,
  .set_up_2d = set_up_direct_tension<2>,
  .set_up_3d = set_up_direct_tension<3>,
});
} // namespace feldspar
