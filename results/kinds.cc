#include "results/kinds.h"

#include <fmt/format.h>

#include <stdexcept>

namespace feldspar
{
std::string name(const TestKind kind)
{
  switch (kind)
    {
    case TestKind::direct_tension:
      return "direct_tension";
    case TestKind::uniaxial_compression:
      return "uniaxial_compression";
    case TestKind::triaxial_compression:
      return "triaxial_compression";
    case TestKind::brazilian:
      return "brazilian";
    }
  throw std::logic_error("a test kind without a name");
}

std::string name(const TestCase& test)
{
  return test.kind == TestKind::triaxial_compression
           ? fmt::format("{}_{}_MPa", name(test.kind), test.confining_pressure / 1e6)
           : name(test.kind);
}

std::vector<TestCase> test_cases(const std::vector<TestKind>& kinds, const std::vector<double>& confinements)
{
  std::vector<TestCase> tests;
  for (const TestKind kind : kinds)
    if (kind == TestKind::triaxial_compression)
      for (const double pressure : confinements)
        tests.push_back({kind, pressure});
    else
      tests.push_back({kind});
  return tests;
}

std::string name(const TestBody body) { return body == TestBody::grains ? "grains" : "finite_elements"; }

bool PeakWatch::is_highest(const double stress)
{
  constexpr double fall = 0.05;
  constexpr double round_off = 1e-9; // a plateau peaks where it begins
  const bool brazilian_over = kind == TestKind::brazilian && fallen;
  if (stress < (1.0 - fall) * highest)
    fallen = true;
  if (stress <= highest * (1.0 + round_off) || brazilian_over)
    return false;
  highest = stress;
  return true;
}

double laboratory_sign(const TestKind kind) { return kind == TestKind::direct_tension ? 1.0 : -1.0; }
} // namespace feldspar
