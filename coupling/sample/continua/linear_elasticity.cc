#include "fem/materials/linear_elasticity.h"

#include "coupling/sample/continua/continua.h"

namespace feldspar::continua
{
namespace
{
template <int dim>
fem::Material<dim> elastic(const fem::ElasticConstants& constants)
{
  return fem::linear_elasticity<dim>(fem::isotropic_stiffness<dim>(constants.youngs_modulus, constants.poissons_ratio));
}
} // namespace

const Continuum linear_elasticity{
  .name = "linear elasticity",
  .in_plane =
    [](const ContinuumParameters& of) {
      return elastic<2>(fem::plane_strain_equal_to_plate({of.modulus, of.poissons_ratio}));
    },
  .in_space =
    [](const ContinuumParameters& of) {
      return elastic<3>({of.modulus, of.poissons_ratio});
    }};
} // namespace feldspar::continua
