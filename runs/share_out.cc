#include "runs/share_out.h"

#include "runs/observer.h"

namespace feldspar
{
void together_or_interrupted(const std::function<void()>& work)
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
