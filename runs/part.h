#pragma once

#include "runs/observer.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>

namespace feldspar
{
/// Leads a part of a run from where it stands to its end, or to where the observer wants the end, and keeps it there and
/// wherever a checkpoint is due.
///
/// `advance(keep_if_due)` brings the part to its next row; keep_if_due() may be called at moments in between at which the part
/// can be kept. It returns false where the part is not to be kept any more, because its numbers went wrong.
/// A checkpoint is due at once, then when the time since the last is fifty times as long as that took to write, and at least
/// some seconds. Checkpoints then cost at most 2 % of the time. Of a part that counts steps one is also due after
/// `steps_between_checkpoints`, if that is not 0.
///
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
  using Clock = std::chrono::steady_clock;
  auto next = Clock::time_point::min();
  std::uint64_t next_step = n_steps() + steps_between_checkpoints;
  const auto keep = [&] {
    const auto begin = Clock::now();
    checkpoints.write(part);
    const auto end = Clock::now();
    constexpr std::chrono::seconds least(5);
    next = end + std::max<Clock::duration>(least, 50 * (end - begin));
    next_step = n_steps() + steps_between_checkpoints;
  };
  const auto keep_if_due = [&] {
    if (agreed(Clock::now() >= next || (steps_between_checkpoints > 0 && n_steps() >= next_step)))
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
