#include "app/screen/test_length.h"

#include "app/input/joint_sections.h"
#include "dem/lab/protocols/protocols.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace feldspar
{
namespace
{
// Ratios of a specimen's figures to those of its flat joints, as Beishan granite has them
// (examples/beishan-granite/README.md): rocks by other parameters lie within a factor of two.
constexpr double modulus_over_bonds = 0.8;
constexpr double tension_over_bonds = 0.4;
constexpr double compression_over_bonds = 7.5;
constexpr double m = 20.0; // of Hoek and Brown
} // namespace

double expected_modulus(const Input& input)
{
  return std::visit([](const auto& law) { return modulus_over_bonds * law.modulus; }, joint_parameters(input));
}

std::optional<double> expected_strain_at_peak(const TestCase& test, const Input& input)
{
  const double modulus = expected_modulus(input);
  const double bonds =
    std::visit([](const auto& law) { return std::max(law.bond_tensile_strength, 1e-3 * law.bond_cohesion); },
               joint_parameters(input));
  const double tension = tension_over_bonds * bonds / modulus;
  const double uniaxial = compression_over_bonds * bonds;
  const auto [with, factor] = protocol_of(test.kind).forecast;
  switch (with)
    {
    case PeakForecast::With::tension:
      return factor * tension;
    case PeakForecast::With::compression:
      return factor *
             (uniaxial > 0.0 ? uniaxial / modulus * std::sqrt(1.0 + m * test.confining_pressure / uniaxial) : tension);
    default:
      return std::nullopt;
    }
}

double expected_last_strain(const double strain_at_peak, const TestParameters& tests)
{
  const double by_ratio = tests.stop_strain_over_peak_strain * strain_at_peak;
  if (!tests.stop_strain)
    return by_ratio;
  return tests.stop_stress_over_peak ? std::min(*tests.stop_strain, by_ratio) : *tests.stop_strain;
}
} // namespace feldspar
