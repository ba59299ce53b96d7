#include "laboratory/kinds.h"

#include "base/mapped.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace feldspar
{
bool comes_before(const TestKind& a, const TestKind& b)
{
  const auto place = [](const TestKind& kind) {
    return std::tuple(kind.envelope_role, kind.takes_confining_pressure, kind.name);
  };
  return place(a) < place(b);
}

EnvelopeRole envelope_role(const TestKind& kind, const std::optional<double>& intermediate_stress)
{
  return intermediate_stress ? EnvelopeRole::none : kind.envelope_role;
}

std::string name(const TestCase& test)
{
  return test.kind.takes_confining_pressure ? fmt::format("{}_{}_MPa", test.kind.name, test.confining_pressure / 1e6)
                                            : std::string(test.kind.name);
}

std::vector<TestCase> test_cases(const std::vector<TestKind>& kinds, const std::vector<double>& confinements)
{
  std::vector<TestCase> tests;
  for (const TestKind& kind : kinds)
    if (kind.takes_confining_pressure)
      for (const double pressure : confinements)
        tests.push_back({kind, pressure});
    else
      tests.push_back({kind});
  return tests;
}

bool any_takes_confining_pressure(const std::vector<TestKind>& kinds)
{
  return std::ranges::any_of(kinds, &TestKind::takes_confining_pressure);
}

std::string names(const std::vector<TestKind>& kinds)
{
  return fmt::format("{}", fmt::join(mapped<std::string_view>(kinds, &TestKind::name), ", "));
}

std::string name(const TestBody body) { return body == TestBody::grains ? "grains" : "finite_elements"; }
} // namespace feldspar
