#pragma once

#include <numbers>
#include <string>

namespace feldspar
{
/// What stands at the points of a sample.
enum class SampleMaterial
{
  grains, ///< a representative volume
  linear_elasticity,
  mohr_coulomb
};

/// A material without grains, for comparison. Modulus and Poisson's ratio are those that a test in the plane shows: the
/// out-of-plane direction is free.
struct ContinuumParameters
{
  double modulus = 62.5e9; ///< [Pa]
  double poissons_ratio = 0.16;
  double cohesion = 30e6;                                  ///< [Pa]
  double friction_angle = 50.0 * std::numbers::pi / 180.0; ///< [rad]
  double dilation_angle = 10.0 * std::numbers::pi / 180.0; ///< [rad]
};

/// The sample of a multiscale run: a mesh, and how its points get their volumes.
struct SampleParameters
{
  SampleMaterial material = SampleMaterial::grains;
  std::string mesh_file; ///< of Gmsh; empty: a rectangle
  double width = 0.050;  ///< of the rectangle [m]
  double height = 0.100; ///< along the axis of the test [m]
  unsigned int elements_across = 2;
  unsigned int elements_along = 4;
  unsigned int order = 1;
  bool rough_platens = false;
  unsigned int n_realisations = 4;       ///< volumes packed, dealt to the points
  bool random_orientation = true;        ///< each turned by an angle of its own
  double compression_step = 4e-5;        ///< axial strain between two rows of the curve
  double tension_step = 2e-6;            ///< the same
  double most_broken_share = 0.01;       ///< of all segments in one step; beyond it the step is cut
  double smallest_step_share = 1.0 / 16; ///< of a step, before there is said to be no equilibrium
  double newton_tolerance = 1e-5;        ///< unbalanced over internal force
};
} // namespace feldspar
