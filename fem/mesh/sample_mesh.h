#pragma once

#include <deal.II/distributed/tria.h>

#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

/// Meshes of samples, and the names of their boundaries.
///
///     plane_sample: x, y                axisymmetric_sample: r, z
///
///              top                               top
///          +---------+                      +---------+
///          |         |                      :         |
///     left |         | right           axis :         | side
///          |         |                      :         |
///        y +---------+                    z +---------+
///        ^    bottom                      ^    bottom
///        +--> x                           +--> r
///
///     cylinder_sample: x, y, z         its section, 3 cells across
///
///             .--top--.                    .-------.
///            (_________)                  |`.     .'|
///            |    :    |                  |  +---+  |
///            |  axis   | side             |  |   |  | side
///            |    :    |                  |  +---+  |
///          z |    :    |                y |.'     `.|
///          ^ (____:____)                ^  '-------'
///          |    bottom                  |
///          +--> x                       +--> x
namespace feldspar::fem
{
/// A mesh or boundary that cannot be used, reported in one line.
struct MeshError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

template <int dim>
struct SampleMesh
{
  std::unique_ptr<dealii::parallel::distributed::Triangulation<dim>> triangulation;
  std::map<std::string, dealii::types::boundary_id> boundaries;
  std::map<std::string, dealii::types::material_id> groups = {}; ///< of cells

  /// Throws MeshError, which says what names there are.
  dealii::types::boundary_id boundary(const std::string& name) const;
  /// The same of a group of cells, none of which may be in another one.
  dealii::types::material_id group(const std::string& name) const;
};

/// The coordinates of a place, for messages.
template <int dim>
std::string coordinates(const dealii::Point<dim>& place)
{
  return fmt::format("{:g}", fmt::join(place.begin_raw(), place.end_raw(), ", "));
}

/// A rectangle with its lower left corner at the origin. divisions: cells along x and y before refinement, each of
/// which halves them.
SampleMesh<2> plane_sample(MPI_Comm communicator, double width, double height, std::array<unsigned int, 2> divisions,
                           unsigned int n_refinements);

/// Half of the section of a cylinder standing at the origin, its axis the line r = 0.
SampleMesh<2> axisymmetric_sample(MPI_Comm communicator, double radius, double height,
                                  std::array<unsigned int, 2> divisions, unsigned int n_refinements);

/// A cylinder standing on the origin, its axis the last coordinate. divisions: cells across its diameter, at least 3,
/// and along the axis. About half of those across make a square in the middle; rings of cells about it lead over to the
/// circle, on which refinement and elements of order 2 lie.
SampleMesh<3> cylinder_sample(MPI_Comm communicator, double radius, double height,
                              std::array<unsigned int, 2> divisions, unsigned int n_refinements);

/// Names of boundaries, and the groups of a mesh file that each consists of.
using BoundaryNames = std::map<std::string, std::vector<std::string>>;

/// A Gmsh file (.msh, format 2 or 4, text or binary) of quadrilaterals or hexahedra, whose coordinates count in a unit [m].
/// Boundaries are its physical groups of lines or surfaces, by their names in the file or by `names`; groups of cells those of
/// surfaces or volumes. Throws MeshError.
template <int dim>
SampleMesh<dim> read_gmsh(MPI_Comm communicator, const std::filesystem::path& file, unsigned int n_refinements,
                          double unit = 1.0, const BoundaryNames& names = {});

/// Checks that the boundaries of a laboratory test lie where their names say: bottom and top are the whole lower and upper
/// end, flat and level; left and right, in r-z axis and side, in space side alone lie about the sample and face the right
/// way. The last coordinate counts upwards. Other boundaries may lie where none of these has its place.
///
/// A place holds to within a thousandth of the width of the sample. Laboratories prepare the ends of a specimen so:
/// at most 0.05 mm in 50 mm out of square with its axis (ISRM, ASTM D4543).
///
/// Throws MeshError, which says what lies where. in_r_z: the first coordinate of a mesh in the plane is a radius.
template <int dim>
void check_places(const SampleMesh<dim>& mesh, bool in_r_z);
} // namespace feldspar::fem
