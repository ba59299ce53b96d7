#pragma once

#include <algorithm>
#include <stdexcept>

namespace feldspar::fem
{
/// Cuts a way into steps, from 0 to 1: halves what fails, grows again after successes. Arithmetic only.
class StepControl
{
public:
  /// All as shares of the way.
  StepControl(const double first, const double least, const double most)
    : size(std::min(first, most))
    , smallest(least)
    , largest(most)
  {
    if (!(least > 0.0 && first >= least && most >= least))
      throw std::invalid_argument("steps must be positive, and none below the smallest");
  }

  /// One that goes on where another was.
  struct Standing
  {
    double done = 0.0;
    double size = 1.0;
    unsigned int n_in_a_row = 0; ///< successes
  };
  Standing standing() const { return {where, size, n_in_a_row}; }
  void go_on_from(const Standing& standing)
  {
    where = standing.done;
    size = standing.size;
    n_in_a_row = standing.n_in_a_row;
  }

  double done() const { return where; }
  bool finished() const { return where >= 1.0; }
  /// Returns where the next step should end. The last two steps are made equal, so that no sliver is left.
  double next() const
  {
    const double left = 1.0 - where;
    return left <= size * (1.0 + 1e-9) ? 1.0 : left < 2.0 * size ? where + 0.5 * left : where + size;
  }

  void succeeded()
  {
    where = next();
    if (++n_in_a_row >= 2)
      size = std::min(1.5 * size, largest);
  }

  /// Cuts the step. Returns false when it cannot be cut any more; then it stays as it is.
  bool cut()
  {
    n_in_a_row = 0;
    const double half = 0.5 * (next() - where);
    if (half < smallest)
      return false;
    size = half;
    return true;
  }

private:
  double where = 0.0;
  double size;
  double smallest;
  double largest;
  unsigned int n_in_a_row = 0;
};
} // namespace feldspar::fem
