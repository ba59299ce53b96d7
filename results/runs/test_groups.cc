#include "results/runs/test_groups.h"

#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::size_t n_band_rows = 160;

std::string megapascals(const double pressure) { return fmt::format("{:g}", pressure / 1e6); }
} // namespace

std::string TestGroup::title() const
{
  std::string text(kind.title);
  if (kind.takes_confining_pressure)
    text += fmt::format(", {} MPa", megapascals(confining_pressure));
  if (intermediate_stress)
    text += fmt::format(", intermediate stress {} MPa", megapascals(*intermediate_stress));
  return text;
}

std::string TestGroup::name() const
{
  const std::string text = feldspar::name(TestCase{kind, confining_pressure});
  return intermediate_stress ? fmt::format("{}_intermediate_{}_MPa", text, *intermediate_stress / 1e6) : text;
}

TestGroup group_of(const TestRecord& record)
{
  return {record.kind, record.confining_pressure, record.intermediate_stress, {}};
}

bool same_conditions(const TestGroup& a, const TestGroup& b)
{
  return a.kind == b.kind && a.confining_pressure == b.confining_pressure &&
         a.intermediate_stress == b.intermediate_stress;
}

bool comes_before(const TestGroup& a, const TestGroup& b)
{
  if (a.kind != b.kind)
    return comes_before(a.kind, b.kind);
  return std::pair(a.confining_pressure, a.intermediate_stress) <
         std::pair(b.confining_pressure, b.intermediate_stress);
}

std::vector<TestGroup> groups_of(const Series& series)
{
  std::vector<TestGroup> groups;
  for (const auto& test : series.tests)
    {
      const TestGroup wanted = group_of(test.record);
      auto group = std::ranges::find_if(groups, [&](const TestGroup& one) { return same_conditions(one, wanted); });
      if (group == groups.end())
        group = groups.insert(groups.end(), wanted);
      group->tests.push_back(&test);
    }
  std::ranges::stable_sort(groups, [](const TestGroup& a, const TestGroup& b) { return comes_before(a, b); });
  return groups;
}

std::vector<TestGroup> shown(const std::vector<TestGroup>& groups)
{
  std::vector<TestGroup> result;
  for (const auto& group : groups)
    {
      const auto is_beyond = [&](const double sign) {
        return std::ranges::any_of(groups, [&](const TestGroup& other) {
          return other.kind == group.kind && sign * (other.confining_pressure - group.confining_pressure) > 0.0;
        });
      };
      if (!is_beyond(-1.0) || !is_beyond(1.0))
        result.push_back(group);
    }
  return result;
}

const FinishedTest* typical(const TestGroup& group)
{
  const auto found = std::ranges::find_if(
    group.tests, [](const FinishedTest* test) { return test->results.peak_stress.value && peak_row(test->record); });
  return found == group.tests.end() ? nullptr : *found;
}

std::vector<double> values(const TestGroup& group, Figure TestResults::*figure)
{
  std::vector<double> result;
  for (const auto* test : group.tests)
    if (test->results.is_valid() && (test->results.*figure).value)
      result.push_back(*(test->results.*figure).value);
  return result;
}

double abscissa(const TestKind& kind, const CurveSample& row)
{
  return kind.follows_stages ? row.time : kind.sign * row.axial_strain;
}

Band band(const TestGroup& group, const std::function<double(const CurveSample&)>& quantity, const bool laboratory)
{
  const auto at = [&](const CurveSample& row) { return abscissa(group.kind, row); };
  double end = std::numeric_limits<double>::infinity();
  std::vector<const std::vector<CurveSample>*> curves;
  for (const auto* test : group.tests)
    if (const auto& curve = test->record.curve; curve.size() > 1)
      {
        curves.push_back(&curve);
        end = std::min(end, at(curve.back()));
      }
  Band result;
  if (curves.empty() || !(end > 0.0))
    return result;
  for (std::size_t k = 0; k < n_band_rows; ++k)
    {
      const double here = end * double(k) / double(n_band_rows - 1);
      std::vector<double> of_tests;
      for (const auto* curve : curves)
        {
          auto above = std::lower_bound(curve->begin() + 1, curve->end() - 1, here,
                                        [&](const CurveSample& row, const double value) { return at(row) < value; });
          const auto below = above - 1;
          const double width = at(*above) - at(*below);
          const double weight = width > 0.0 ? std::clamp((here - at(*below)) / width, 0.0, 1.0) : 1.0;
          of_tests.push_back((laboratory ? group.kind.sign : 1.0) *
                             ((1.0 - weight) * quantity(*below) + weight * quantity(*above)));
        }
      const auto over_seeds = *statistics(of_tests);
      result.abscissa.push_back(here);
      result.mean.push_back(over_seeds.mean);
      result.deviation.push_back(over_seeds.standard_deviation.value_or(0.0));
    }
  return result;
}
} // namespace feldspar
