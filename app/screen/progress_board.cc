#include "app/screen/progress_board.h"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar
{
ProgressBoard::ProgressBoard(Progress& shown, const std::vector<BoardTest>& planned)
  : progress(shown)
{
  for (const BoardTest& test : planned)
    {
      entries.push_back({test, PeakWatch(test.test.kind, test.test.confining_pressure, {})});
      if (test.test.kind.follows_stages)
        entries.back().stages.emplace(test.input->tests, expected_modulus(*test.input));
    }
  progress.start("tests");
}

void ProgressBoard::update(const std::size_t k, const CurveSample& row, const std::string& more)
{
  const std::lock_guard lock(showing);
  Entry& entry = entries[k];
  entry.row = row;
  entry.more = more;
  if (entry.stages)
    entry.stages->follow(row);
  entry.peak.add(row);
  entry.running = true;
  draw();
}

void ProgressBoard::update(const std::size_t k, const std::string& more)
{
  const std::lock_guard lock(showing);
  entries[k].more = more;
  entries[k].running = true;
  draw();
}

void ProgressBoard::say(const std::string& sentence)
{
  const std::lock_guard lock(showing);
  progress.note(sentence);
}

void ProgressBoard::finish(const std::size_t k)
{
  const std::lock_guard lock(showing);
  entries[k].running = false;
  entries[k].finished = true;
  draw();
}

/// Strain at the peak of a test: its own once the curve has left it; else that of a finished test of the same kind and
/// pressure, or a guess; 0 where there is none.
double ProgressBoard::strain_at_peak(const Entry& entry) const
{
  if (entry.peak.strain() > 0.0 && (entry.peak.has_fallen() || entry.finished))
    return entry.peak.strain();
  const TestCase& test = entry.planned.test;
  const auto sister = std::find_if(entries.begin(), entries.end(), [&](const Entry& other) {
    return other.finished && other.peak.strain() > 0.0 && other.planned.test.kind == test.kind &&
           other.planned.test.confining_pressure == test.confining_pressure;
  });
  const std::optional<double> guess = sister != entries.end() ? std::optional(sister->peak.strain())
                                                              : expected_strain_at_peak(test, *entry.planned.input);
  constexpr double beyond = 1.2; // of a curve that still rises
  return guess ? std::max(*guess, beyond * test.kind.strain(entry.row)) : 0.0;
}

double ProgressBoard::last_strain(const Entry& entry) const
{
  if (entry.stages)
    return entry.stages->gone() + entry.stages->left();
  return expected_last_strain(strain_at_peak(entry), entry.planned.input->tests);
}

double ProgressBoard::fraction(const Entry& entry) const
{
  if (entry.finished)
    return 1.0;
  const double last = last_strain(entry);
  const double gone = entry.stages ? entry.stages->gone() : entry.planned.test.kind.strain(entry.row);
  return last > 0.0 ? std::min(entry.planned.cost.share(gone, last), 0.99) : 0.0;
}

void ProgressBoard::draw()
{
  double cost = 0.0;
  double spent = 0.0;
  std::size_t n_finished = 0;
  std::vector<ProgressDetail> details;
  for (const Entry& entry : entries)
    {
      const double of_test = entry.planned.cost.whole(last_strain(entry));
      const double share = fraction(entry);
      cost += of_test;
      spent += share * of_test;
      n_finished += entry.finished;
      const TestKind& kind = entry.planned.test.kind;
      if (entry.running)
        details.push_back({share, entry.planned.name,
                           fmt::format("{:.4f} %, {:.1f} MPa{}", 100.0 * kind.strain(entry.row),
                                       kind.stress(entry.row) / 1e6, entry.more)});
    }
  progress.update(cost > 0.0 ? spent / cost : 0.0, fmt::format("{} of {} done", n_finished, entries.size()), details);
}
} // namespace feldspar
