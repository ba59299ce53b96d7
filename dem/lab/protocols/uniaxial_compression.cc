#include "dem/lab/laboratory_test.h"
#include "dem/lab/platens.h"

namespace feldspar
{
template <int dim>
SetUpTest<dim> set_up_uniaxial_compression(const Specimen<dim>& specimen, const TestParameters& wanted,
                                           const DynamicsParameters& dynamics)
{
  SetUpTest<dim> test{Dynamics<dim>(specimen, dynamics, ZeroForce::as_placed), {}};
  start_steadily(test.dynamics, -wanted.compression_strain_rate);
  const auto platens = add_platens(test.dynamics, 0.0, specimen.size[dim - 1], wanted.platen_friction);
  close(test.dynamics, platens, wanted.compression_strain_rate * specimen.size[dim - 1]);

  test.protocol.strain_rate = -wanted.compression_strain_rate;
  test.protocol.sampling_strain = wanted.compression_sampling_strain;
  const double area = specimen.volume() / specimen.size[dim - 1];
  test.protocol.end_stress = [=](const Dynamics<dim>& state) {
    return EndStress{-state.wall_force(platens.lower) / area, -state.wall_force(platens.upper) / area};
  };
  return test;
}

template SetUpTest<2> set_up_uniaxial_compression<2>(const Specimen<2>&, const TestParameters&,
                                                     const DynamicsParameters&);
template SetUpTest<3> set_up_uniaxial_compression<3>(const Specimen<3>&, const TestParameters&,
                                                     const DynamicsParameters&);
} // namespace feldspar
