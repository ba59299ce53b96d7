#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Minerals of a rock: what a thin section tells, and how their joints differ; docs/theory.md §3.4.
namespace feldspar
{
/// Properties of a joint over those that the section of its law gives.
struct JointRatios
{
  double stiffness = 1.0;        ///< of k_n and k_s
  double tensile_strength = 1.0; ///< of each bond as it was drawn
  double cohesion = 1.0;         ///< of each bond as it was drawn
  double friction = 1.0;         ///< of the coefficient of broken segments

  bool operator==(const JointRatios&) const = default;
};

struct Mineral
{
  std::string name;
  std::optional<double> share;   ///< of the grains' volume; none: the map gives it
  double size = 0.0;             ///< diameter of the circle or ball of the mean volume of its mineral grains [m]
  double aspect_ratio = 1.0;     ///< length of its mineral grains over their width
  std::optional<double> angle;   ///< of the length, from the first axis towards that of the tests; none: any [rad]
  std::uint32_t colour = 0;      ///< in pictures: 0xRRGGBB
  std::optional<double> density; ///< of the rock if it were of this mineral alone; none: that of the specimen [kg/m³]
  JointRatios within;            ///< of joints inside its mineral grains

  bool operator==(const Mineral&) const = default;
};

/// The joints between mineral grains of two kinds, or of one. What is not given follows from the minerals.
struct MineralBoundary
{
  std::string one, two; ///< names of the minerals
  std::optional<double> stiffness, tensile_strength, cohesion, friction;
};

/// Colours of a picture, or minerals at points.
struct MineralMap
{
  std::size_t width = 0;                     ///< of the picture [pixels]
  std::vector<std::uint32_t> colour;         ///< 0xRRGGBB, row by row from above; none of points
  std::vector<std::array<double, 3>> place;  ///< of points [m]
  std::vector<std::string> mineral_of_point; ///< by its name
};

/// The form of mineral grains, and how they meet.
enum class MineralGrainForm
{
  breakable,         ///< joints of the law inside and between
  smooth_boundaries, ///< smooth joints between: the grain-based model (Potyondy 2010)
  rigid              ///< clumps: joints between them only
};

struct MineralParameters
{
  std::string table;                    ///< CSV of the minerals; empty: the rock has none
  std::string boundaries_file;          ///< CSV of the boundaries; empty: all follow from the minerals
  std::string map_file;                 ///< PNG or CSV; empty: Voronoi cells by share and size
  std::optional<double> pixel_size;     ///< [m]
  unsigned int n_slices = 1;            ///< of the depth, one below the other in the picture
  std::optional<double> slice_distance; ///< none: the size of a pixel [m]
  MineralGrainForm form = MineralGrainForm::breakable;
  double boundary_strength = 1.0; ///< factor on both strengths of the bonds of all boundaries
  std::vector<Mineral> minerals;  ///< of the table
  std::vector<MineralBoundary> boundaries;
  std::shared_ptr<const MineralMap> map; ///< none: Voronoi cells

  /// The form of the mineral grains; breakable where there are no minerals.
  MineralGrainForm form_of_rock() const { return minerals.empty() ? MineralGrainForm::breakable : form; }
  bool has_picture() const { return map && !map->colour.empty(); }
};

/// The most minerals of a rock.
inline constexpr std::size_t most_minerals = 250;

/// The ratios of a joint between mineral grains: those given, else the stiffness of both in series and the lower of each other
/// ratio; strengths times the factor of all boundaries.
JointRatios boundary_ratios(const MineralParameters& wanted, std::size_t one, std::size_t two);
} // namespace feldspar
