#pragma once

#include "results/fits/fit.h"

namespace feldspar
{
/// sigma_1 = q_u + N_phi sigma_3, with N_phi = (1 + sin phi)/(1 - sin phi) and q_u = 2 c sqrt(N_phi).
struct MohrCoulombFit
{
  Estimate uniaxial_strength; ///< q_u [Pa]
  Estimate slope;             ///< N_phi
  Estimate friction_angle;    ///< phi [rad]
  Estimate cohesion;          ///< c [Pa]
  FitQuality quality;

  double sigma_1(double sigma_3) const;
};

/// Linear least squares in sigma_1 over the points with sigma_3 >= 0 (docs/theory.md §6.2).
FitOrReason<MohrCoulombFit> fit_mohr_coulomb(const StrengthData& data);
} // namespace feldspar
