#include "results/folder/field_output.h"

#include "base/mapped.h"
#include "results/folder/table_columns.h"
#include "results/folder/vtk_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace feldspar
{
namespace
{
using Points = VtkData::Components;

/// The components of each grain; 0 where there are none.
template <std::size_t n>
std::vector<std::array<double, n>> by_grain(const std::array<std::vector<double>, n>& components)
{
  std::vector<std::array<double, n>> of_grains(components[0].size(), std::array<double, n>{});
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t i = 0; i < components[c].size(); ++i)
      of_grains[i][c] = components[c][i];
  return of_grains;
}

/// A number of each grain, from 1; 0 of grains without. Nothing where all are without.
void add_numbers(VtkData& data, const std::string& name, const std::vector<GrainPicture>& grains,
                 std::uint32_t GrainPicture::*const number)
{
  const auto numbers = mapped<std::uint32_t>(grains, number);
  if (std::ranges::any_of(numbers, [](const std::uint32_t one) { return one != 0; }))
    data.count(name, numbers);
}

VtkData grains_at(const Snapshot& snapshot, const Points& start, const std::vector<GrainPicture>& grains,
                  const std::string& group)
{
  const Points now = by_grain(snapshot.position);
  Points displacement = now;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      displacement[i][c] -= start[i][c];
  VtkData data(now, VtkData::Cells::points);
  data.scalar("radius_m", mapped<double>(grains, &GrainPicture::radius));
  data.vector("displacement_m", displacement);
  if (snapshot.stress[0].size() == now.size())
    data.tensor("stress_Pa", by_grain(snapshot.stress));
  data.count("fragment", snapshot.fragment);
  data.count("n_broken_segments", snapshot.n_broken_segments);
  add_numbers(data, group, grains, &GrainPicture::group);
  add_numbers(data, "mineral", grains, &GrainPicture::mineral);
  return data;
}

/// A direction square to a unit vector, the same for the same vector.
std::array<double, 3> across(const std::array<double, 3>& normal)
{
  const auto [x, y, z] = normal;
  const std::array<double, 3> result = std::abs(z) < 0.9 ? std::array{-y, x, 0.0} : std::array{0.0, -z, y};
  const double length = std::hypot(result[0], result[1], result[2]);
  return {result[0] / length, result[1] / length, result[2] / length};
}

/// The corners of the face that broke: the ends of its line in the plane, of a square of its area in space.
void add_face(Points& corners, const Crack& crack, const bool in_space)
{
  const auto& n = crack.normal;
  const std::array<double, 3> u = in_space ? across(n) : std::array{-n[1], n[0], 0.0};
  const std::array<double, 3> v{n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
  const auto corner = [&](const double along_u, const double along_v) {
    std::array<double, 3> point = crack.centroid;
    for (std::size_t c = 0; c < 3; ++c)
      point[c] += 0.5 * crack.size * (along_u * u[c] + along_v * v[c]);
    corners.push_back(point);
  };
  if (!in_space)
    for (const double side : {-1.0, 1.0})
      corner(side, 0.0);
  else
    for (const auto& [along_u, along_v] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
      corner(along_u, along_v);
}

/// The cracks or events up to a snapshot.
template <typename Row>
std::span<const Row> until(const Snapshot& snapshot, const std::vector<Row>& all)
{
  return {all.begin(), std::ranges::upper_bound(all, snapshot.step, {}, &Row::step)};
}

VtkData cracks_until(const Snapshot& snapshot, const std::vector<Crack>& all, const bool in_space)
{
  const auto cracks = until(snapshot, all);
  Points corners;
  for (const Crack& crack : cracks)
    add_face(corners, crack, in_space);
  VtkData data(corners, in_space ? VtkData::Cells::squares : VtkData::Cells::lines);
  data.count("is_shear",
             mapped<std::uint32_t>(cracks, [](const Crack& crack) { return crack.kind == CrackKind::shear; }));
  data.scalar("released_energy_J", mapped<double>(cracks, &Crack::released_energy));
  data.vector("normal", mapped<std::array<double, 3>>(cracks, &Crack::normal));
  data.scalar("size_m", mapped<double>(cracks, &Crack::size));
  data.count("step", mapped<std::uint32_t>(cracks, &Crack::step));
  return data;
}

VtkData events_until(const Snapshot& snapshot, const std::vector<EmissionEvent>& all, const TestKind& kind,
                     const int dimension)
{
  const auto events = until(snapshot, all);
  const auto rows =
    mapped<EmissionRow>(events, [&](const EmissionEvent& event) { return emission_row(event, dimension); });
  VtkData data(mapped<std::array<double, 3>>(events, &EmissionEvent::centroid), VtkData::Cells::points);
  for (const Column<EmissionRow>& column : emission_columns)
    {
      const auto values = mapped<double>(rows, [&](const EmissionRow& row) {
        return column.get(row) * (column.is(positive_in_test) ? kind.sign : 1.0);
      });
      if (column.most > 0.0)
        data.count(std::string(column.name), {values.begin(), values.end()});
      else
        data.scalar(std::string(column.name), values);
    }
  data.tensor("moment_tensor_Nm", mapped<std::array<double, 6>>(events, &EmissionEvent::moment));
  return data;
}

/// Grains as spheres of their size, cracks on them, events as spheres of the size of a circular crack of the same moment.
std::string shown_in_paraview(const std::string& name, const bool has_cracks, const bool has_events)
{
  std::string text = fmt::format(R"(grains = PVDReader(FileName=os.path.join(folder, "{0}_grains.pvd"))
spheres = Glyph(Input=grains, GlyphType="Sphere")
spheres.ScaleArray = ["POINTS", "radius_m"]
spheres.ScaleFactor = 2.0  # a sphere of ParaView's is one across
spheres.GlyphMode = "All Points"
of_spheres = Show(spheres, view)
ColorBy(of_spheres, ("POINTS", "fragment"))
)",
                                 name);
  if (has_cracks)
    text += fmt::format(R"(cracks = PVDReader(FileName=os.path.join(folder, "{}_cracks.pvd"))
of_cracks = Show(cracks, view)
ColorBy(of_cracks, ("CELLS", "is_shear"))
of_cracks.LineWidth = 3.0
)",
                        name);
  if (has_events)
    text += fmt::format(R"py(emission = PVDReader(FileName=os.path.join(folder, "{}_emission.pvd"))
roots = Calculator(Input=emission, Function="moment_Nm^(1/3)", ResultArrayName="root")
events = Glyph(Input=roots, GlyphType="Sphere")
events.ScaleArray = ["POINTS", "root"]
events.ScaleFactor = 7.05e-3  # diameter of a crack that lowers the stress by 10 MPa, M = 16/7 10 MPa r^3
events.GlyphMode = "All Points"
of_events = Show(events, view)
ColorBy(of_events, ("POINTS", "isotropic_share"))
)py",
                        name);
  return text;
}
} // namespace

