#include "results/folder/field_output.h"

#include "base/hdf5_archive.h"
#include "base/whole_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

namespace feldspar
{
namespace
{
std::string shape(const std::size_t n, const unsigned int n_components)
{
  return n_components > 1 ? fmt::format("{} {}", n, n_components) : std::to_string(n);
}

/// An array of the HDF5 file as XDMF points to it.
std::string data_item(const std::string& path, const std::string& its_shape, const bool is_real)
{
  return fmt::format(R"(<DataItem Dimensions="{}" {} Format="HDF">{}</DataItem>)", its_shape,
                     is_real ? R"(NumberType="Float" Precision="8")" : R"(NumberType="UInt" Precision="4")", path);
}

/// The first `n` rows of one that lies flat, [n_stored * n_components]: of slabs in two dimensions the XDMF library takes
/// other values.
std::string first_rows(const std::string& path, const std::size_t n, const std::size_t n_stored,
                       const unsigned int n_components, const bool is_real)
{
  return fmt::format(R"(<DataItem ItemType="HyperSlab" Dimensions="{}" Type="HyperSlab">)"
                     R"(<DataItem Dimensions="3 1" NumberType="Int" Format="XML">0 1 {}</DataItem>{}</DataItem>)",
                     shape(n, n_components), n * n_components,
                     data_item(path, shape(n_stored * n_components, 1), is_real));
}

/// Points with their attributes at one time.
class PointGrid
{
public:
  PointGrid(const double time, const std::size_t n, const std::string& positions)
    : text(fmt::format("<Grid GridType=\"Uniform\"><Time Value=\"{0}\"/>\n"
                       "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{1}\" NodesPerElement=\"1\"/>\n"
                       "<Geometry GeometryType=\"XYZ\">{2}</Geometry>\n",
                       time, n, positions))
  {
  }

  void attribute(const std::string& name, const bool is_vector, const std::string& data)
  {
    fmt::format_to(std::back_inserter(text),
                   "<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", name,
                   is_vector ? "Vector" : "Scalar", data);
  }

  /// Symmetric: xx, xy, xz, yy, yz, zz.
  void tensor(const std::string& name, const std::string& data)
  {
    fmt::format_to(std::back_inserter(text),
                   "<Attribute Name=\"{}\" AttributeType=\"Tensor6\" Center=\"Node\">{}</Attribute>\n", name, data);
  }

  std::string finish() const { return text + "</Grid>\n"; }

private:
  std::string text;
};

std::string time_series(const std::string& name, const std::string& grids)
{
  return fmt::format("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
                     "<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n{}</Grid>\n"
                     "</Domain></Xdmf>\n",
                     name, grids);
}

/// One point after the other, three coordinates each.
std::vector<double> interleaved(const std::array<std::vector<double>, 3>& components)
{
  const std::size_t n = components[0].size();
  std::vector<double> values(3 * n, 0.0);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < components[c].size(); ++i)
      values[3 * i + c] = components[c][i];
  return values;
}
} // namespace

