#pragma once

#include <string>
#include <vector>

namespace feldspar
{
enum class TestKind
{
  direct_tension,
  uniaxial_compression,
  triaxial_compression,
  brazilian
};

/// The name used in input and result files.
std::string name(TestKind kind);

/// What a test is made on.
enum class TestBody
{
  grains,         ///< a specimen that moves in time
  finite_elements ///< a sample in equilibrium at every row; no time, and no grain has a place of its own
};

/// The name used in result files.
std::string name(TestBody body);

/// A test of the programme.
struct TestCase
{
  TestKind kind;
  double confining_pressure = 0.0; ///< of a triaxial test, compression positive [Pa]
};

/// The name used in result files: the kind, and of a triaxial test the pressure.
std::string name(const TestCase& test);

/// Each kind, and each triaxial test under each of the pressures [Pa], in this order.
std::vector<TestCase> test_cases(const std::vector<TestKind>& kinds, const std::vector<double>& confinements);

/// +1 where the test pulls, -1 where it presses: turns tension-positive figures into those of the laboratory curve.
double laboratory_sign(TestKind kind);

/// Follows a curve to its peak, row by row; stresses positive in the sense of the test.
struct PeakWatch
{
  explicit PeakWatch(const TestKind of_kind)
    : kind(of_kind)
  {
  }

  /// Whether this stress is the highest so far. In a Brazilian test nothing is after the first fall of 5 %.
  bool is_highest(double stress);

  TestKind kind;
  double highest = 0.0;
  bool fallen = false;
};
} // namespace feldspar
