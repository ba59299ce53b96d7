#include "app/programme/run_board.h"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar
{
RunBoard::RunBoard(Progress& shown, const std::string& title, const std::vector<BoardPart>& parts,
                   const bool tells_failures)
  : progress(shown)
  , tells(tells_failures)
{
  for (const BoardPart& part : parts)
    {
      Entry& entry = entries.emplace_back(Entry{part});
      if (const auto& of = part.test)
        {
          entry.peak.emplace(of->test.kind, of->test.confining_pressure, PeakDemands{});
          if (of->test.kind.follows_stages)
            entry.stages.emplace(of->input->tests, expected_modulus(*of->input));
        }
    }
  if (!title.empty())
    progress.start(title);
}

void RunBoard::advanced(const std::size_t part, const PartStanding& standing)
{
  const std::lock_guard lock(showing);
  Entry& entry = entries[part];
  entry.share = standing.share;
  entry.text = standing.text;
  entry.running = true;
  if (const CurveSample* const row = standing.row; row && entry.peak)
    {
      entry.row = *row;
      entry.peak->add(*row);
      if (entry.stages)
        entry.stages->follow(*row);
    }
  draw();
}

void RunBoard::ended(const std::size_t part)
{
  const std::lock_guard lock(showing);
  entries[part].running = false;
  entries[part].finished = true;
  draw();
}

void RunBoard::cannot_be_made(const std::size_t part, const std::string& reason)
{
  const std::lock_guard lock(showing);
  if (tells && entries.size() > 1 &&
      said.insert(reason).second) // the run ends with it, and with all parts that it is of
    progress.remark(fmt::format("{} cannot be made: {}", entries[part].part.name, reason));
}

void RunBoard::taken_up(const std::size_t part)
{
  {
    const std::lock_guard lock(showing);
    entries[part].part.cost = 0.0;
  }
  ended(part);
}

void RunBoard::goes_back(const std::string& sentence)
{
  const std::lock_guard lock(showing);
  progress.note(sentence);
}

/// Strain at the peak of the test itself once the curve has left it; else that of a finished test of the same kind and pressure, or a guess; 0 where
/// there is none.
double RunBoard::strain_at_peak(const Entry& entry) const
{
  if (entry.peak->strain() > 0.0 && (entry.peak->has_fallen() || entry.finished))
    return entry.peak->strain();
  const TestCase& test = entry.part.test->test;
  const auto sister = std::ranges::find_if(entries, [&](const Entry& other) {
    return other.finished && other.peak->strain() > 0.0 && other.part.test->test.kind == test.kind &&
           other.part.test->test.confining_pressure == test.confining_pressure;
  });
  const std::optional<double> guess = sister != entries.end() ? std::optional(sister->peak->strain())
                                                              : expected_strain_at_peak(test, *entry.part.test->input);
  constexpr double beyond = 1.2; // of a curve that still rises
  return guess ? std::max(*guess, beyond * test.kind.strain(entry.row)) : 0.0;
}

double RunBoard::last_strain(const Entry& entry) const
{
  if (entry.stages)
    return entry.stages->gone() + entry.stages->left();
  return expected_last_strain(strain_at_peak(entry), entry.part.test->input->tests);
}

double RunBoard::share(const Entry& entry) const
{
  if (entry.finished)
    return 1.0;
  if (!entry.part.test)
    return entry.share;
  const double last = last_strain(entry);
  const double gone = entry.stages ? entry.stages->gone() : entry.part.test->test.kind.strain(entry.row);
  return last > 0.0 ? std::min(entry.part.test->cost.share(gone, last), 0.99) : 0.0;
}

void RunBoard::draw()
{
  double cost = 0.0;
  double spent = 0.0;
  std::size_t n_finished = 0;
  std::vector<ProgressDetail> details;
  for (const Entry& entry : entries)
    {
      const auto& test = entry.part.test;
      const double whole = test ? test->cost.whole(last_strain(entry)) : entry.part.cost;
      const double behind = share(entry);
      cost += whole;
      spent += behind * whole;
      n_finished += entry.finished;
      if (entry.running && !entry.text.empty())
        details.push_back({behind, entry.part.name,
                           test ? fmt::format("{:.4f} %, {:.1f} MPa{}", 100.0 * test->test.kind.strain(entry.row),
                                              test->test.kind.stress(entry.row) / 1e6, entry.text)
                                : entry.text});
    }
  progress.update(cost > 0.0 ? spent / cost : double(n_finished) / double(entries.size()),
                  fmt::format("{} of {} done", n_finished, entries.size()), details);
}
} // namespace feldspar