void write_fields(const std::string& name, const TestKind& kind, const std::vector<Crack>& all_cracks,
                  const TestAppearance& appearance, const std::filesystem::path& folder)
{
  if (appearance.snapshots.empty())
    return;
  const std::size_t n_grains = appearance.grains_at_end.size();
  const std::size_t n_cracks = all_cracks.size();
  const std::string file = name + ".h5";
  const double sign = kind.sign;
  const auto has_stress = [=](const Snapshot& snapshot) { return snapshot.stress[0].size() == n_grains; };

  write_hdf5(folder / file, [&](Hdf5Writer& root) {
    std::vector<double> radius;
    for (const auto& grain : appearance.grains_at_end)
      radius.push_back(grain.radius);
    root.array("radius_m", radius);
    const std::vector<double> start = interleaved(appearance.snapshots.front().position);
    for (std::size_t k = 0; k < appearance.snapshots.size(); ++k)
      {
        const Snapshot& snapshot = appearance.snapshots[k];
        auto group = root.subgroup(fmt::format("snapshot_{}", k));
        std::vector<double> position = interleaved(snapshot.position);
        std::vector<double> displacement(position.size());
        std::transform(position.begin(), position.end(), start.begin(), displacement.begin(), std::minus<>());
        std::vector<std::uint32_t> fragment = snapshot.fragment;
        std::vector<std::uint32_t> n_broken = snapshot.n_broken_segments;
        group.array("position_m", position, 3);
        group.array("displacement_m", displacement, 3);
        if (has_stress(snapshot))
          {
            std::vector<double> stress(6 * n_grains);
            for (std::size_t c = 0; c < 6; ++c)
              for (std::size_t i = 0; i < n_grains; ++i)
                stress[6 * i + c] = snapshot.stress[c][i];
            group.array("stress_Pa", stress, 6);
          }
        group.array("fragment", fragment);
        group.array("n_broken_segments", n_broken);
      }

    auto cracks = root.subgroup("cracks");
    std::vector<double> centroid, normal, size, energy;
    std::vector<std::uint32_t> is_shear, step;
    for (const auto& crack : all_cracks)
      {
        centroid.insert(centroid.end(), crack.centroid.begin(), crack.centroid.end());
        normal.insert(normal.end(), crack.normal.begin(), crack.normal.end());
        size.push_back(crack.size);
        energy.push_back(crack.released_energy);
        is_shear.push_back(crack.kind == CrackKind::shear);
        step.push_back(std::uint32_t(crack.step));
      }
    cracks.array("centroid_m", centroid);
    cracks.array("normal", normal);
    cracks.array("size_m", size);
    cracks.array("released_energy_J", energy);
    cracks.array("is_shear", is_shear);
    cracks.array("step", step);
  });

  std::string grain_grids, crack_grids;
  for (std::size_t k = 0; k < appearance.snapshots.size(); ++k)
    {
      const Snapshot& snapshot = appearance.snapshots[k];
      const double time = 100.0 * sign * snapshot.axial_strain + 0.0;
      const auto of_grains = [&](const std::string& array, const unsigned int n_components, const bool is_real) {
        return data_item(fmt::format("{}:/snapshot_{}/{}", file, k, array), shape(n_grains, n_components), is_real);
      };
      PointGrid grains(time, n_grains, of_grains("position_m", 3, true));
      grains.attribute("radius", false, data_item(file + ":/radius_m", shape(n_grains, 1), true));
      grains.attribute("displacement", true, of_grains("displacement_m", 3, true));
      if (has_stress(snapshot))
        grains.tensor("stress", of_grains("stress_Pa", 6, true));
      grains.attribute("fragment", false, of_grains("fragment", 1, false));
      grains.attribute("broken elements", false, of_grains("n_broken_segments", 1, false));
      grain_grids += grains.finish();

      const auto until =
        std::upper_bound(all_cracks.begin(), all_cracks.end(), snapshot.step,
                         [](const std::uint64_t step, const Crack& crack) { return step < crack.step; });
      const auto n = std::size_t(until - all_cracks.begin());
      if (n == 0)
        continue; // an empty grid is none to ParaView
      const auto of_cracks = [&](const std::string& array, const unsigned int n_components, const bool is_real) {
        return first_rows(fmt::format("{}:/cracks/{}", file, array), n, n_cracks, n_components, is_real);
      };
      PointGrid cracks(time, n, of_cracks("centroid_m", 3, true));
      cracks.attribute("normal", true, of_cracks("normal", 3, true));
      cracks.attribute("size", false, of_cracks("size_m", 1, true));
      cracks.attribute("released energy", false, of_cracks("released_energy_J", 1, true));
      cracks.attribute("is shear", false, of_cracks("is_shear", 1, false));
      cracks.attribute("step", false, of_cracks("step", 1, false));
      crack_grids += cracks.finish();
    }
  write_whole_file(folder / (name + "_grains.xdmf"), time_series("grains", grain_grids));
  if (!crack_grids.empty())
    write_whole_file(folder / (name + "_cracks.xdmf"), time_series("cracks", crack_grids));
}
} // namespace feldspar
