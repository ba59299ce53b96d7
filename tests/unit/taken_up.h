#pragma once

#include "tests/temporary_folder.h"

#include <utility>

namespace feldspar::tests
{
/// The run that `begin` makes gone to its end, and the same resumed from a checkpoint after every fourth advance.
template <typename Begin>
auto whole_and_taken_up(const Begin& begin)
{
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  auto whole = begin();
  auto broken = begin();
  while (!whole.has_ended())
    whole.advance();
  for (unsigned int k = 0; !broken.has_ended(); ++k)
    {
      broken.advance();
      if (k % 4 == 3)
        {
          broken.write_checkpoint(file, "the same");
          auto next = begin();
          next.read_checkpoint(file, "the same");
          broken = std::move(next);
        }
    }
  return std::pair(std::move(whole), std::move(broken));
}
} // namespace feldspar::tests
