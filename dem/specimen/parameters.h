#pragma once

#include <string>

/// Parameters of a specimen, in SI units and radians, tension positive. Default-constructed values are the defaults of the
/// input in the plane; in space an input without a porosity means 0.36.
namespace feldspar
{
/// The body of grains to be made (or read).
struct SpecimenParameters
{
  unsigned int dimension = 2;
  std::string shape = "box";
  double width = 0.050;           ///< [m]
  double height = 0.100;          ///< along the axis of the test [m]
  double minimum_radius = 6.2e-4; ///< [m]
  double radius_ratio = 1.66;     ///< largest over smallest radius
  double porosity = 0.16;
  double bulk_density = 2700.0;       ///< [kg/m³]; a grain's is bulk / (1 - porosity)
  double packing_stress_ratio = 1e-4; ///< P_m/E*, mean stress of the packing over the grain contact modulus
  std::string joint_law = "flat joint";
  bool cored = false;            ///< packed without walls, joined everywhere, then cut free
  unsigned int cells_across = 1; ///< of a cored specimen: equal cells that it is put together from
  unsigned int cells_along = 1;  ///< the same along the axis of the test
  std::string packing_file;      ///< lines `x y [z] radius` in metres; empty: make a packing
  std::string specimen_file;     ///< a finished specimen.h5; empty: make one
};
} // namespace feldspar
