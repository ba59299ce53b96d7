#pragma once

#include "dem/laws/bond_strength.h"
#include "dem/laws/parameters.h"

#include <array>
#include <cmath>

/// The smooth joint: two grains that meet at a plane whose normal is fixed, whatever the direction between their centres.
/// Per area of the plane it has a normal and a shear stiffness, carries tension and cohesion while it is bonded, then
/// slides by Coulomb's law and opens by dilation; it carries no moment. docs/theory.md §1.9. Signs as of the flat
/// joint.
namespace feldspar::smooth_joint
{
/// The constants of a joint.
struct Face
{
  double normal_stiffness; ///< k_n [Pa/m]
  double shear_stiffness;  ///< k_s [Pa/m]
  double friction;         ///< μ [-]
  double dilation_slope;   ///< tan ψ [-]
  Bond<double> bond;       ///< σ_c, c, tan φ
};

inline Face face(const SmoothJointParameters& wanted)
{
  return {wanted.normal_stiffness,
          wanted.shear_stiffness,
          wanted.friction,
          std::tan(wanted.dilation_angle),
          {wanted.tensile_strength, wanted.cohesion,
           wanted.friction_angle ? std::tan(*wanted.friction_angle) : wanted.friction}};
}

/// The state of a joint.
template <int dim>
struct State
{
  double gap;                               ///< of its sides: what they have opened since rest, less dilation [m]
  std::array<double, dim - 1> shear_stress; ///< τ on body 2 [Pa]
  bool bonded;
};

/// New state and event of one update, per area.
template <int dim>
struct Update
{
  State<dim> state;
  bool tension_break;
  bool shear_break;
  double released_energy; ///< by a break [J/m²]
  double slip_energy;     ///< dissipated by friction in this step [J/m²]
};

/// Returns whether the joint carries forces: its sides press, or its bond holds them.
template <int dim>
bool acts(const State<dim>& state)
{
  return state.bonded || state.gap < 0.0;
}

/// σ, tension positive [Pa].
template <int dim>
double normal_stress(const Face& face, const State<dim>& state)
{
  return acts(state) ? face.normal_stiffness * state.gap : 0.0;
}

template <std::size_t n>
double dot(const std::array<double, n>& a, const std::array<double, n>& b)
{
  double sum = 0.0;
  for (std::size_t c = 0; c < n; ++c)
    sum += a[c] * b[c];
  return sum;
}

/// [J/m²].
template <int dim>
double stored_energy(const Face& face, const State<dim>& state)
{
  return 0.5 *
         (normal_stress(face, state) * state.gap + dot(state.shear_stress, state.shear_stress) / face.shear_stiffness);
}

/// opening, slip: ΔU_n and ΔU_s of the sides over a step, across and along the plane [m].
template <int dim>
Update<dim> update(const Face& face, const State<dim>& old, const double opening,
                   const std::array<double, dim - 1>& slip)
{
  Update<dim> result{old, false, false, 0.0, 0.0};
  State<dim>& state = result.state;
  state.gap = old.gap + opening;
  std::array<double, dim - 1> trial;
  for (int c = 0; c < dim - 1; ++c)
    trial[c] = old.shear_stress[c] - face.shear_stiffness * slip[c];
  const double size = std::sqrt(dot(trial, trial));
  state.shear_stress = trial;
  if (old.bonded)
    {
      const double stress = face.normal_stiffness * state.gap;
      result.tension_break = stress > face.bond.tensile_strength;
      result.shear_break = !result.tension_break && size > shear_strength(face.bond, stress);
      if (!result.tension_break && !result.shear_break)
        return result;
      state.bonded = false;
    }

  // Coulomb; in sliding the plane opens by tan ψ of its slip, which raises the pressure that resists the slip:
  // |τ'| - k_s s = μ (p + k_n s tan ψ) gives the slip s.
  const double pressure = std::max(0.0, -face.normal_stiffness * state.gap);
  const bool broke = result.tension_break || result.shear_break;
  const double dilation_slope = pressure > 0.0 && !broke ? face.dilation_slope : 0.0;
  const double excess = size - face.friction * pressure;
  if (excess <= 0.0 && pressure > 0.0)
    return result;
  const double sliding = excess / (face.shear_stiffness + face.friction * face.normal_stiffness * dilation_slope);
  const double kept = size > 0.0 ? 1.0 - face.shear_stiffness * sliding / size : 0.0;
  for (double& component : state.shear_stress)
    component *= kept;
  state.gap -= dilation_slope * sliding;

  // Friction work by the trapezoidal rule of forces over displacements: the work of the step less the energy that the
  // joint stores. Dilation raises the pressure, so that friction takes the rest of the work.
  std::array<double, dim - 1> mean, unfollowed;
  for (int c = 0; c < dim - 1; ++c)
    {
      mean[c] = 0.5 * (old.shear_stress[c] + state.shear_stress[c]);
      unfollowed[c] = (trial[c] - state.shear_stress[c]) / face.shear_stiffness;
    }
  const double in_shear = dot(mean, unfollowed);
  if (broke)
    result.released_energy = in_shear + (state.gap > 0.0 ? 0.5 * face.normal_stiffness * old.gap * state.gap : 0.0);
  else
    result.slip_energy =
      in_shear + 0.5 * (normal_stress(face, old) + normal_stress(face, state)) * dilation_slope * sliding;
  return result;
}
} // namespace feldspar::smooth_joint
