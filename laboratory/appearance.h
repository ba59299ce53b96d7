#pragma once

#include "laboratory/record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The looks of a test, for pictures; no figure is read off them later.
namespace feldspar
{
/// The fields at one time that a test on finite elements left for ParaView (fem/output.h). No nodes: there are none.
struct SampleFields
{
  unsigned int dimension = 0;                              ///< of the mesh
  std::size_t n_rows = 0;                                  ///< of the curve when they were written
  std::vector<std::array<double, 3>> nodes;                ///< at rest [m]; those of each cell are its own
  std::vector<std::array<double, 3>> displacement;         ///< of each node [m]
  std::vector<std::vector<std::uint32_t>> cells;           ///< their nodes: around, or in space as VTK has them
  std::map<std::string, std::vector<double>> of_each_cell; ///< by its name, with its unit

  bool has(const std::string& field) const { return of_each_cell.contains(field); }
  /// A cylinder by half of its section: x is r, y is z.
  bool is_axisymmetric() const { return has("stress_rr_Pa"); }
};

/// A grain as the pictures need it.
struct GrainPicture
{
  std::array<double, 3> start;    ///< when the loading began [m]
  std::array<double, 3> position; ///< at the end [m]
  double radius;                  ///< [m]
  std::uint32_t fragment;         ///< number of the fragment it belongs to, largest first
  std::uint32_t group = 0;        ///< number of the mineral grain or clump it is a part of, from 1; 0: of none
  double mean_stress = 0.0;       ///< in the snapshot of the highest load, tension positive [Pa]; 0 of all: not known
  std::uint32_t mineral = 0;      ///< number of its mineral, from 1; 0: of a rock without minerals
};

/// The grains at one row of the curve.
struct Snapshot
{
  std::uint64_t step = 0;
  double axial_strain = 0.0;
  double axial_stress = 0.0;                   ///< [Pa]
  std::array<std::vector<double>, 3> position; ///< of each grain [m]; the last is empty in the plane
  /// xx, xy, xz, yy, yz, zz of each grain, tension positive [Pa]; it scatters from grain to grain by its own
  /// size. Empty where it is not known, as xz, yz and zz in the plane.
  std::array<std::vector<double>, 6> stress;
  /// The same components of the strain of each mineral since the start (docs/theory.md §3.4). Empty where it is not known.
  std::array<std::vector<double>, 6> mineral_strain;
  std::vector<std::uint32_t> fragment;          ///< of each grain, as in GrainPicture
  std::vector<std::uint32_t> n_broken_segments; ///< of each grain's joints since the start
};

/// The representative volume at a point of a sample, as it was when the test ended.
struct PointRve
{
  std::string which; ///< most damaged, median, intact
  unsigned int cell; ///< as in the fields, from 0
  unsigned int point;
  std::array<double, 3> position{}; ///< as the nodes of the mesh are given; in r-z r, θ and z [m]
  std::uint64_t n_segments;
  std::vector<GrainPicture> grains; ///< along the axes of the sample [m]
  std::vector<Crack> cracks;        ///< where they are at rest

  std::string place() const { return std::to_string(cell) + ":" + std::to_string(point); }
};

/// A hole, slot or closed flaw that was in the rock before the test.
struct FlawPicture
{
  std::string name;                           ///< of its kind
  bool open;                                  ///< grains were taken out
  std::vector<std::array<double, 3>> outline; ///< a line, of a hole closed [m]
};

/// The grains of a specimen, or the fields of a sample of finite elements and the grains of a few points.
struct TestAppearance
{
  std::vector<GrainPicture> grains_at_end;
  std::vector<FlawPicture> flaws;
  std::vector<Snapshot> snapshots;         ///< a few, evenly over the curve; the first is the start
  SampleFields fields;                     ///< read back from the folder; never written by who writes a result folder
  std::vector<SampleFields> fields_before; ///< of earlier times, of a small sample
  std::vector<PointRve> rves;              ///< representative volumes of a few points
};

/// Fragments of the grains; none without grains.
inline std::optional<Fragments> fragments_of(const std::vector<GrainPicture>& grains, const int dimension)
{
  std::map<std::uint32_t, std::pair<std::uint64_t, double>> fragments; // grains, and volume
  double all = 0.0;
  for (const auto& grain : grains)
    {
      auto& [n_grains, size] = fragments[grain.fragment];
      ++n_grains;
      const double volume = std::pow(grain.radius, dimension);
      size += volume;
      all += volume;
    }
  if (fragments.empty())
    return std::nullopt;
  const auto n = std::ranges::count_if(fragments, [](const auto& f) { return f.second.first > 1; });
  return Fragments{std::uint64_t(n), fragments.begin()->second.second / all};
}
} // namespace feldspar
