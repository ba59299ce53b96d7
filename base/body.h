#pragma once

namespace feldspar
{
/// The shape of a body of grains.
enum class BodyShape
{
  box,
  cylinder,         ///< upright, in space
  periodic,         ///< a cell that repeats itself
  periodic_sideways ///< the same between walls at its ends; such a cell is cored, no input asks for it by name
};

constexpr bool is_periodic(const BodyShape shape)
{
  return shape == BodyShape::periodic || shape == BodyShape::periodic_sideways;
}

/// The bodies that are tested.
enum class Body
{
  plane_box, ///< of discs
  box,       ///< of spheres
  cylinder,  ///< of spheres
  sample     ///< of finite elements
};

/// A body of grains between walls.
constexpr Body body_of(const unsigned int dimension, const BodyShape shape)
{
  return dimension == 2 ? Body::plane_box : shape == BodyShape::cylinder ? Body::cylinder : Body::box;
}
} // namespace feldspar
