#include "results/folder/vtk_data.h"

#include "base/whole_file.h"

#include <fmt/format.h>

#include <bit>
#include <iterator>
#include <numeric>

namespace feldspar
{
namespace
{
static_assert(std::endian::native == std::endian::little, "the byte order that the files say they have");

std::vector<float> flat(const VtkData::Components& values)
{
  std::vector<float> result;
  for (const auto& value : values)
    for (const double component : value)
      result.push_back(float(component));
  return result;
}

struct CellForm
{
  std::size_t n_points;
  const char* element; ///< of the file
};

constexpr CellForm forms[] = {{1, "Verts"},
                              {2, "Lines"},
                              {4, "Polys"},
                              {8, "Cells"}}; // of VtkData::Cells, by its enumerators
} // namespace

VtkData::VtkData(const Components& points, const Cells cells)
  : n_points(points.size())
  , n_cells(points.size() / forms[std::size_t(cells)].n_points)
  , kind(cells)
{
  geometry = reals("points", 3, flat(points));
  std::vector<std::int32_t> of_cells_points(n_points);
  std::iota(of_cells_points.begin(), of_cells_points.end(), 0);
  std::vector<std::int32_t> ends(n_cells);
  for (std::size_t k = 0; k < n_cells; ++k)
    ends[k] = std::int32_t((k + 1) * forms[std::size_t(kind)].n_points);
  connectivity = array("connectivity", "Int32", 1, of_cells_points.data(), 4 * of_cells_points.size()) +
                 array("offsets", "Int32", 1, ends.data(), 4 * ends.size());
  if (kind == Cells::hexahedra)
    {
      constexpr std::uint8_t hexahedron = 12; // VTK_HEXAHEDRON
      const std::vector<std::uint8_t> types(n_cells, hexahedron);
      connectivity += array("types", "UInt8", 1, types.data(), types.size());
    }
}

void VtkData::scalar(const std::string& name, const std::vector<double>& values)
{
  of_cells += reals(name, 1, {values.begin(), values.end()});
}

void VtkData::count(const std::string& name, const std::vector<std::uint32_t>& values)
{
  of_cells += array(name, "UInt32", 1, values.data(), 4 * values.size());
}

void VtkData::vector(const std::string& name, const Components& values) { of_cells += reals(name, 3, flat(values)); }

void VtkData::vector_of_points(const std::string& name, const Components& values)
{
  of_points += reals(name, 3, flat(values));
}

void VtkData::tensor(const std::string& name, const std::vector<std::array<double, 6>>& values)
{
  std::vector<float> full;
  for (const auto& [xx, xy, xz, yy, yz, zz] : values)
    for (const double component : {xx, xy, xz, xy, yy, yz, xz, yz, zz})
      full.push_back(float(component));
  of_cells += reals(name, 9, full);
}

void VtkData::of_all(const std::string& name, const double value)
{
  of_whole += fmt::format(R"(<DataArray type="Float64" Name="{}" NumberOfTuples="1" format="ascii">{:.17g}</DataArray>)"
                          "\n",
                          name, value);
}

std::string VtkData::ending() const { return kind == Cells::hexahedra ? "vtu" : "vtp"; }

void VtkData::write(const std::filesystem::path& file) const
{
  const auto n_of = [&](const Cells one) { return kind == one ? n_cells : 0; };
  const bool is_grid = kind == Cells::hexahedra;
  const char* const type = is_grid ? "UnstructuredGrid" : "PolyData";
  const std::string number =
    is_grid ? fmt::format("NumberOfCells=\"{}\"", n_cells)
            : fmt::format("NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\"",
                          n_of(Cells::points), n_of(Cells::lines), n_of(Cells::squares));
  const char* const element = forms[std::size_t(kind)].element;
  // Data of cells that are single points are written as data of points, so that glyphs find them.
  const bool are_points = kind == Cells::points;
  write_whole_file(
    file, fmt::format("<?xml version=\"1.0\"?>\n"
                      "<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
                      "<{}>\n<FieldData>\n{}</FieldData>\n<Piece NumberOfPoints=\"{}\" {}>\n"
                      "<Points>\n{}</Points>\n<{}>\n{}</{}>\n<PointData>\n{}</PointData>\n"
                      "<CellData>\n{}</CellData>\n</Piece>\n</{}>\n<AppendedData encoding=\"raw\">_",
                      type, type, of_whole, n_points, number, geometry, element, connectivity, element,
                      are_points ? of_cells : of_points, are_points ? "" : of_cells, type) +
            appended + "</AppendedData>\n</VTKFile>\n");
}

std::string VtkData::array(const std::string& name, const std::string_view type, const std::size_t n_components,
                           const void* const data, const std::size_t n_bytes)
{
  std::string element =
    fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                "\n",
                type, name, n_components, appended.size());
  const std::uint64_t size = n_bytes;
  appended.append(reinterpret_cast<const char*>(&size), sizeof(size));
  if (n_bytes > 0)
    appended.append(static_cast<const char*>(data), n_bytes);
  return element;
}

std::string VtkData::reals(const std::string& name, const std::size_t n_components, const std::vector<float>& values)
{
  return array(name, "Float32", n_components, values.data(), sizeof(float) * values.size());
}

void make_vtk_folder(const std::filesystem::path& folder)
{
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> earlier;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".vtp" || entry.path().extension() == ".vtu")
      earlier.push_back(entry.path());
  for (const std::filesystem::path& file : earlier)
    std::filesystem::remove(file);
}

void write_vtk_series(const std::vector<VtkTime>& times, const std::filesystem::path& file)
{
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const auto& [time, of_time] : times)
    fmt::format_to(std::back_inserter(text), "<DataSet timestep=\"{:.17g}\" file=\"{}\"/>\n", time, of_time);
  write_whole_file(file, text + "</Collection>\n</VTKFile>\n");
}

void write_paraview_script(const std::string& name, const std::string& show, const std::filesystem::path& folder)
{
  write_whole_file(folder / (name + "_paraview.py"),
                   fmt::format(R"(# Shows {0} in ParaView: File, Load State, or paraview --script=THIS_FILE.
import os

from paraview.simple import *

folder = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()
view = GetActiveViewOrCreate("RenderView")
{1}scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()  # axial strain in per cent; steps of own loading
scene.GoToLast()
ResetCamera(view)
Render(view)
)",
                               name, show));
}
} // namespace feldspar
