#include "coupling/sample/sample_mesh.h"

#include "base/parameter_id.h"
#include "base/ranks/communicator.h"
#include "coupling/sample/sample_body.h"

#include <deal.II/grid/grid_tools.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace feldspar
{
std::vector<std::string> boundaries_of(const SampleGeometry geometry)
{
  switch (geometry)
    {
    case SampleGeometry::axisymmetric:
      return {"axis", "side", "bottom", "top"};
    case SampleGeometry::cylinder:
      return {"side", "bottom", "top"};
    default:
      return {"left", "right", "bottom", "top"};
    }
}

namespace
{
template <int dim>
fem::SampleMesh<dim> made_mesh(const SampleParameters& sample)
{
  const std::array<unsigned int, 2> divisions{sample.elements_across, sample.elements_along};
  if constexpr (dim == 3)
    return fem::cylinder_sample(ranks::communicator(), 0.5 * sample.width, sample.height, divisions, 0);
  else if (sample.geometry == SampleGeometry::axisymmetric)
    return fem::axisymmetric_sample(ranks::communicator(), 0.5 * sample.width, sample.height, divisions, 0);
  else
    return fem::plane_sample(ranks::communicator(), sample.width, sample.height, divisions, 0);
}

double metres(const MeshUnit unit)
{
  return unit == MeshUnit::centimetre ? 1e-2 : unit == MeshUnit::millimetre ? 1e-3 : 1.0;
}

/// Refuses a sample that no laboratory can test, where the unit of its mesh is not said.
template <int dim>
void check_size(const fem::SampleMesh<dim>& mesh, const SampleParameters& sample)
{
  constexpr double largest = 3.0; // a mesh of a usual core in centimetres is beyond it
  const auto box = dealii::GridTools::compute_bounding_box(*mesh.triangulation);
  const double width = box.side_length(0);
  const double height = box.side_length(dim - 1);
  if (sample.mesh_unit == MeshUnit::not_said && std::max(width, height) > largest)
    throw fem::MeshError(fmt::format("in metres the mesh is {0:g} m wide and {1:g} m high; if its coordinates are in "
                                     "another unit, set {2} = mm (or cm), if it is so large, {2} = m",
                                     width, height, entry_in_words(parameter_id<&SampleParameters::mesh_unit>())));
}

template <int dim>
fem::SampleMesh<dim> read_mesh(const SampleParameters& sample)
{
  fem::SampleMesh<dim> mesh =
    fem::read_gmsh<dim>(ranks::communicator(), sample.mesh_file, 0, metres(sample.mesh_unit), sample.mesh_names);
  check_size(mesh, sample);
  for (const std::string& group : sample.groups)
    mesh.group(group);
  for (const std::string& boundary : boundaries_of(sample.geometry))
    try
      {
        mesh.boundary(boundary);
      }
    catch (const fem::MeshError& error)
      {
        throw fem::MeshError(fmt::format("{}; set {} = {} = NAME", error.what(),
                                         entry_in_words(parameter_id<&SampleParameters::mesh_names>()), boundary));
      }
  if (sample.geometry == SampleGeometry::axisymmetric)
    {
      const auto box = dealii::GridTools::compute_bounding_box(*mesh.triangulation);
      if (const double inner = box.lower_bound(0); std::abs(inner) > 1e-9 * box.side_length(0))
        throw fem::MeshError(fmt::format("begins at x = {:g} m; in r-z the axis is x = 0, and the sample reaches from "
                                         "there to x > 0",
                                         inner));
    }
  if (sample.geometry == SampleGeometry::cylinder)
    {
      const auto box = dealii::GridTools::compute_bounding_box(*mesh.triangulation);
      for (int axis = 0; axis < 2; ++axis)
        if (const double centre = 0.5 * (box.lower_bound(axis) + box.upper_bound(axis));
            std::abs(centre) > 1e-3 * box.side_length(axis))
          throw fem::MeshError(
            fmt::format("its axis lies at {} = {:g} m; a cylinder stands on x = y = 0", "xy"[axis], centre));
    }
  fem::check_places(mesh, sample.geometry == SampleGeometry::axisymmetric);
  return mesh;
}

/// Cells of the weak seed by their places alone.
template <int dim>
std::vector<std::string> cells_of_weak_seed(const fem::SampleMesh<dim>& mesh, const WeakSeed seed)
{
  const auto box = dealii::GridTools::compute_bounding_box(*mesh.triangulation);
  const double round_off = 1e-9 * box.side_length(dim - 1);
  const double middle = box.center()[dim - 1] + round_off;
  std::map<std::array<long long, dim>, std::string> row; // the outermost last
  for (const auto& cell : mesh.triangulation->active_cell_iterators())
    {
      const auto extent = cell->bounding_box();
      if (extent.lower_bound(dim - 1) > middle || extent.upper_bound(dim - 1) <= middle)
        continue;
      const auto centre = cell->center();
      std::array<long long, dim> place{}; // what differs by round-off is the same place
      for (unsigned int c = 0; c < dim; ++c)
        place[c] = std::llround(centre[c] / round_off);
      row[place] = cell->id().to_string();
    }
  if (seed == WeakSeed::element)
    return {row.rbegin()->second};
  std::vector<std::string> cells;
  for (const auto& [place, cell] : row)
    cells.push_back(cell);
  return cells;
}
} // namespace

template <int dim>
fem::SampleMesh<dim> mesh_of(const SampleParameters& sample)
{
  try
    {
      return sample.mesh_file.empty() ? made_mesh<dim>(sample) : read_mesh<dim>(sample);
    }
  catch (const fem::MeshError& error)
    {
      throw sample.mesh_file.empty()
        ? ParameterError(parameter_id<&SampleParameters::elements_across>(), fmt::format("{}", sample.elements_across),
                         error.what())
        : ParameterError(parameter_id<&SampleParameters::mesh_file>(), sample.mesh_file, error.what());
    }
}

template <int dim>
SampleSize size_of(const fem::SampleMesh<dim>& mesh, const SampleParameters& sample)
{
  const auto box = dealii::GridTools::compute_bounding_box(*mesh.triangulation);
  double largest = 0.0;
  for (const auto& cell : mesh.triangulation->active_cell_iterators())
    largest = std::max(largest, std::pow(cell->measure(), 1.0 / dim) / sample.order);
  const double sides = sample.geometry == SampleGeometry::axisymmetric ? 2.0 : 1.0;
  return {sides * box.side_length(0), box.side_length(dim - 1), largest, mesh.triangulation->n_global_active_cells()};
}

template <int dim>
RocksOfCells rocks_of_cells(const fem::SampleMesh<dim>& mesh, const SampleParameters& sample)
{
  RocksOfCells rocks;
  if (sample.weak_seed != WeakSeed::none)
    for (const std::string& cell : cells_of_weak_seed(mesh, sample.weak_seed))
      rocks[cell] = rock_of_weak_seed;
  for (const std::string& group : sample.groups)
    for (const auto& cell : mesh.triangulation->active_cell_iterators())
      if (cell->material_id() == mesh.group(group))
        rocks[cell->id().to_string()] = group;
  return rocks;
}

template decltype(mesh_of<2>) mesh_of<2>;
template decltype(mesh_of<3>) mesh_of<3>;
template decltype(size_of<2>) size_of<2>;
template decltype(size_of<3>) size_of<3>;
template decltype(rocks_of_cells<2>) rocks_of_cells<2>;
template decltype(rocks_of_cells<3>) rocks_of_cells<3>;
} // namespace feldspar
