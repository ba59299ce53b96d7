#pragma once

#include "base/mapped.h"
#include "results/runs/run.h"

#include <algorithm>
#include <string>
#include <vector>

namespace feldspar
{
/// The bodies of the tests of a series.
enum class SeriesKind
{
  specimens,       ///< of grains
  finite_elements, ///< with an RVE of grains or a law at every point
  laboratory_curve ///< measured on rock
};

constexpr SeriesKind kind_of_series(const TestBody body)
{
  return body == TestBody::grains ? SeriesKind::specimens : SeriesKind::finite_elements;
}

/// Tests on one rock that the report shows under one name and in one colour: a result folder, or a variant in it.
struct Series
{
  std::string label;
  SeriesKind kind = SeriesKind::specimens;
  Provenance made_by;
  std::vector<FinishedTest> tests;
  std::vector<std::string> problems; ///< what of it could not be had and why, each in a sentence
  std::string key_if_alone = {};     ///< in the keys of pictures, where no other series is shown; empty: the label

  const std::string& key() const { return key_if_alone.empty() ? label : key_if_alone; }
};

/// Tests of one rock, which outlive it.
using TestsOfRock = std::vector<const FinishedTest*>;

inline TestsOfRock all_of(const Series& series)
{
  return mapped<const FinishedTest*>(series.tests, [](const FinishedTest& test) { return &test; });
}

inline bool any_has_flaws(const std::vector<Series>& all)
{
  return std::ranges::any_of(all, [](const Series& series) { return any_has_flaws(series.tests); });
}
} // namespace feldspar
