#pragma once

#include "coupling/network/kinematics.h"

/// Parameters of a representative volume, in SI units. Default-constructed values are the defaults of the input.
namespace feldspar
{
/// Largest magnitude of a strain that is taken.
inline constexpr double largest_strain = 0.1;

enum class BreakRule
{
  near_worst, ///< every segment with at least 0.98 of the worst overload
  only_worst
};

struct EquilibriumParameters
{
  double event_tolerance = 1e-3; ///< largest unbalanced over mean contact force, between events
  double final_tolerance = 1e-6; ///< of the stress that is handed out
  BreakRule break_rule = BreakRule::near_worst;
  Kinematics kinematics = Kinematics::small_strains;
  unsigned int softening_steps = 32; ///< in which a bond softens, about; docs/theory.md §9.3
  unsigned int most_iterations = 10; ///< by Newton's method, before damped motion brings it nearer
};
} // namespace feldspar
