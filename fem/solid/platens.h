#pragma once

#include "fem/solid/kinematics.h"
#include "fem/solid/load.h"

namespace feldspar::fem
{
enum class Platens
{
  smooth, ///< nothing holds the ends sideways
  rough   ///< the ends do not move sideways, from the first load on
};

/// The loads of a laboratory test on a sample whose boundaries are named as in sample_mesh.h. The bottom stands, the top
/// moves along the axis, which is the last coordinate. Tension is a positive displacement, compression a negative one.
template <int dim>
struct PlatenTest
{
  Kinematics kinematics = Kinematics::plane;
  Platens platens = Platens::smooth;
  double confining_pressure = 0.0; ///< on the sides [Pa], compression positive

  /// The confining pressure all round: the top is a plate held by that force.
  Load<dim> seating() const { return holding(confining_pressure); }

  /// The top a plate held by a force over its area at rest [Pa], compression positive; the sides under the confining
  /// pressure.
  Load<dim> holding(const double axial_stress) const
  {
    Load<dim> load = held();
    load.pressures.push_back({"top", axial_stress});
    load.free_plates = {{"top", dim - 1}};
    return load;
  }

  /// The same test under another confining pressure [Pa].
  PlatenTest under(const double another_pressure) const { return {kinematics, platens, another_pressure}; }

  /// Platens at a displacement of the top [m], the sides under the confining pressure.
  Load<dim> pressing(const double top_displacement) const
  {
    Load<dim> load = held();
    load.displacements.push_back({"top", dim - 1, [=](const dealii::Point<dim>&) { return top_displacement; }});
    return load;
  }

  /// The same with the platens as near as lets the sides, all of them, widen by a volume from rest [m³].
  Load<dim> widening(const double swept_volume) const
  {
    Load<dim> load = pressing(0.0);
    load.follower.emplace();
    load.follower->plate = "top";
    load.follower->component = dim - 1;
    for (const auto& side : load.pressures)
      load.follower->boundaries.push_back(side.boundary);
    load.follower->swept_volume = swept_volume;
    return load;
  }

private:
  Load<dim> held() const
  {
    const auto nothing = [](const dealii::Point<dim>&) { return 0.0; };
    Load<dim> load;
    load.displacements = {{"bottom", dim - 1, nothing}};
    if (kinematics == Kinematics::axisymmetric)
      load.displacements.push_back({"axis", 0, nothing});
    if (platens == Platens::rough)
      for (const char* const end : {"bottom", "top"})
        for (unsigned int component = 0; component < dim - 1; ++component)
          load.displacements.push_back({end, component, nothing});
    else if (kinematics != Kinematics::axisymmetric)
      {
        for (unsigned int component = 0; component < dim - 1; ++component)
          load.pins.push_back({dealii::Point<dim>(), component});
        if (dim == 3) // nor does it turn about its axis
          load.pins.push_back({far_along_x(), 1});
      }
    for (const char* const side : {"left", "right"})
      if (kinematics == Kinematics::plane)
        load.pressures.push_back({side, confining_pressure});
    if (kinematics != Kinematics::plane)
      load.pressures.push_back({"side", confining_pressure});
    return load;
  }

  static dealii::Point<dim> far_along_x()
  {
    dealii::Point<dim> position;
    position[0] = 1e3; // the node next to it is the sample's last
    return position;
  }
};
} // namespace feldspar::fem
