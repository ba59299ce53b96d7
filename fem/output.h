#pragma once

#include "fem/solid/solid.h"

#include <deal.II/base/data_out_base.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// Fields of a solid as a time series for ParaView: displacement at the nodes; stress, strain and what the material
/// names, each the mean over its cell; and the number of the cell, which does not depend on the number of ranks. Every
/// rank writes its cells.
///
/// FOLDER/NAME.xdmf   open this one
/// FOLDER/NAME.h5     the mesh; after cells have moved between ranks NAME-mesh-0007.h5, the same with its cells in
///                    another order, for the fields from then on
/// FOLDER/NAME-0000.h5, NAME-0001.h5, …   the fields, one file a time
class FieldOutput
{
public:
  FieldOutput(const std::filesystem::path& folder, const std::string& name);

  /// Adds the accepted state. Collective. The index file is whole after every call.
  template <int dim, int material_dim>
  void write(const Solid<dim, material_dim>& solid, double time);

  std::size_t n_written() const { return entries.size(); }
  /// The record of all times written so far, for another FieldOutput of the same folder and name that continues it.
  std::string stored() const;
  void restore(const std::string& stored);

private:
  std::filesystem::path folder;
  std::string name;
  std::vector<dealii::XDMFEntry> entries;
  std::string mesh_file;
  std::vector<std::uint64_t> mesh_of_ranks; ///< numbers of cells, in the file of the mesh
};
} // namespace feldspar::fem
