#include "app/screen/expected_length.h"

#include "app/input/joint_sections.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/compression.h"
#include "laboratory/loading_stages.h"

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

/// Strain at the peak over strength over modulus: curves of compression bend before it, by 1.1 to 1.35 in the ensemble of that
/// example; specimens of spheres strain more, by 1.35 to 1.45 (examples/beishan-cylinder).
constexpr double bend_in_compression = 1.25;
constexpr double more_in_space = 1.35;

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
  if (test.kind.tilts)
    return std::atan(input.tests.platen_friction);
  const double modulus = expected_modulus(input);
  const double bonds =
    std::visit([](const auto& law) { return std::max(law.bond_tensile_strength, 1e-3 * law.bond_cohesion); },
               joint_parameters(input));
  const double of_body = (input.specimen.dimension == 3 ? more_in_space : 1.0) / modulus;
  const double tension = tension_over_bonds * bonds * of_body;
  const double uniaxial = compression_over_bonds * bonds;
  const auto [with, factor] = protocol_of(test.kind).forecast;
  switch (with)
    {
    case PeakForecast::With::tension:
      return factor * tension;
    case PeakForecast::With::compression:
      return factor * (uniaxial > 0.0 ? bend_in_compression * uniaxial * of_body *
                                          std::sqrt(1.0 + m * test.confining_pressure / uniaxial)
                                      : tension);
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

StageLength::StageLength(const TestParameters& parameters, const double modulus_of_body)
  : stages(parameters.of<LoadingTable>().stages)
  , strain_rate(parameters.of<CompressionParameters>().strain_rate)
  , modulus(modulus_of_body)
  , walk(parameters)
{
  if (!stages.empty())
    now.axial_stress = stages.front().confining_pressure;
}

void StageLength::follow(const CurveSample& row)
{
  if (is_over || stages.empty())
    return;
  now = {row.time, -row.axial_strain, -row.axial_stress, -row.gauge_lateral_strain};
  rows.push_back(row);
  if (rows.size() > 1)
    is_over = walk.is_over(rows, now);
  else
    {
      time_at_start = row.time;
      walk.begin(now);
    }
}

double StageLength::gone() const { return strain_of(now.time - time_at_start); }

double StageLength::left() const
{
  if (is_over)
    return 0.0;
  const std::size_t n_begun = walk.records().size();
  StageMoment at = now;
  double time = n_begun > 0 && walk.stage().duration ? walk.start_of_stage().time - now.time : 0.0;
  for (std::size_t k = std::max<std::size_t>(n_begun, 1) - 1; k < stages.size(); ++k)
    time += way(stages[k], at);
  return strain_of(std::max(0.0, time));
}

double StageLength::way(const LoadingStage& stage, StageMoment& from) const
{
  constexpr double widening_over_shortening = 0.25; // of rock that carries load
  const double rate = stage.strain_rate.value_or(strain_rate);
  double strain = 0.0;
  double time = 0.0;
  if (stage.duration)
    time = *stage.duration;
  else if (stage.lateral_strain)
    {
      strain = std::max(0.0, from.lateral_strain - *stage.lateral_strain) / widening_over_shortening;
      time = strain * widening_over_shortening / rate;
    }
  else
    {
      strain = stage.axial_strain ? *stage.axial_strain - from.axial_strain
                                  : (*stage.axial_stress - from.axial_stress) / modulus;
      time = std::abs(strain) / rate;
    }
  from.axial_strain += strain;
  from.axial_stress = stage.axial_stress.value_or(std::max(0.0, from.axial_stress + strain * modulus));
  from.lateral_strain -= widening_over_shortening * strain;
  return time;
}
} // namespace feldspar
