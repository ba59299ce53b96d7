#pragma once

#include "coupling/sample/grain_material.h"
#include "coupling/sample/sample_parameters.h"
#include "fem/mesh/sample_mesh.h"

#include <string>
#include <vector>

/// The mesh of a sample: made or read, its size, its groups of cells.
namespace feldspar
{
/// The names of the boundaries that a mesh of this geometry has.
std::vector<std::string> boundaries_of(SampleGeometry geometry);

/// The mesh that the parameters describe or name. Throws ParameterError for one that is no sample of this geometry.
template <int dim>
fem::SampleMesh<dim> mesh_of(const SampleParameters& sample);

template <int dim>
SampleSize size_of(const fem::SampleMesh<dim>& mesh, const SampleParameters& sample);

/// The rocks of cells that have another one than most: of a group, or of the weak seed. All ranks know all cells: none is
/// refined.
template <int dim>
RocksOfCells rocks_of_cells(const fem::SampleMesh<dim>& mesh, const SampleParameters& sample);
} // namespace feldspar
