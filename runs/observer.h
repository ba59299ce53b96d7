#pragma once

#include "laboratory/curve.h"

#include <cstddef>
#include <exception>
#include <string>

namespace feldspar
{
/// The end of work that was asked to end and has nothing to hand over.
struct Interrupted : std::exception
{
  const char* what() const noexcept override { return "interrupted"; }
};

/// The state of a part of a run.
struct PartStanding
{
  const CurveSample* row = nullptr; ///< the last of its curve; none between two rows, and of a path
  double share = 0.0;               ///< of a path that is behind, 0 … 1
  std::string text = {};            ///< its cracks, and what else is to be said
};

/// Hears how the parts of a run (tests, paths) get on, and may end the run. Parts are counted in the order in which they were
/// handed over. Those that run at the same time call from several threads.
class RunObserver
{
public:
  virtual ~RunObserver() = default;

  /// Returns whether the run is to end. Running parts are stored first, so that a later run continues them.
  virtual bool wants_end() const { return false; }
  virtual void advanced(std::size_t /*part*/, const PartStanding& /*standing*/) {}
  virtual void ended(std::size_t /*part*/) {}
  virtual void cannot_be_made(std::size_t /*part*/, const std::string& /*reason*/) {}

  /// Throws Interrupted where the run is to end.
  void end_if_wanted() const
  {
    if (wants_end())
      throw Interrupted();
  }
};
} // namespace feldspar
