#include "fem/mesh/sample_mesh.h"

#include "base/input_error.h"
#include "fem/mesh/gmsh_mesh.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
template <int dim>
std::unique_ptr<parallel::distributed::Triangulation<dim>> empty_triangulation(const MPI_Comm communicator)
{
  return std::make_unique<parallel::distributed::Triangulation<dim>>(communicator);
}

void expect_positive(const double width, const double height, const std::array<unsigned int, 2> divisions)
{
  if (!(width > 0.0 && height > 0.0) || divisions[0] == 0 || divisions[1] == 0)
    throw MeshError(fmt::format("a sample of {:g} m by {:g} m in {} by {} cells: all must be positive", width, height,
                                divisions[0], divisions[1]));
}

SampleMesh<2> rectangle(const MPI_Comm communicator, const double width, const double height,
                        const std::array<unsigned int, 2> divisions, const unsigned int n_refinements,
                        const std::map<std::string, types::boundary_id>& boundaries)
{
  expect_positive(width, height, divisions);
  SampleMesh<2> mesh{empty_triangulation<2>(communicator), boundaries};
  GridGenerator::subdivided_hyper_rectangle(*mesh.triangulation, {divisions[0], divisions[1]}, Point<2>(),
                                            Point<2>(width, height), true);
  mesh.triangulation->refine_global(n_refinements);
  return mesh;
}

template <typename Id>
Id found_in(const std::map<std::string, Id>& all, const char* const kind, const std::string& name)
{
  if (const auto found = all.find(name); found != all.end())
    return found->second;
  std::vector<std::string> names;
  for (const auto& [known, id] : all)
    names.push_back(known);
  throw MeshError(fmt::format("no {} is named {}; the mesh has {}", kind, name,
                              names.empty() ? "none with a name" : fmt::format("{}", fmt::join(names, ", "))));
}
} // namespace

template <int dim>
types::boundary_id SampleMesh<dim>::boundary(const std::string& name) const
{
  return found_in(boundaries, "boundary", name);
}

template <int dim>
types::material_id SampleMesh<dim>::group(const std::string& name) const
{
  for (const auto& cell : triangulation->active_cell_iterators())
    if (cell->material_id() == GmshMesh::several_groups)
      throw MeshError(fmt::format("the cell at ({}) m is in several physical groups, and a rock is that of one",
                                  coordinates(cell->center())));
  return found_in(groups, "group of cells", name);
}

SampleMesh<2> plane_sample(const MPI_Comm communicator, const double width, const double height,
                           const std::array<unsigned int, 2> divisions, const unsigned int n_refinements)
{
  return rectangle(communicator, width, height, divisions, n_refinements,
                   {{"left", 0}, {"right", 1}, {"bottom", 2}, {"top", 3}}); // the order of GridGenerator
}

SampleMesh<2> axisymmetric_sample(const MPI_Comm communicator, const double radius, const double height,
                                  const std::array<unsigned int, 2> divisions, const unsigned int n_refinements)
{
  return rectangle(communicator, radius, height, divisions, n_refinements,
                   {{"axis", 0}, {"side", 1}, {"bottom", 2}, {"top", 3}});
}

namespace
{
/// A disc about the origin in n_across cells from side to side. A square of k by k cells with rings of 4k cells about
/// it, as many as make up n_across; k is about half of it.
///
/// The nodes of a ring are numbered against the clock from the corner at the lower left, ring 0 on the square.
void make_disc(Triangulation<2>& disc, const double radius, const unsigned int n_across)
{
  unsigned int k = n_across / 2;
  if ((n_across - k) % 2 == 1)
    --k;
  const unsigned int n_rings = (n_across - k) / 2;
  const unsigned int n_around = 4 * k;
  const double half_width = radius * k / n_across;

  std::vector<Point<2>> nodes;
  for (unsigned int j = 0; j <= k; ++j)
    for (unsigned int i = 0; i <= k; ++i)
      nodes.emplace_back(half_width * (2.0 * i / k - 1.0), half_width * (2.0 * j / k - 1.0));
  const auto in_square = [&](const unsigned int i, const unsigned int j) { return j * (k + 1) + i; };
  const auto on_square = [&](const unsigned int around) {
    const unsigned int along = around % k;
    switch (around % n_around / k)
      {
      case 0:
        return in_square(along, 0);
      case 1:
        return in_square(k, along);
      case 2:
        return in_square(k - along, k);
      default:
        return in_square(0, k - along);
      }
  };
  for (unsigned int ring = 1; ring <= n_rings; ++ring)
    for (unsigned int around = 0; around < n_around; ++around)
      {
        const double angle = std::numbers::pi * (-0.75 + 2.0 * around / n_around);
        const Point<2> on_circle(radius * std::cos(angle), radius * std::sin(angle));
        const Point<2> from = nodes[on_square(around)];
        nodes.push_back(from + double(ring) / n_rings * (on_circle - from));
      }
  const auto in_ring = [&](const unsigned int around, const unsigned int ring) {
    return ring == 0 ? on_square(around) : (k + 1) * (k + 1) + (ring - 1) * n_around + around % n_around;
  };

  std::vector<CellData<2>> cells;
  const auto add = [&](const std::array<unsigned int, 4>& corners) {
    CellData<2> cell;
    cell.vertices.assign(corners.begin(), corners.end());
    cells.push_back(cell);
  };
  for (unsigned int j = 0; j < k; ++j)
    for (unsigned int i = 0; i < k; ++i)
      add({in_square(i, j), in_square(i + 1, j), in_square(i, j + 1), in_square(i + 1, j + 1)});
  for (unsigned int ring = 0; ring < n_rings; ++ring)
    for (unsigned int around = 0; around < n_around; ++around)
      add({in_ring(around, ring), in_ring(around, ring + 1), in_ring(around + 1, ring), in_ring(around + 1, ring + 1)});
  GridTools::consistently_order_cells(cells);
  disc.create_triangulation(nodes, cells, SubCellData());
}
} // namespace

