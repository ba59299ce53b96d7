#pragma once

/// Parameters of the dynamics, in SI units and radians, tension positive. Default-constructed values are the defaults of
/// the input.
namespace feldspar
{
struct DynamicsParameters
{
  double damping = 0.7;          ///< α of the local non-viscous damping
  double time_step_safety = 0.8; ///< share of √(m/k) taken as step
};

/// Overlap at which a contact without a face begins to press.
enum class ZeroForce
{
  at_touch, ///< where the surfaces touch
  as_placed ///< overlaps that are there at the start count as zero force, and gaps that a bed fills
};
} // namespace feldspar
