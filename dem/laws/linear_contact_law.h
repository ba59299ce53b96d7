#pragma once

#include <array>
#include <cmath>

/// The linear law of two grains without a face, or of a grain at a wall: repulsion by overlap, Coulomb friction, no
/// tension, no moment. docs/theory.md §1.6. Units SI; signs as in the flat-joint law (Cundall and Strack 1979).
namespace feldspar::linear_contact
{
struct Stiffness
{
  double normal; ///< k_n [N/m]
  double shear;  ///< k_s [N/m]
};

/// Response of a contact.
template <int dim>
struct Response
{
  double normal_force;                     ///< F_n [N], compression positive
  std::array<double, dim - 1> shear_force; ///< F_s [N], the only state
  double slip_energy;                      ///< dissipated by friction in this step [J]
};

/// overlap [m] positive when pressed together; shear_increment ΔU_s over the step [m].
template <int dim>
Response<dim> update(const Stiffness& stiffness, const double friction,
                     const std::array<double, dim - 1>& old_shear_force, const double overlap,
                     const std::array<double, dim - 1>& shear_increment)
{
  Response<dim> response{0.0, {}, 0.0};
  if (overlap <= 0.0)
    return response;
  response.normal_force = stiffness.normal * overlap;

  std::array<double, dim - 1> trial;
  double squared = 0.0;
  for (int c = 0; c < dim - 1; ++c)
    {
      trial[c] = old_shear_force[c] - stiffness.shear * shear_increment[c];
      squared += trial[c] * trial[c];
    }
  const double limit = friction * response.normal_force;
  const bool slides = squared > limit * limit;
  const double kept = slides ? limit / std::sqrt(squared) : 1.0;
  for (int c = 0; c < dim - 1; ++c)
    {
      response.shear_force[c] = kept * trial[c];
      if (slides)
        response.slip_energy +=
          0.5 * (old_shear_force[c] + response.shear_force[c]) * (trial[c] - response.shear_force[c]) / stiffness.shear;
    }
  return response;
}
} // namespace feldspar::linear_contact
