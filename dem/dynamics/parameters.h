#pragma once

/// What the user may choose of the dynamics, in SI units and radians, tension positive. A default-constructed value is the
/// default.
namespace feldspar
{
struct DynamicsParameters
{
  double damping = 0.7;          ///< α of the local non-viscous damping
  double time_step_safety = 0.8; ///< share of √(m/k) taken as step
};
} // namespace feldspar
