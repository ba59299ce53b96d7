#pragma once

#include <deal.II/base/point.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace feldspar::fem
{
/// What is done to the boundaries of a sample. Between two loads displacements and pressures go in proportion.
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

  /// Against the normal of the boundary, inwards positive [Pa].
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

  /// A node that does not move along one coordinate; takes out the rigid motion that smooth platens leave.
  struct Pin
  {
    dealii::Point<dim> node;
    unsigned int component;
  };

  std::vector<Displacement> displacements;
  std::vector<Pressure> pressures;
  std::vector<FreePlate> free_plates;
  std::vector<Pin> pins;
};

enum class Platens
{
  smooth, ///< nothing holds the ends sideways
  rough   ///< the ends do not move sideways
};

/// The bottom stands still and the top moves along the axis, the last coordinate, by a displacement [m] (upwards
/// positive). sideways: the coordinates held at the ends when the platens are rough (r alone in r-z).
template <int dim>
Load<dim> platen_load(const Platens platens, const double top_displacement)
{
  const auto constant = [](const double value) { return [value](const dealii::Point<dim>&) { return value; }; };
  Load<dim> load;
  load.displacements = {{"bottom", dim - 1, constant(0.0)}, {"top", dim - 1, constant(top_displacement)}};
  if (platens == Platens::rough)
    for (const char* const boundary : {"bottom", "top"})
      for (unsigned int component = 0; component < dim - 1; ++component)
        load.displacements.push_back({boundary, component, constant(0.0)});
  return load;
}
} // namespace feldspar::fem
