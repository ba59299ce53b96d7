#pragma once

#include "laboratory/appearance.h"
#include "laboratory/bookkeeping.h"
#include "laboratory/record.h"

namespace feldspar
{
/// All that a test leaves behind, by the use that is made of it.
struct TestOutcome
{
  TestRecord record;          ///< the measurement: figures are read off it, and off nothing else
  TestAppearance appearance;  ///< for pictures
  RunBookkeeping bookkeeping; ///< for who cares how long it took
};
} // namespace feldspar
