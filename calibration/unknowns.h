#pragma once

#include "calibration/open_turns.h"
#include "calibration/parameters.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar::calibration
{
/// The micro-parameters that a calibration may seek.
struct MicroParameters
{
  double modulus;               ///< E of the joints [Pa]
  double bond_tensile_strength; ///< [Pa]
  double stiffness_ratio;
  double cohesion_ratio;      ///< bond cohesion over bond tensile strength
  double bond_friction_angle; ///< [rad]
  double friction;
  std::optional<double> gap;      ///< installation gap over the mean radius; none: by the coordination number
  double boundary_strength = 1.0; ///< of the joints between mineral grains, over that of their rule
};

/// One of the dimensionless ones, between its bounds.
struct Unknown
{
  std::string name;                ///< in files
  std::string title;               ///< in tables
  std::string unit;                ///< in tables
  double unit_size;                ///< in SI
  double MicroParameters::*member; ///< null: the gap
  Bounds bounds;
  bool logarithmic; ///< over more than a factor: spread evenly over its logarithm

  double value(double coordinate) const; ///< of a coordinate between 0 and 1
  double coordinate(double value) const;
  double of(const MicroParameters& parameters) const { return member ? parameters.*member : parameters.gap.value(); }
};

/// The dimensionless micro-parameters that have bounds, in a fixed order.
std::vector<Unknown> unknowns(const CalibrationParameters& wanted);

/// `fixed` with the unknowns at a point of the unit cube.
MicroParameters parameters_at(const UnitPoint& point, const std::vector<Unknown>& unknowns,
                              const MicroParameters& fixed);
} // namespace feldspar::calibration
