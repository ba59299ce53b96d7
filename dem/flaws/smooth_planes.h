#pragma once

#include "dem/specimen/specimen.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// Installation of smooth joints in a specimen; docs/theory.md §1.9.
namespace feldspar
{
/// A joint that a plane crosses.
template <int dim>
struct SmoothPlace
{
  std::size_t joint;
  Vector<dim> normal; ///< of the plane, to either side; unit
  double area;        ///< share of the plane [m²]
};

/// Puts smooth joints in the place of those (ascending), stress free; joints and smooth joints are numbered anew.
template <int dim>
void put_smooth_joints(Specimen<dim>& specimen, const std::vector<SmoothPlace<dim>>& places,
                       const SmoothJointParameters& wanted, bool bonded);

/// Notes the pairs of grains near each other on either side of a plane: in sliding by up to a grain they pass over one
/// another. `cuts`: whether the plane crosses the way between two points.
template <int dim>
void keep_apart(Specimen<dim>& specimen, const std::function<bool(const Vector<dim>&, const Vector<dim>&)>& cuts);

/// Why no smooth joint can be so, in the words of an error; empty if it can.
std::string objection(const SmoothJointParameters& wanted);
} // namespace feldspar
