#include "results/test_groups.h"

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
  switch (kind)
    {
    case TestKind::direct_tension:
      return "Direct tension";
    case TestKind::uniaxial_compression:
      return "Uniaxial compression";
    case TestKind::triaxial_compression:
      return fmt::format("Triaxial compression, {} MPa", megapascals(confining_pressure));
    case TestKind::brazilian:
      return "Brazilian test";
    }
  return "";
}

std::string TestGroup::name() const { return feldspar::name(TestCase{kind, confining_pressure}); }

std::vector<TestGroup> groups_of(const Series& series)
{
  std::vector<TestGroup> groups;
  for (const auto& test : series.tests)
    {
      const auto& record = test.record;
      auto group = std::find_if(groups.begin(), groups.end(), [&](const TestGroup& one) {
        return one.kind == record.kind && one.confining_pressure == record.confining_pressure;
      });
      if (group == groups.end())
        group = groups.insert(groups.end(), {record.kind, record.confining_pressure, {}});
      group->tests.push_back(&test);
    }
  std::stable_sort(groups.begin(), groups.end(), [](const TestGroup& a, const TestGroup& b) {
    return std::pair(a.kind, a.confining_pressure) < std::pair(b.kind, b.confining_pressure);
  });
  return groups;
}

std::vector<TestGroup> shown(const std::vector<TestGroup>& groups)
{
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const auto& group : groups)
    if (group.kind == TestKind::triaxial_compression)
      {
        lowest = std::min(lowest, group.confining_pressure);
        highest = std::max(highest, group.confining_pressure);
      }
  std::vector<TestGroup> result;
  for (const auto& group : groups)
    if (group.kind != TestKind::triaxial_compression || group.confining_pressure == lowest ||
        group.confining_pressure == highest)
      result.push_back(group);
  return result;
}

const FinishedTest* typical(const TestGroup& group)
{
  const auto found = std::find_if(group.tests.begin(), group.tests.end(), [](const FinishedTest* test) {
    return test->results.peak_stress.value && peak_row(test->record);
  });
  return found == group.tests.end() ? nullptr : *found;
}

std::vector<double> values(const TestGroup& group, Figure TestResults::*figure)
{
  std::vector<double> result;
  for (const auto* test : group.tests)
    if ((test->results.*figure).value)
      result.push_back(*(test->results.*figure).value);
  return result;
}

Band band(const TestGroup& group, const std::function<double(const CurveSample&)>& quantity, const bool laboratory)
{
  const double sign = laboratory_sign(group.kind);
  double end = std::numeric_limits<double>::infinity();
  std::vector<const std::vector<CurveSample>*> curves;
  for (const auto* test : group.tests)
    if (const auto& curve = test->record.curve; curve.size() > 1)
      {
        curves.push_back(&curve);
        end = std::min(end, sign * curve.back().axial_strain);
      }
  Band result;
  if (curves.empty() || !(end > 0.0))
    return result;
  for (std::size_t k = 0; k < n_band_rows; ++k)
    {
      const double strain = end * double(k) / double(n_band_rows - 1);
      std::vector<double> at_strain;
      for (const auto* curve : curves)
        {
          auto above =
            std::lower_bound(curve->begin() + 1, curve->end() - 1, strain,
                             [&](const CurveSample& row, const double s) { return sign * row.axial_strain < s; });
          const auto below = above - 1;
          const double width = sign * (above->axial_strain - below->axial_strain);
          const double weight = width > 0.0 ? std::clamp((strain - sign * below->axial_strain) / width, 0.0, 1.0) : 1.0;
          at_strain.push_back((laboratory ? sign : 1.0) *
                              ((1.0 - weight) * quantity(*below) + weight * quantity(*above)));
        }
      const auto over_seeds = *statistics(at_strain);
      result.strain.push_back(strain);
      result.mean.push_back(over_seeds.mean);
      result.deviation.push_back(over_seeds.standard_deviation.value_or(0.0));
    }
  return result;
}
} // namespace feldspar
