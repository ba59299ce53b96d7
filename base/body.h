#pragma once

namespace feldspar
{
/// The bodies that are tested.
enum class Body
{
  plane_box, ///< of discs
  box,       ///< of spheres
  cylinder,  ///< of spheres
  sample     ///< of finite elements
};
} // namespace feldspar
