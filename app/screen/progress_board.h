#pragma once

#include "app/input/input.h"
#include "app/screen/expected_length.h"
#include "app/screen/progress.h"
#include "app/screen/stage_length.h"
#include "laboratory/curve.h"
#include "laboratory/kinds.h"
#include "laboratory/peak.h"

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A test that is to be shown.
struct BoardTest
{
  std::string name;
  TestCase test;
  const Input* input; ///< outlives the board
  TestCost cost;
};

/// Tells the progress how all tests of a run stand. Several threads may call it at the same time.
class ProgressBoard
{
public:
  ProgressBoard(Progress& shown, const std::vector<BoardTest>& planned);

  /// The k-th test has got to this row of its curve. `more`: what else is to be said of it.
  void update(std::size_t k, const CurveSample& row, const std::string& more);
  /// The k-th test goes on between two rows.
  void update(std::size_t k, const std::string& more);
  /// A sentence that stays.
  void say(const std::string& sentence);
  void finish(std::size_t k);

private:
  struct Entry
  {
    BoardTest planned;
    PeakWatch peak;
    std::optional<StageLength> stages = {}; ///< of a test that follows them
    CurveSample row{};
    std::string more = {};
    bool running = false;
    bool finished = false;
  };

  double strain_at_peak(const Entry& entry) const;
  double last_strain(const Entry& entry) const;
  double fraction(const Entry& entry) const;
  void draw();

  Progress& progress;
  std::mutex showing;
  std::vector<Entry> entries;
};
} // namespace feldspar
