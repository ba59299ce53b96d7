#include "fem/materials/mohr_coulomb.h"

#include "coupling/sample/continua/continua.h"
#include "fem/materials/linear_elasticity.h"
#include "fem/materials/plane_strain.h"

namespace feldspar::continua
{
namespace
{
fem::Material<3> plastic(const fem::ElasticConstants& constants, const ContinuumParameters& of)
{
  return fem::mohr_coulomb(
    {constants.youngs_modulus, constants.poissons_ratio, of.cohesion, of.friction_angle, of.dilation_angle});
}
} // namespace

const Continuum mohr_coulomb{
  .name = "Mohr-Coulomb",
  .in_plane =
    [](const ContinuumParameters& of) {
      return fem::plane_strain(plastic(fem::plane_strain_equal_to_plate({of.modulus, of.poissons_ratio}), of));
    },
  .in_space =
    [](const ContinuumParameters& of) {
      return plastic({of.modulus, of.poissons_ratio}, of);
    }};
} // namespace feldspar::continua
