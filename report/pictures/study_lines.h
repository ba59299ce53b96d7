#pragma once

#include "results/runs/series.h"

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// A study as its pictures and its table of effects see it: results of each test over the entries that take several numbers.
namespace feldspar
{
/// A result over which a study is shown.
struct StudiedResult
{
  std::string_view name; ///< of files
  std::string_view title;
  std::string_view unit;
  double scale;
  Figure TestResults::*figure;
};

/// The numbers that an entry takes, in one unit.
struct VariedEntry
{
  std::string entry;
  std::string unit;
  std::set<double> values;
};

/// An entry to draw over, with those that go along with it.
struct Abscissa
{
  VariedEntry varied;
  std::set<std::string> along;
};

/// The results of one test of the programme and one combination of the entries that do not go along.
struct StudyLine
{
  TestKind kind;
  std::string title;  ///< of the test
  std::string others; ///< the combination in words; empty: none
  std::map<double, std::vector<double>> results;

  std::string label() const { return others.empty() ? title : title + ", " + others; }
};

/// The effect of an entry on a result: its means over the seeds and over the lines that have all values of the entry.
struct StudyEffect
{
  StudiedResult result;
  std::string test;               ///< its title
  std::map<double, double> means; ///< by the value of the entry

  double change() const; ///< from the lowest to the highest value of the entry, over the former mean
  double reach() const;  ///< from the least to the largest mean, over the larger of their magnitudes
};

/// Results that studies show. Named for what they are: of a body with flaws the highest stress is a nominal one.
std::vector<StudiedResult> studied_results(const std::vector<Series>& all);

/// Entries to draw over; of those that go along with each other, the first.
std::vector<Abscissa> abscissas(const std::vector<Series>& all);

/// Lines of a result over an entry. Without the others tests are put together whatever their other entries are.
std::vector<StudyLine> lines_of(const std::vector<Series>& all, const Abscissa& over, const StudiedResult& result,
                                bool with_others);

/// Effects of an entry, result by result and test by test; none where no two tests differ in it alone.
std::vector<StudyEffect> effects_of(const std::vector<Series>& all, const Abscissa& over);
} // namespace feldspar
