#include "dem/input_error.h"
#include "dem/loading.h"

#include <fmt/format.h>

namespace feldspar
{
template <int dim>
TestRecord direct_tension(const Specimen<dim>& specimen, const TestParameters& wanted,
                          const DynamicsParameters& dynamics_wanted, const TestMonitor& monitor)
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

  Dynamics<dim> dynamics(specimen, dynamics_wanted, ZeroForce::as_placed);
  start_steadily(dynamics, wanted.tension_strain_rate);
  const Vector<dim> upwards = grip_speed * Vector<dim>::Unit(axis);
  const auto lower = dynamics.add_grip(std::move(lower_grains), -upwards);
  const auto upper = dynamics.add_grip(std::move(upper_grains), upwards);

  return load_until_stop<dim>(dynamics,
                              {TestKind::direct_tension, wanted.tension_strain_rate, wanted.tension_sampling_strain,
                               [=](const Dynamics<dim>& state) {
                                 return std::array{state.grip_force(lower)[axis], -state.grip_force(upper)[axis]};
                               }},
                              wanted, monitor);
}

template TestRecord direct_tension<2>(const Specimen<2>&, const TestParameters&, const DynamicsParameters&,
                                      const TestMonitor&);
} // namespace feldspar
