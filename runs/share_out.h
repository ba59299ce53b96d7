#pragma once

#include "base/ranks/ranks.h"
#include "runs/observer.h"

#include <cstddef>
#include <functional>
#include <vector>

/// A run by several processes: each makes its share of the parts and leaves them in the folder of the run, where the first
/// takes them up, as after an interruption.
namespace feldspar
{
/// The parts that this process makes: every ranks::number()-th.
template <typename Part>
std::vector<Part> share_of_this_process(const std::vector<Part>& all)
{
  std::vector<Part> own;
  for (std::size_t k = ranks::mine(); k < all.size(); k += ranks::number())
    own.push_back(all[k]);
  return own;
}

/// Work of each process by itself, of all of them; an interruption of one is one of all: Interrupted is thrown on all.
/// Else as ranks::together().
inline void together_or_interrupted(const std::function<void()>& work)
{
  bool was_interrupted = false;
  ranks::together([&] {
    try
      {
        work();
      }
    catch (const Interrupted&)
      {
        was_interrupted = true;
      }
  });
  if (ranks::any(was_interrupted))
    throw Interrupted();
}
} // namespace feldspar
