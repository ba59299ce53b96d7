#include "calibration/unknowns.h"

#include <cmath>
#include <numbers>

namespace feldspar::calibration
{
double Unknown::value(const double coordinate) const
{
  return logarithmic ? bounds.lower * std::pow(bounds.upper / bounds.lower, coordinate)
                     : bounds.lower + coordinate * (bounds.upper - bounds.lower);
}

double Unknown::coordinate(const double value) const
{
  return logarithmic ? std::log(value / bounds.lower) / std::log(bounds.upper / bounds.lower)
                     : (value - bounds.lower) / (bounds.upper - bounds.lower);
}

std::vector<Unknown> unknowns(const CalibrationParameters& wanted)
{
  std::vector<Unknown> all;
  const auto add = [&](const std::optional<Bounds>& bounds, const char* name, const char* title, const char* unit,
                       const double unit_size, double MicroParameters::*member, const bool logarithmic) {
    if (bounds)
      all.push_back({name, title, unit, unit_size, member, *bounds, logarithmic});
  };
  constexpr double degree = std::numbers::pi / 180.0;
  add(wanted.stiffness_ratio, "stiffness_ratio", "stiffness ratio", "", 1.0, &MicroParameters::stiffness_ratio, true);
  add(wanted.cohesion_ratio, "cohesion_ratio", "bond cohesion over tensile strength", "", 1.0,
      &MicroParameters::cohesion_ratio, true);
  add(wanted.bond_friction_angle, "bond_friction_angle", "bond friction angle", "deg", degree,
      &MicroParameters::bond_friction_angle, false);
  add(wanted.friction, "friction", "friction", "", 1.0, &MicroParameters::friction, false);
  add(wanted.boundary_strength, "boundary_strength", "boundary strength of minerals", "", 1.0,
      &MicroParameters::boundary_strength, true);
  add(wanted.installation_gap_ratio, "installation_gap_ratio", "installation gap over mean radius", "", 1.0, nullptr,
      true);
  return all;
}

MicroParameters parameters_at(const UnitPoint& point, const std::vector<Unknown>& unknowns,
                              const MicroParameters& fixed)
{
  MicroParameters parameters = fixed;
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    if (unknowns[k].member)
      parameters.*unknowns[k].member = unknowns[k].value(point[k]);
    else
      parameters.gap = unknowns[k].value(point[k]);
  return parameters;
}
} // namespace feldspar::calibration
