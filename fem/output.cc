#include "fem/output.h"

#include "base/system/hdf5_archive.h"
#include "base/voigt.h"
#include "base/whole_file.h"

#include <deal.II/base/mpi.h>
#include <deal.II/numerics/data_out.h>

#include <boost/archive/text_iarchive.hpp>
#include <boost/archive/text_oarchive.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <fmt/format.h>
#include <hdf5.h>

#include <functional>
#include <sstream>
#include <utility>

namespace feldspar::fem
{
namespace
{
struct CellField
{
  std::string name;
  dealii::Vector<double> values;
};

template <int dim, int material_dim>
std::vector<CellField> cell_fields(const Solid<dim, material_dim>& solid)
{
  std::vector<CellField> fields;
  const auto add = [&](const std::string& name, const auto& value_at_point) {
    CellField field{name, dealii::Vector<double>(solid.dofs().get_triangulation().n_active_cells())};
    std::size_t point = 0;
    for (const auto& cell : solid.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          double sum = 0.0;
          double volume = 0.0;
          for (unsigned int q = 0; q < solid.n_points_per_cell(); ++q, ++point)
            {
              sum += solid.volumes()[point] * value_at_point(point);
              volume += solid.volumes()[point];
            }
          field.values[cell->active_cell_index()] = sum / volume;
        }
    fields.push_back(std::move(field));
  };

  add("cell", [&](const std::size_t i) { return double(solid.places()[i].cell_number); });
  const auto components = component_names<dim, material_dim>(solid.kinematics());
  for (std::size_t c = 0; c < components.size(); ++c)
    if (!components[c].empty())
      {
        add("stress_" + components[c] + "_Pa", [&](const std::size_t i) { return solid.responses()[i].stress[c]; });
        add("strain_" + components[c],
            [&](const std::size_t i) { return solid.strains()[i][c] / engineering_factor<material_dim>(int(c)); });
      }

  std::vector<std::vector<double>> material_fields;
  for (std::size_t i = 0; i < solid.material_points().size(); ++i)
    material_fields.push_back(solid.material_points()[i].fields());
  for (std::size_t f = 0; f < solid.field_names().size(); ++f)
    add(solid.field_names()[f], [&](const std::size_t i) { return material_fields[i].at(f); });
  return fields;
}

/// Does work on the first rank while the others wait. An OutputError there is thrown on all ranks.
void by_first(const MPI_Comm communicator, const std::function<void()>& work)
{
  std::string problem;
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    try
      {
        work();
      }
    catch (const OutputError& error)
      {
        problem = error.what();
      }
  problem = dealii::Utilities::MPI::broadcast(communicator, problem);
  if (!problem.empty())
    throw OutputError(problem);
}

/// Throws OutputError with the reason why a file cannot be written. The exception of deal.II tells neither the file nor
/// the reason, and leaves files of HDF5 open, which would be closed when MPI is down already.
[[noreturn]] void say_why(const std::filesystem::path& file)
{
  H5close();
  write_whole_file(file, "nothing"); // which tells the cause, if it is still there
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  throw OutputError(fmt::format("{}: cannot be written", file.string()));
}
} // namespace

FieldOutput::FieldOutput(const std::filesystem::path& its_folder, const std::string& its_name)
  : folder(its_folder)
  , name(its_name)
{
}

template <int dim, int material_dim>
void FieldOutput::write(const Solid<dim, material_dim>& solid, const double time)
{
  dealii::DataOut<dim> out;
  out.attach_dof_handler(solid.dofs());
  out.add_data_vector(solid.displacement(), std::vector<std::string>(dim, "displacement"),
                      dealii::DataOut<dim>::type_dof_data,
                      std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>(
                        dim, dealii::DataComponentInterpretation::component_is_part_of_vector));
  const auto fields = cell_fields(solid);
  for (const CellField& field : fields)
    out.add_data_vector(field.values, field.name, dealii::DataOut<dim>::type_cell_data);
  out.build_patches(solid.geometry());

  // Nodes are not merged: fields of cells jump between them.
  dealii::DataOutBase::DataOutFilter filter(dealii::DataOutBase::DataOutFilterFlags(false, true));
  out.write_filtered_data(filter);
  // Ranks have their pieces of a curve through all cells one after another, so that how many each has tells the order.
  const auto of_ranks = dealii::Utilities::MPI::all_gather(
    solid.communicator(), std::uint64_t(solid.places().size() / solid.n_points_per_cell()));
  const bool another_mesh = of_ranks != mesh_of_ranks;
  if (another_mesh)
    {
      mesh_file = entries.empty() ? name + ".h5" : fmt::format("{}-mesh-{:04}.h5", name, entries.size());
      mesh_of_ranks = of_ranks;
    }
  const std::string fields_file = fmt::format("{}-{:04}.h5", name, entries.size());
  const std::filesystem::path xdmf_file = folder / (name + ".xdmf");
  std::vector<std::filesystem::path> files{folder / fields_file};
  if (another_mesh)
    files.push_back(folder / mesh_file);
  by_first(solid.communicator(), [&] {
    for (const std::filesystem::path& file : files)
      make_way_for(file);
    make_way_for(xdmf_file);
  });
  try
    {
      out.write_hdf5_parallel(filter, another_mesh, (folder / mesh_file).string(), (folder / fields_file).string(),
                              solid.communicator());
    }
  catch (const dealii::ExceptionBase&)
    {
      say_why(folder / fields_file);
    }
  by_first(solid.communicator(), [&] {
    for (const std::filesystem::path& file : files)
      seal_hdf5(file);
  });
  entries.push_back(out.create_xdmf_entry(filter, mesh_file, fields_file, time, solid.communicator()));
  try
    {
      out.write_xdmf_file(entries, xdmf_file.string(), solid.communicator());
    }
  catch (const dealii::ExceptionBase&)
    {
      say_why(xdmf_file);
    }
}

// deal.II's entries of an XDMF file can be stored by Boost's archives alone.
std::string FieldOutput::stored() const
{
  std::ostringstream text;
  boost::archive::text_oarchive archive(text);
  archive << entries << mesh_file << mesh_of_ranks;
  return text.str();
}

void FieldOutput::restore(const std::string& stored)
{
  std::istringstream text(stored);
  boost::archive::text_iarchive archive(text);
  archive >> entries >> mesh_file >> mesh_of_ranks;
}

template void FieldOutput::write(const Solid<2, 2>&, double);
template void FieldOutput::write(const Solid<2, 3>&, double);
template void FieldOutput::write(const Solid<3, 3>&, double);
} // namespace feldspar::fem
