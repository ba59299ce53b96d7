#pragma once

#include "app/input/input.h"
#include "app/run/interrupt.h"
#include "app/screen/expected_length.h"
#include "app/screen/progress.h"
#include "laboratory/curve.h"
#include "laboratory/kinds.h"
#include "laboratory/peak.h"
#include "runs/observer.h"

#include <cstddef>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace feldspar
{
/// A test that is to be shown. Its cost follows from how far it will probably go.
struct BoardTest
{
  TestCase test;
  const Input* input; ///< outlives the board
  TestCost cost;
};

/// A part of a run that is to be shown: a specimen, a test, a path.
struct BoardPart
{
  std::string name;
  double cost = 1.0; ///< in any unit that all parts have in common
  std::optional<BoardTest> test = {};
};

/// The observer of all runs that have a screen: tells the progress how the parts stand, and ends the run on Ctrl-C. Several
/// threads may call it at the same time.
class RunBoard : public RunObserver
{
public:
  /// Without a title, the parts belong to the stretch of work that the progress is at. `tells_failures`: whether a part that
  /// cannot be made is said at once, one for each reason.
  RunBoard(Progress& shown, const std::string& title, const std::vector<BoardPart>& parts, bool tells_failures = false);

  bool wants_end() const override { return interrupted(); }
  void advanced(std::size_t part, const PartStanding& standing) override;
  void ended(std::size_t part) override;
  void cannot_be_made(std::size_t part, const std::string& reason) override;
  void goes_back(const std::string& sentence) override;

  /// A part that an earlier run has made is no work of this one.
  void taken_up(std::size_t part);

private:
  struct Entry
  {
    BoardPart part;
    std::optional<PeakWatch> peak = {};     ///< of a test
    std::optional<StageLength> stages = {}; ///< of a test that follows them
    CurveSample row{};
    double share = 0.0;
    std::string text = {};
    bool running = false;
    bool finished = false;
  };

  double strain_at_peak(const Entry& entry) const;
  double last_strain(const Entry& entry) const;
  double share(const Entry& entry) const;
  void draw();

  Progress& progress;
  const bool tells;
  std::mutex showing;
  std::set<std::string> said; ///< reasons
  std::vector<Entry> entries;
};
} // namespace feldspar
