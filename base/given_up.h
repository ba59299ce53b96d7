#pragma once

#include <functional>

namespace feldspar
{
/// Thrown by work that was left because the run is to end.
struct GivenUp
{
};

/// Empty: never.
inline void leave_if(const std::function<bool()>& gives_up)
{
  if (gives_up && gives_up())
    throw GivenUp();
}
} // namespace feldspar
