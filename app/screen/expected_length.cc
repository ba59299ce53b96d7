#include "app/screen/expected_length.h"

#include "app/input/joint_sections.h"
#include "app/screen/stage_length.h"
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

/// Strain beyond that at the peak, over it and over the share of the stress that was lost on the way: tests of the nine of that
/// example lose a tenth within 0.03 to 0.26, and where they lose half of it do so within 0.05 to 0.45.
constexpr double strain_of_fall = 1.2;

// Time of a sample's steps by their strain, from examples/multiscale-and-grains/sample.prm and
// examples/multiscale-beishan-cylinder. With them the time left of four samples of the former was 0.3 to 2.5 times the true one
// over the middle of their runs; before the strain at their peak is known it cannot be told more exactly.
constexpr double growth_of_sample = 3.0;
constexpr double compression_over_tension = 20.0; // a step
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
  if (!tests.stop_stress_over_peak)
    return tests.stop_strain.value_or(tests.stop_strain_over_peak_strain * strain_at_peak);
  const double fallen = (1.0 + strain_of_fall * (1.0 - *tests.stop_stress_over_peak)) * strain_at_peak;
  return tests.stop_strain ? std::min(*tests.stop_strain, fallen) : fallen;
}

double expected_last_strain(const TestCase& test, const Input& input)
{
  return test.kind.follows_stages
           ? StageLength(input.tests, expected_modulus(input)).left()
           : expected_last_strain(expected_strain_at_peak(test, input).value_or(0.0), input.tests);
}

double TestCost::share(const double strain, const double last_strain) const
{
  return std::pow(std::clamp(strain / last_strain, 0.0, 1.0), growth);
}

TestCost cost_of_specimen(const std::size_t n_grains, const double strain_rate)
{
  return {double(n_grains) / strain_rate};
}

TestCost cost_of_sample(const TestKind& kind, const SampleParameters& sample)
{
  return {kind.sign > 0.0 ? 1.0 / sample.tension_step : compression_over_tension / sample.compression_step,
          growth_of_sample};
}
} // namespace feldspar