SampleMesh<3> cylinder_sample(const MPI_Comm communicator, const double radius, const double height,
                              const std::array<unsigned int, 2> divisions, const unsigned int n_refinements)
{
  expect_positive(radius, height, divisions);
  if (divisions[0] < 3)
    throw MeshError(fmt::format("a cylinder of {} cells across: there must be at least 3", divisions[0]));
  Triangulation<2> disc;
  make_disc(disc, radius, divisions[0]);
  SampleMesh<3> mesh{empty_triangulation<3>(communicator), {{"side", 0}, {"bottom", 1}, {"top", 2}}}; // as extruded
  GridGenerator::extrude_triangulation(disc, divisions[1] + 1, height, *mesh.triangulation);
  constexpr types::manifold_id round = 1;
  // Face by face: set_all_manifold_ids_on_boundary() would also take the lines within the ends for some of the side.
  for (const auto& cell : mesh.triangulation->active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == mesh.boundary("side"))
        face->set_all_manifold_ids(round);
  mesh.triangulation->set_manifold(round, CylindricalManifold<3>(2));
  mesh.triangulation->refine_global(n_refinements);
  return mesh;
}

template <int dim>
SampleMesh<dim> read_gmsh(const MPI_Comm communicator, const std::filesystem::path& file,
                          const unsigned int n_refinements, const double unit, const BoundaryNames& names)
{
  GmshMesh from_file;
  try
    {
      from_file = read_gmsh_mesh(file, dim);
    }
  catch (const InputError& error)
    {
      throw MeshError(error.what());
    }
  std::vector<Point<dim>> vertices(from_file.nodes.size());
  for (std::size_t k = 0; k < vertices.size(); ++k)
    for (unsigned int d = 0; d < dim; ++d)
      vertices[k][d] = from_file.nodes[k][d];
  std::vector<CellData<dim>> cells(from_file.cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    {
      cells[c].material_id = from_file.cells[c].group;
      for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_cell; ++v)
        cells[c].vertices[GeometryInfo<dim>::ucd_to_deal[v]] = from_file.cells[c].nodes[v];
    }
  SampleMesh<dim> mesh{empty_triangulation<dim>(communicator),
                       {from_file.groups.begin(), from_file.groups.end()},
                       {from_file.groups_of_cells.begin(), from_file.groups_of_cells.end()}};
  std::map<types::boundary_id, types::boundary_id> joined; // groups into the first of their boundary
  auto boundaries = mesh.boundaries;
  for (const auto& [name, groups] : names)
    for (const std::string& group : groups)
      joined[mesh.boundary(group)] = boundaries[name] = mesh.boundary(groups.front());
  mesh.boundaries = boundaries;
  SubCellData boundary;
  for (const auto& side : from_file.sides)
    {
      CellData<dim - 1> data;
      for (unsigned int v = 0; v < GeometryInfo<dim - 1>::vertices_per_cell; ++v)
        data.vertices[GeometryInfo<dim - 1>::ucd_to_deal[v]] = side.nodes[v];
      const auto becomes = joined.find(side.group);
      data.boundary_id = becomes == joined.end() ? side.group : becomes->second;
      if constexpr (dim == 2)
        boundary.boundary_lines.push_back(data);
      else
        boundary.boundary_quads.push_back(data);
    }

  // Into a serial triangulation first, which also takes what the distributed one does not.
  Triangulation<dim> coarse;
  try
    {
      GridTools::delete_unused_vertices(vertices, cells, boundary);
      GridTools::invert_cells_with_negative_measure(vertices, cells);
      GridTools::consistently_order_cells(cells);
      coarse.create_triangulation(vertices, cells, boundary);
    }
  catch (const typename Triangulation<dim>::DistortedCellList& list)
    {
      throw MeshError(fmt::format("{} of its cells are inverted or flat", list.distorted_cells.size()));
    }
  catch (const std::exception&)
    {
      // deal.II's own text runs over many lines with a stack trace.
      throw MeshError(fmt::format("is not a Gmsh mesh of {} whose cells all have positive {}",
                                  dim == 2 ? "quadrilaterals" : "hexahedra", dim == 2 ? "area" : "volume"));
    }
  for (const auto& cell : coarse.active_cell_iterators())
    {
      // The Jacobian at each corner; a corner that turns the wrong way inverts part of the cell.
      Point<dim> corners[GeometryInfo<dim>::vertices_per_cell];
      Tensor<0, dim> jacobians[GeometryInfo<dim>::vertices_per_cell];
      for (const unsigned int v : cell->vertex_indices())
        corners[v] = cell->vertex(v);
      GeometryInfo<dim>::alternating_form_at_vertices(corners, jacobians);
      for (const unsigned int v : cell->vertex_indices())
        if (!(jacobians[v] > 0.0))
          throw MeshError(
            fmt::format("the cell at ({}) m is inverted or flat at a corner", coordinates(cell->center())));
    }
  if (unit != 1.0)
    GridTools::scale(unit, coarse);
  mesh.triangulation->copy_triangulation(coarse);
  mesh.triangulation->refine_global(n_refinements);
  return mesh;
}

template struct SampleMesh<2>;
template struct SampleMesh<3>;
template SampleMesh<2> read_gmsh<2>(MPI_Comm, const std::filesystem::path&, unsigned int, double, const BoundaryNames&);
template SampleMesh<3> read_gmsh<3>(MPI_Comm, const std::filesystem::path&, unsigned int, double, const BoundaryNames&);
} // namespace feldspar::fem
