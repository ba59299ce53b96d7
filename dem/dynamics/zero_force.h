#pragma once

namespace feldspar
{
/// Overlap at which a contact without a face begins to press.
enum class ZeroForce
{
  at_touch, ///< where the surfaces touch
  as_placed ///< overlaps that are there at the start count as zero force, and gaps that a bed fills
};
} // namespace feldspar
