#pragma once

#include "results/runs/series.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Trust in tests: measures, each with a bound. The terminal, summary.json and the report take them from here. The
/// reasons for the bounds are in docs/report.md.
namespace feldspar
{
struct TrustMeasure
{
  std::string_view name;  ///< in result files
  std::string_view title; ///< in words
  ShownIn shown;
  PlausibleBound bound;

  bool is_out(const double number) const
  {
    return bound.side == BoundSide::at_most ? number > bound.value : number < bound.value;
  }
  std::string text(double number) const; ///< 0.02 %
  std::string bound_text() const;        ///< at most 1 %

private:
  std::string unit() const { return shown.unit.empty() ? "" : ' ' + std::string(shown.unit); }
};

/// A measure over the tests to which it applies, one at least.
struct TrustCheck
{
  TrustMeasure measure;
  std::size_t n_tests;
  std::size_t n_out; ///< tests out of the bound
  double mean;
  double worst;
  std::string worst_test;

  std::string warning() const; ///< that tests are out of the bound
};

/// Energy balance, quasi-static evidence, servo, resolution, packing, elasticity; nothing for what was measured on rock.
std::vector<TrustCheck> trust_checks(const TestsOfRock& tests, SeriesKind kind);
std::vector<TrustCheck> trust_checks(const Series& series);

/// Failed and missing tests, each in a sentence; nothing if all are there.
std::vector<std::string> shortcomings(const TestsOfRock& tests, SeriesKind kind);

/// Shortcomings, and measures that are out of their bounds.
std::vector<std::string> warnings(const TestsOfRock& tests, SeriesKind kind);
/// Warnings on the tests of a series, and on what could not be read.
std::vector<std::string> warnings(const Series& series);

/// Warnings that several models have in common, and those that each has for itself.
struct SharedWarnings
{
  std::vector<std::string> of_all;           ///< empty where there is one model
  std::vector<std::vector<std::string>> own; ///< of each series
};

SharedWarnings shared_warnings(const std::vector<Series>& series);

/// Warnings on many models, each once with the number of models that it holds for: alike are those that differ in names of
/// tests and numbers alone. Measures are those of all tests together.
std::vector<std::string> grouped_warnings(const std::vector<Series>& series);

/// The tests of one rock: those of a variant, or all of a run without variants.
struct RockTests
{
  std::string variant;
  SeriesKind kind;
  TestsOfRock tests;
};

/// Tests of each rock, in the order in which the rocks come.
std::vector<RockTests> by_rock(const std::vector<FinishedTest>& tests);

/// The checks for a terminal: of each measure its worst value, the bound, and how many tests are out of it.
std::string as_text(const std::vector<TrustCheck>& checks);

/// The checks and shortcomings of each rock; of more than three rocks the checks of all tests together.
std::string trust_as_text(const std::vector<FinishedTest>& tests);
} // namespace feldspar
