#include "dem/loading.h"

namespace feldspar
{
template <int dim>
TestRecord uniaxial_compression(const Specimen<dim>& specimen, const TestParameters& wanted,
                                const DynamicsParameters& dynamics_wanted, const TestMonitor& monitor)
{
  constexpr int axis = dim - 1;
  const double height = specimen.size[axis];
  const double platen_speed = 0.5 * wanted.compression_strain_rate * height;

  Dynamics<dim> dynamics(specimen, dynamics_wanted, ZeroForce::as_placed);
  start_steadily(dynamics, -wanted.compression_strain_rate);
  const auto lower = dynamics.add_wall({axis, 1.0, 0.0, platen_speed});
  const auto upper = dynamics.add_wall({axis, -1.0, height, -platen_speed});

  return load_until_stop<dim>(dynamics,
                              {TestKind::uniaxial_compression, -wanted.compression_strain_rate,
                               wanted.compression_sampling_strain,
                               [=](const Dynamics<dim>& state) {
                                 return std::array{-state.wall_force(lower), -state.wall_force(upper)};
                               }},
                              wanted, monitor);
}

template TestRecord uniaxial_compression<2>(const Specimen<2>&, const TestParameters&, const DynamicsParameters&,
                                            const TestMonitor&);
} // namespace feldspar
