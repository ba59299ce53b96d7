#include "results/folder/sample_field_output.h"

#include "results/folder/vtk_data.h"
#include "results/sample_fields.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>

namespace feldspar
{
namespace
{
/// Row of VtkData::tensor() for two axes.
constexpr std::array<std::array<std::size_t, 3>, 3> place_of_axes{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};

/// stress_xy_Pa: a component of stress_Pa.
struct Component
{
  std::string tensor;
  std::size_t place;
};

/// Component that a field is; none if it is no component of a tensor in the axes of the mesh.
std::optional<Component> component(const std::string& field, const bool is_axisymmetric)
{
  if (is_axisymmetric && field.starts_with("crack_orientation"))
    return std::nullopt;                                    // in the axes of the material
  const std::string axes = is_axisymmetric ? "rzt" : "xyz"; // along x, y and z of the mesh
  for (std::size_t at = field.find('_'); at != std::string::npos; at = field.find('_', at + 1))
    {
      const bool has_two = at + 2 < field.size() && (at + 3 == field.size() || field[at + 3] == '_');
      if (!has_two)
        continue;
      const std::size_t first = axes.find(field[at + 1]), second = axes.find(field[at + 2]);
      if (first != std::string::npos && second != std::string::npos)
        return Component{field.substr(0, at) + field.substr(at + 3), place_of_axes[first][second]};
    }
  return std::nullopt;
}

VtkData state(const SampleFields& fields)
{
  VtkData::Components places, displacement;
  for (const auto& cell : fields.cells)
    for (const std::uint32_t node : cell)
      {
        displacement.push_back(fields.displacement[node]);
        places.push_back(fields.nodes[node]);
      }
  VtkData data(places, fields.dimension == 2 ? VtkData::Cells::squares : VtkData::Cells::hexahedra);
  data.vector_of_points("displacement_m", displacement);
  std::map<std::string, std::vector<std::array<double, 6>>> tensors;
  for (const auto& [name, values] : fields.of_each_cell)
    if (const auto part = component(name, fields.is_axisymmetric()))
      {
        auto& tensor = tensors[part->tensor];
        tensor.resize(values.size(), {});
        for (std::size_t k = 0; k < values.size(); ++k)
          tensor[k][part->place] = values[k];
      }
    else if (name == "cell")
      data.count(name, {values.begin(), values.end()});
    else
      data.scalar(name, values);
  for (const auto& [name, values] : tensors)
    data.tensor(name, values);
  return data;
}

/// The mesh where it has moved to, by what is broken.
std::string sample_in_paraview(const std::string& name, const bool has_grains)
{
  return fmt::format(R"(sample = PVDReader(FileName=os.path.join(folder, "{}.pvd"))
moved = WarpByVector(Input=sample)
moved.Vectors = ["POINTS", "displacement_m"]
moved.ScaleFactor = 20.0
of_sample = Show(moved, view)
ColorBy(of_sample, ("CELLS", "{}"))
)",
                     name, has_grains ? "broken_segments_share" : "stress_Pa");
}
} // namespace

void write_sample_fields(const std::string& name, const TestKind& kind, const std::vector<CurveSample>& curve,
                         const std::filesystem::path& folder)
{
  make_vtk_folder(folder / name);
  std::vector<VtkTime> series;
  bool has_grains = false;
  for_each_time(folder, name, [&](const SampleFields& fields) {
    if (fields.n_rows == 0 || fields.n_rows > curve.size())
      return; // of an older curve
    const CurveSample& row = curve[fields.n_rows - 1];
    const double percent = 100.0 * kind.strain(row) + 0.0; // no -0
    VtkData data = state(fields);
    has_grains = fields.has("broken_segments_share");
    data.of_all("axial_strain_percent", percent);
    data.of_all("axial_stress_Pa", row.axial_stress);
    series.push_back({kind.follows_stages ? double(fields.n_rows) : percent,
                      fmt::format("{}/state_{:03}.{}", name, series.size(), data.ending())});
    data.write(folder / series.back().file);
  });
  write_vtk_series(series, folder / (name + ".pvd"));
  write_paraview_script(name, sample_in_paraview(name, has_grains), folder);
}
} // namespace feldspar