void write_fields(const std::string& name, const TestKind& kind, const std::vector<Crack>& cracks,
                  const std::vector<EmissionEvent>& events, const TestAppearance& appearance,
                  const std::filesystem::path& folder, const std::string& group)
{
  if (appearance.snapshots.empty())
    return;
  const bool in_space = !appearance.snapshots.front().position[2].empty();
  const Points start = by_grain(appearance.snapshots.front().position);
  make_vtk_folder(folder / name);
  std::vector<VtkTime> of_grains;
  std::vector<VtkTime> of_cracks;
  std::vector<VtkTime> of_events;
  for (std::size_t k = 0; k < appearance.snapshots.size(); ++k)
    {
      const Snapshot& snapshot = appearance.snapshots[k];
      const double percent = 100.0 * kind.sign * snapshot.axial_strain + 0.0; // no -0
      // Time goes forwards, which the strain of a loading table need not.
      const double time = kind.follows_stages ? double(snapshot.step) : percent;
      const auto keep = [&](VtkData data, const char* const what, std::vector<VtkTime>& series) {
        data.of_all("axial_strain_percent", percent);
        data.of_all("axial_stress_Pa", snapshot.axial_stress);
        series.push_back({time, fmt::format("{}/{}_{:03}.vtp", name, what, k)});
        data.write(folder / series.back().file);
      };
      keep(grains_at(snapshot, start, appearance.grains_at_end, group), "grains", of_grains);
      if (!cracks.empty())
        keep(cracks_until(snapshot, cracks, in_space), "cracks", of_cracks);
      if (!events.empty())
        keep(events_until(snapshot, events, kind, in_space ? 3 : 2), "emission", of_events);
    }
  write_vtk_series(of_grains, folder / (name + "_grains.pvd"));
  if (!of_cracks.empty())
    write_vtk_series(of_cracks, folder / (name + "_cracks.pvd"));
  if (!of_events.empty())
    write_vtk_series(of_events, folder / (name + "_emission.pvd"));
  write_paraview_script(name, shown_in_paraview(name, !of_cracks.empty(), !of_events.empty()), folder);
}
} // namespace feldspar
