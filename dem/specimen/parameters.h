#pragma once

#include "base/body.h"

#include <string>
#include <vector>

/// Parameters of a specimen, in SI units and radians, tension positive. Default-constructed values are the defaults of the
/// input in the plane; in space an input without a porosity means 0.36.
namespace feldspar
{
/// Choice whether a specimen is cut out of a periodic body; docs/theory.md §3.
enum class Coring
{
  none,       ///< packed between walls
  free_sides, ///< packed as a periodic cell, then cut at the sides and at the ends
  sides_only  ///< packed between the walls of its ends and periodic sideways, then cut at the sides
};

/// Distribution of the radii between the smallest and the largest. The bounds of the normal ones, of the radius or of its
/// logarithm, lie three standard deviations from the middle.
enum class SizeDistribution
{
  uniform,
  normal,
  log_normal
};

/// A point of a sieve curve.
struct SievePoint
{
  double size;    ///< diameter [m]
  double passing; ///< share of the mass in smaller grains
};

/// Default porosity in three dimensions.
inline constexpr double porosity_in_space = 0.36;

/// The body of grains to be made (or read).
struct SpecimenParameters
{
  unsigned int dimension = 2;
  BodyShape shape = BodyShape::box;
  double width = 0.050;           ///< [m]
  double height = 0.100;          ///< along the axis of the test [m]
  double minimum_radius = 6.2e-4; ///< [m]
  double radius_ratio = 1.66;     ///< largest over smallest radius
  SizeDistribution size_distribution = SizeDistribution::uniform;
  std::vector<SievePoint> sieve_curve; ///< from 0 to 1; empty: the radii are drawn
  double porosity = 0.16;
  double bulk_density = 2700.0;       ///< [kg/m³]; a grain's is bulk / (1 - porosity)
  double packing_stress_ratio = 1e-4; ///< P_m/E*, mean stress of the packing over the grain contact modulus
  bool packed_by_descent = true;      ///< grains come to rest by descent, not by damped dynamics
  std::string joint_law = "flat joint";
  Coring coring = Coring::none;
  unsigned int cells_across = 1;     ///< of a cored specimen: equal cells that it is put together from, along each side
  unsigned int cells_along = 1;      ///< the same along the axis of the test
  std::string packing_file;          ///< empty: make a packing
  double packing_unit = 1.0;         ///< length of 1 in columns of the packing file without a unit [m]
  std::vector<double> packing_shift; ///< of its grains, after their unit; empty: none [m]
  std::string specimen_file;         ///< a finished specimen.h5; empty: make one

  double largest_radius() const
  {
    return sieve_curve.empty() ? radius_ratio * minimum_radius : 0.5 * sieve_curve.back().size;
  }

  bool is_cored() const { return coring != Coring::none; }

  /// Shape of the cell that a cored specimen is cut from; of any other specimen its own.
  BodyShape shape_when_packed() const
  {
    return !is_cored() ? shape : coring == Coring::sides_only ? BodyShape::periodic_sideways : BodyShape::periodic;
  }
};
} // namespace feldspar
