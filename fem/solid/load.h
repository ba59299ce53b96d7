#pragma once

#include <deal.II/base/point.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace feldspar::fem
{
/// The loads on the boundaries of a sample. Between two loads displacements and pressures go in proportion.
///
/// Where two displacements are asked of one node the first holds.
template <int dim>
struct Load
{
  /// One component of the displacement along a boundary [m], by position.
  struct Displacement
  {
    std::string boundary;
    unsigned int component;
    std::function<double(const dealii::Point<dim>&)> value;
  };

  /// Pressure against the normal of the boundary, inwards positive [Pa].
  struct Pressure
  {
    std::string boundary;
    double value;
  };

  /// A rigid smooth plate: one component of the displacement is the same all along the boundary, and free. With a
  /// pressure on the same boundary the plate is held by that force.
  struct FreePlate
  {
    std::string boundary;
    unsigned int component;
  };

  /// The node next to a position does not move along one coordinate; takes out the rigid motion that smooth platens
  /// leave.
  struct Pin
  {
    dealii::Point<dim> position;
    unsigned int component;
  };

  /// A plate among the displacements, whose own one is then taken as where it is: it goes as far as lets other boundaries
  /// sweep a volume between them, as a laboratory does that holds the widening of a sample (class II).
  struct Follower
  {
    std::string plate;
    unsigned int component;
    std::vector<std::string> boundaries;
    double swept_volume; ///< from rest, outwards positive [m³]; in the plane per metre of thickness
  };

  std::vector<Displacement> displacements;
  std::vector<Pressure> pressures;
  std::vector<FreePlate> free_plates;
  std::vector<Pin> pins;
  std::optional<Follower> follower{};
};
} // namespace feldspar::fem
