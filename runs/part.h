#pragma once

#include "runs/checkpoints.h"
#include "runs/observer.h"

#include <cstdint>
#include <functional>

namespace feldspar
{
/// Leads a part of a run from where it stands to its end, or to where the observer wants the end, and keeps it there and
/// wherever a checkpoint is due.
///
/// `advance(keep_if_due)` brings the part to its next row; keep_if_due() may be called at moments in between at which the part
/// can be kept. It returns false where the part is not to be kept any more, because its numbers went wrong.
/// `agreed`: whether any of the processes that make the part together says so; by default there is one.
template <typename Part, typename Files, typename Advance, typename Agreed = std::identity>
void lead(Part& part, const Files& checkpoints, const RunObserver& observer,
          const std::uint64_t steps_between_checkpoints, const Advance& advance, const Agreed& agreed = {})
{
  const auto n_steps = [&]() -> std::uint64_t {
    if constexpr (requires { part.n_steps(); })
      return part.n_steps();
    else
      return 0;
  };
  CheckpointClock clock(n_steps(), steps_between_checkpoints);
  const auto keep = [&] { clock.time([&] { checkpoints.write(part); }, n_steps()); };
  const auto keep_if_due = [&] {
    if (agreed(clock.is_due(n_steps())))
      keep();
  };
  for (bool ends = agreed(observer.wants_end()); !ends && !part.has_ended();)
    {
      if (!advance(keep_if_due))
        return;
      ends = agreed(observer.wants_end());
      if (ends || part.has_ended())
        keep();
      else
        keep_if_due();
    }
}
} // namespace feldspar
