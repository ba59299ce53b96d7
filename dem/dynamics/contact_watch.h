#pragma once

#include "dem/dynamics/walls.h"
#include "dem/sharing/body_share.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <string>

namespace feldspar
{
/// Watches how far grains and walls have gone since contacts were last searched for, so that none is missed and few steps
/// look.
template <int dim>
class ContactWatch
{
public:
  explicit ContactWatch(const Grains<dim>& grains);

  /// Gap up to which contacts are kept in mind [m].
  double skin() const { return widest_gap; }

  void note_search(const Grains<dim>& grains) { position_at_search = grains.position; }
  /// The next look is due after the step.
  void begin_at(const std::uint64_t step) { next_check = step + 1; }
  bool is_due(const std::uint64_t step) const { return step == next_check; }

  /// Returns whether a pair that was not near at the last search could come into contact before the next check; sets
  /// the time of that check.
  bool may_miss_contacts(const Specimen<dim>& body, const BodyShare<dim>& share, const Walls<dim>& walls,
                         std::uint64_t step, double dt);

  template <typename Archive>
  void transfer(Archive& archive)
  {
    for (int c = 0; c < dim; ++c)
      archive.array(std::string("position_at_search_") + "xyz"[c], position_at_search[c]);
    archive.value("next_look", next_check);
  }

private:
  double widest_gap;
  Components<dim> position_at_search;
  std::uint64_t next_check = 0; ///< step before which no contact can have been missed
};
} // namespace feldspar
