#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

/// Unknowns, targets and effort of a calibration, SI and radians. Default-constructed values are the defaults of
/// the input.
namespace feldspar
{
/// Figure of the uniaxial test that the laboratory reports as modulus or as Poisson's ratio.
enum class ElasticFigure
{
  tangent, ///< 40–60 % of the peak
  initial, ///< 5–20 % of the peak
  secant   ///< to 50 % of the peak
};

/// The bounds of an unknown.
struct Bounds
{
  double lower;
  double upper;
};

struct CalibrationParameters
{
  std::vector<std::string> targets; ///< names of figures; empty: all that the reference has and the tests give
  ElasticFigure youngs_modulus = ElasticFigure::tangent;
  ElasticFigure poissons_ratio = ElasticFigure::secant;
  // Unknowns without bounds keep the value of section Flat joint or Minerals.
  std::optional<Bounds> stiffness_ratio = Bounds{1.0, 4.0};
  std::optional<Bounds> cohesion_ratio = Bounds{4.0, 40.0}; ///< bond cohesion over bond tensile strength
  std::optional<Bounds> bond_friction_angle = Bounds{0.0, 40.0 * std::numbers::pi / 180.0}; ///< [rad]
  std::optional<Bounds> friction = Bounds{0.2, 1.2};
  std::optional<Bounds> installation_gap_ratio;
  std::optional<Bounds> boundary_strength; ///< of the joints between mineral grains, over that of their rule
  double tolerance = 0.03;                 ///< of a target, relative
  unsigned int n_points = 24;              ///< of the design
  unsigned int n_packings = 2;             ///< on which each of them is tested
  unsigned int n_step_packings = 4;        ///< on which a step is confirmed
  unsigned int most_steps = 5;             ///< after the design
  unsigned int most_packings = 12;         ///< fresh ones on which the answer is tested
  unsigned int n_samples = 4000;           ///< of the posterior
};
} // namespace feldspar
