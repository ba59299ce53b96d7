#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace feldspar
{
/// A sample and its mesh.
enum class SampleGeometry
{
  plane,        ///< RVEs of discs, one metre thick
  plane_strain, ///< RVEs of spheres; nothing strains across the plane
  axisymmetric, ///< a cylinder of spheres by half of its section, r and z
  cylinder      ///< of spheres, as a whole
};

/// Choice of the RVEs of a sample that are weaker than the others.
enum class WeakSeed
{
  none,
  row,    ///< of the elements across the sample that the plane just above mid-height cuts
  element ///< of that row, the one outermost along x or r
};

/// Unit of the coordinates of a mesh file.
enum class MeshUnit
{
  not_said, ///< metres, of a sample that fits a laboratory
  metre,
  centimetre,
  millimetre
};

/// The dimension of the RVEs at its points.
constexpr unsigned int dimension_of_rves(const SampleGeometry geometry)
{
  return geometry == SampleGeometry::plane ? 2 : 3;
}

/// The sample of a multiscale run: a mesh, and how its points get their RVEs.
struct SampleParameters
{
  SampleGeometry geometry = SampleGeometry::plane;
  std::string material = "grains"; ///< an RVE at each point; else the name of a continuum (continua/continua.h)
  std::string mesh_file;           ///< of Gmsh; empty: a rectangle or a cylinder
  /// Boundaries, and the groups of the mesh file that each consists of; others have their names in the file.
  std::map<std::string, std::vector<std::string>> mesh_names;
  MeshUnit mesh_unit = MeshUnit::not_said;
  double width = 0.050;             ///< of the rectangle, diameter of the cylinder [m]
  double height = 0.100;            ///< along the axis of the test [m]
  unsigned int elements_across = 2; ///< over the width; axisymmetric: over the radius
  unsigned int elements_along = 4;
  unsigned int order = 1;
  bool reduced_quadrature = false; ///< order instead of order + 1 points a direction
  bool rough_platens = false;
  bool widened_past_peak = false;    ///< a compression test; else its platens go on
  bool scaled_softening = true;      ///< with the size of the element over that of the RVE
  unsigned int n_realisations = 4;   ///< RVEs packed, assigned to the points
  bool random_orientation = true;    ///< each turned by an angle of its own
  bool assigned_to_elements = false; ///< the points of an element have the same RVE in the same orientation
  bool without_replacement = false;  ///< no realisation is used twice before all are; else with replacement
  std::string rocks_file;            ///< a CSV table of the rocks of groups of cells; empty: one rock
  std::vector<std::string> groups;   ///< of cells of the mesh file that consist of a rock of their own
  WeakSeed weak_seed = WeakSeed::none;
  double weak_seed_strength = 0.9;       ///< share of the strengths that RVEs there have
  double compression_step = 4e-5;        ///< axial strain between two rows of the curve
  double tension_step = 2e-6;            ///< the same
  double most_broken_share = 0.01;       ///< of all segments in one step; beyond it the step is cut
  double smallest_step_share = 1.0 / 16; ///< of a step, before there is said to be no equilibrium
  double newton_tolerance = 1e-5;        ///< unbalanced over internal force

  bool has_grains() const { return material == "grains"; }
};

/// The measures of a sample's mesh.
struct SampleSize
{
  double width;           ///< of a cylinder the diameter [m]
  double height;          ///< [m]
  double largest_element; ///< as PointPlace::element_size [m]
  std::uint64_t n_cells;  ///< of all ranks; each needs one at least
};

/// Reads or makes the mesh. Throws InputError where it cannot be used: no quadrilaterals or hexahedra, inverted, a
/// boundary of a laboratory test is missing.
SampleSize measure(const SampleParameters& sample);
} // namespace feldspar
