#pragma once

#include "base/byte_archive.h"
#include "fem/materials/material.h"

#include <memory>
#include <optional>
#include <string>

namespace feldspar::fem
{
/// Isotropic stiffness; in 2D that of plane strain.
template <int dim>
StiffnessMatrix<dim> isotropic_stiffness(const double youngs_modulus, const double poissons_ratio)
{
  const double E = youngs_modulus;
  const double nu = poissons_ratio;
  const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const double G = E / (2.0 * (1.0 + nu));
  StiffnessMatrix<dim> stiffness = StiffnessMatrix<dim>::Zero();
  stiffness.template topLeftCorner<dim, dim>().setConstant(lambda);
  for (int i = 0; i < n_voigt<dim>; ++i)
    stiffness(i, i) += i < dim ? 2.0 * G : G;
  return stiffness;
}

struct ElasticConstants
{
  double youngs_modulus; ///< [Pa]
  double poissons_ratio;
};

/// Elastic constants for plane strain that give the response in the plane of a thin plate with these constants, free of
/// stress across it.
inline ElasticConstants plane_strain_equal_to_plate(const ElasticConstants& plate)
{
  const auto [E, nu] = plate;
  return {E * (1.0 + 2.0 * nu) / ((1.0 + nu) * (1.0 + nu)), nu / (1.0 + nu)};
}

/// σ = C ε.
template <int dim>
class LinearElasticPoint : public MaterialPoint<dim>
{
public:
  explicit LinearElasticPoint(const StiffnessMatrix<dim>& its_stiffness)
    : stiffness(its_stiffness)
  {
  }

  MaterialResponse<dim> trial(const StrainVector<dim>& strain) const override
  {
    return {stiffness * strain, stiffness};
  }
  void accept(const StrainVector<dim>& strain) override { stored_energy = 0.5 * strain.dot(stiffness * strain); }
  std::string stored() const override
  {
    BytesWriter writer;
    writer.value("stored_energy", stored_energy);
    return writer.all;
  }
  void restore(const std::string& stored) override { BytesReader(stored).value("stored_energy", stored_energy); }
  std::optional<PointEnergies> energies() const override { return PointEnergies{.stored = stored_energy}; }

private:
  StiffnessMatrix<dim> stiffness;
  double stored_energy = 0.0; ///< in the accepted state [J/m³]
};

template <int dim>
Material<dim> linear_elasticity(const StiffnessMatrix<dim>& stiffness)
{
  return {[stiffness](const PointPlace&) { return std::make_unique<LinearElasticPoint<dim>>(stiffness); }, {}};
}
} // namespace feldspar::fem
