#pragma once

#include "base/simd.h"

#include <array>

/// The linear law of two grains without a face, of those beside a parallel bond, or of a grain at a wall: repulsion by
/// overlap, Coulomb friction, no tension, no moment. docs/theory.md §1.6. Units SI; signs as in the flat-joint law
/// (Cundall and Strack 1979).
namespace feldspar::linear_contact
{
template <typename Real>
struct Stiffness
{
  Real normal; ///< k_n [N/m]
  Real shear;  ///< k_s [N/m]
};

/// Response of a contact.
template <int dim, typename Real>
struct Response
{
  Real normal_force;                     ///< F_n [N], compression positive
  std::array<Real, dim - 1> shear_force; ///< F_s [N], the only state
  Real slip_energy;                      ///< dissipated in this step by friction, and by coming apart [J]
};

/// overlap [m] positive when pressed together; shear_increment ΔU_s over the step [m].
template <int dim, typename Real>
Response<dim, Real> update(const Stiffness<Real>& stiffness, const Real& friction,
                           const std::array<Real, dim - 1>& old_shear_force, const Real& overlap,
                           const std::array<Real, dim - 1>& shear_increment)
{
  Response<dim, Real> response{stiffness.normal * simd::larger(Real(0.0), overlap), {}, Real(0.0)};
  auto& force = response.shear_force;
  Real squared(0.0);
  for (int c = 0; c < dim - 1; ++c)
    {
      force[c] = old_shear_force[c] - stiffness.shear * shear_increment[c];
      squared += force[c] * force[c];
    }
  const Real limit = friction * response.normal_force;
  const auto slides = squared > limit * limit;
  if (!simd::any(slides))
    return response;
  // A contact that is not pressed keeps nothing. Most that slide in a whole specimen are such; roots and divisions are dear.
  const auto slides_pressed = slides && limit > 0.0;
  Real kept = simd::select(slides, Real(0.0), Real(1.0));
  if (simd::any(slides_pressed))
    kept = simd::select(slides_pressed, limit / simd::square_root(simd::select(slides, squared, Real(1.0))), kept);
  // Slip is the shear that the force did not follow, under the mean of the forces before and after.
  for (int c = 0; c < dim - 1; ++c)
    {
      const Real trial = force[c];
      force[c] = kept * trial;
      const Real work = simd::select(slides, 0.5 * (old_shear_force[c] + force[c]) * (trial - force[c]), Real(0.0));
      if (simd::any(work != 0.0))
        response.slip_energy += work / stiffness.shear;
    }
  return response;
}
} // namespace feldspar::linear_contact
