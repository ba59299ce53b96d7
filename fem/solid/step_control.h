#pragma once

#include <algorithm>
#include <stdexcept>

namespace feldspar::fem
{
/// Cuts a way into steps, from 0 to 1: halves what fails, grows again after successes. Arithmetic only.
class StepControl
{
public:
  struct Standing
  {
    double done = 0.0;
    double size = 1.0;
    unsigned int n_in_a_row = 0; ///< successes
  };

  /// All as shares of the way.
  StepControl(const double first, const double least, const double most)
    : now{.size = std::min(first, most)}
    , smallest(least)
    , largest(most)
  {
    if (!(least > 0.0 && first >= least && most >= least))
      throw std::invalid_argument("steps must be positive, and none below the smallest");
  }

  const Standing& standing() const { return now; }
  /// Goes on where another one was.
  void go_on_from(const Standing& standing) { now = standing; }

  double done() const { return now.done; }
  bool finished() const { return now.done >= 1.0; }
  /// Returns where the next step should end. The last two steps are made equal, so that no sliver is left.
  double next() const
  {
    const double left = 1.0 - now.done;
    return left <= now.size * (1.0 + 1e-9) ? 1.0 : left < 2.0 * now.size ? now.done + 0.5 * left : now.done + now.size;
  }

  void succeeded()
  {
    now.done = next();
    if (++now.n_in_a_row >= 2)
      now.size = std::min(1.5 * now.size, largest);
  }

  /// Cuts the step. Returns false when it cannot be cut any more; then it stays as it is.
  bool cut()
  {
    now.n_in_a_row = 0;
    const double half = 0.5 * (next() - now.done);
    if (half < smallest)
      return false;
    now.size = half;
    return true;
  }

private:
  Standing now;
  double smallest;
  double largest;
};
} // namespace feldspar::fem
