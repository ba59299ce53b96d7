#pragma once

#include "base/vector.h"
#include "dem/laws/parameters.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Shapes of what is in a rock, as the input describes them; docs/theory.md §3.1. A point of the plane has two
/// coordinates, along the first axis and along that of the tests. In space what is given by such points runs through the
/// whole depth, as a borehole or a saw cut does.
namespace feldspar
{
/// An ellipse; a disc where both semi-axes are one.
struct EllipseHole
{
  static constexpr std::string_view name = "hole";
  Vector<2> centre;    ///< [m]
  Vector<2> semi_axes; ///< [m]
  double angle = 0.0;  ///< of the first, from the first axis towards that of the tests [rad]
};

struct PolygonHole
{
  static constexpr std::string_view name = "hole";
  std::vector<Vector<2>> corners; ///< three at least [m]
};

/// Hole in space only.
struct SphereHole
{
  static constexpr std::string_view name = "sphere";
  Vector<3> centre; ///< [m]
  double radius;    ///< [m]
};

/// A saw cut; of no width, it takes out no grain, only the faces across its line.
struct Slot
{
  static constexpr std::string_view name = "slot";
  Vector<2> from, to; ///< [m]
  double width;       ///< [m]
};

/// The properties of the smooth joints of one flaw. A flaw without a strength of its own is not bonded.
struct SmoothSides
{
  std::optional<double> normal_stiffness; ///< [Pa/m]
  std::optional<double> shear_stiffness;  ///< [Pa/m]
  std::optional<double> friction;
  std::optional<double> dilation_angle;   ///< [rad]
  std::optional<double> tensile_strength; ///< [Pa]
  std::optional<double> cohesion;         ///< [Pa]
  std::optional<double> friction_angle;   ///< of the bond; none: that of the friction [rad]

  bool are_bonded() const { return tensile_strength.value_or(0.0) > 0.0 || cohesion.value_or(0.0) > 0.0; }
  /// The rest as of all smooth joints.
  SmoothJointParameters among(const SmoothJointParameters& all) const;
};

/// A crack without width whose sides are in contact: the joints across it are unbonded, or smooth.
struct ClosedFlaw
{
  static constexpr std::string_view name = "closed flaw";
  std::vector<Vector<2>> points; ///< of a line, two at least [m]
  std::optional<SmoothSides> smooth = std::nullopt;
  /// Layer of the joint map that it is a trace of; the parts of such a flaw outside of the body are left out.
  std::optional<std::string> map_layer = std::nullopt;
};

/// The same as a disc; in space only.
struct DiscFlaw
{
  static constexpr std::string_view name = "disc flaw";
  Vector<3> centre; ///< [m]
  double radius;    ///< [m]
  Vector<3> normal; ///< unit
  std::optional<SmoothSides> smooth = std::nullopt;
};

/// Parallel lines through the whole specimen, each of which is a closed flaw over a share of its length.
struct JointSet
{
  static constexpr std::string_view name = "joint set";
  double angle;              ///< of the lines, from the first axis towards that of the tests [rad]
  double spacing;            ///< across them [m]
  double persistence = 1.0;  ///< share of a line that is flaw, (0, 1]
  double trace_length = 0.0; ///< of each flaw, where persistence < 1 [m]
  std::uint64_t seed = 1;    ///< of where the lines and their flaws begin
  std::optional<SmoothSides> smooth = std::nullopt;
};

/// Disc flaws with random centres in the box of the specimen, whose normals scatter about a mean as Fisher's distribution
/// says; in space only.
struct DiscSet
{
  static constexpr std::string_view name = "disc set";
  Vector<3> normal;     ///< mean, unit
  double concentration; ///< κ: the larger, the less normals scatter
  double radius;        ///< of each disc [m]
  std::uint64_t n;      ///< number of discs
  std::uint64_t seed = 1;
  std::optional<SmoothSides> smooth = std::nullopt;
};

using Shape = std::variant<EllipseHole, PolygonHole, SphereHole, Slot, ClosedFlaw, DiscFlaw, JointSet, DiscSet>;

/// The place of a joint map in the specimen, and what its layers are.
struct MapParameters
{
  Vector<2> origin = Vector<2>::Zero(); ///< point of the map that lies at the lower left corner of the specimen [m]
  double angle = 0.0;                   ///< by which the map is turned about this point [rad]
  double scale = 1.0;                   ///< length in the specimen over that in the map
  std::map<std::string, SmoothSides> smooth_layers; ///< whose traces are smooth; names in small letters
  std::string text;                                 ///< of the layers, as it was written; empty: none
};

/// All that is put into a specimen, in this order.
struct FlawParameters
{
  std::vector<Shape> shapes;
  std::vector<Shape> traces; ///< of a file, in its coordinates, after the others
  MapParameters map;         ///< of the traces
  std::string text;          ///< of the shapes, as it was written; empty: none
  std::string traces_file;   ///< empty: none
  std::string left_out;      ///< a sentence on entities of the file that are not visible and not read; empty: none

  std::vector<Shape> all() const
  {
    std::vector<Shape> both = shapes;
    const auto placed = placed_traces();
    both.insert(both.end(), placed.begin(), placed.end());
    return both;
  }

  /// The traces as the map says, in coordinates of the specimen.
  std::vector<Shape> placed_traces() const;
};

std::string_view name(const Shape& shape);

/// Returns whether the flaw is open: grains are taken out.
bool is_open(const Shape& shape);

/// The smooth sides of a flaw whose sides slide on a plane; else null.
const SmoothSides* smooth_sides(const Shape& shape);

/// The points of the line or, closed, of the outline, for what lies in the plane of the picture; of a sphere its equator
/// there; of a joint set none.
std::vector<Vector<2>> outline(const Shape& shape);

/// The flaws of a set in a box of this width and height [m].
std::vector<ClosedFlaw> traces(const JointSet& set, const Vector<2>& size);

/// The flaws of a set in a box of this size [m]; they may reach out of it.
std::vector<DiscFlaw> discs(const DiscSet& set, const Vector<3>& size);

/// The parts of a line that lie in a box of this size [m].
std::vector<ClosedFlaw> parts_inside(const ClosedFlaw& flaw, const Vector<2>& size);

/// Why it cannot be put into a body of this size [m], in the words of an error; empty if it can.
template <int dim>
std::string objection(const Shape& shape, const Vector<dim>& size);

/// Returns whether a point of the plane lies in a polygon.
bool is_inside(const std::vector<Vector<2>>& corners, const Vector<2>& point);

/// Returns whether the straight line from a to b meets the one from c to d.
bool cross(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c, const Vector<2>& d);
} // namespace feldspar
