#pragma once

#include "results/runs/series.h"

#include <algorithm>
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

/// An entry to draw over: the numbers that it takes, in one unit, and the entries that go along with it.
struct Abscissa
{
  std::string entry;
  std::string unit;
  std::set<double> values;
  std::set<std::string> along = {};
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

  /// Returns whether it is an effect on the same result of the same test.
  bool is_on_same(const StudyEffect& other) const { return result.name == other.result.name && test == other.test; }
  /// The least and the largest mean.
  auto extremes() const { return std::ranges::minmax_element(means, {}, &decltype(means)::value_type::second); }
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
