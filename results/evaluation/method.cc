#include "base/mapped.h"
#include "laboratory/named_entries.h"
#include "results/evaluation/rising_branch.h"

#include <numeric>

/// Measures of how near the test was to being quasi-static, and how well the confinement was held.
namespace feldspar::evaluation
{
namespace
{
/// Reason why there is no servo error; null of a test with a servo.
const char* objection_to_servo(const TestRecord& record)
{
  if (record.kind.follows_stages)
    return "the confinement follows stages";
  if (record.normal_stiffness)
    return "the normal stress follows the opening";
  return record.has_servo && record.confining_pressure > 0.0 ? nullptr : "the test has no servo";
}

/// A figure of the servo's errors in the rows up to the peak.
template <typename Of>
Figure of_servo_errors(const RisingBranch& branch, const Of& of)
{
  if (const char* const reason = objection_to_servo(branch.record))
    return unknown(reason);
  return known(of(mapped<double>(branch.rows, [&](const CurveSample& row) {
    return std::abs(-row.lateral_stress / branch.record.confining_pressure - 1.0);
  })));
}

/// The largest value, not below 0, from 5 % of the peak to the peak.
template <typename Value>
double largest_loaded(const RisingBranch& branch, const Value& value)
{
  double largest = 0.0;
  branch.loaded_rows([&](const CurveSample& row) { largest = std::max(largest, value(row)); });
  return largest;
}
} // namespace

Figure kinetic_to_strain_energy(const RisingBranch& branch)
{
  return known(
    largest_loaded(branch, [](const CurveSample& row) { return row.energies.kinetic / row.energies.strain; }));
}

Figure unbalanced_force_ratio(const RisingBranch& branch)
{
  if (branch.record.body != TestBody::grains)
    return unknown("Newton's method holds it at " + input_entries::newton_tolerance.text());
  double sum = 0.0;
  double n_rows = 0.0;
  branch.loaded_rows([&](const CurveSample& row) {
    sum += row.unbalanced_force_ratio;
    ++n_rows;
  });
  return known(sum / n_rows);
}

Figure end_stress_difference(const RisingBranch& branch)
{
  return known(largest_loaded(
    branch, [&](const CurveSample& row) { return std::abs(row.end_stress_difference) / branch.peak_deviator; }));
}

Figure p_wave_transits_to_peak(const RisingBranch& branch)
{
  const TestRecord& record = branch.record;
  if (record.body == TestBody::finite_elements)
    return unknown(std::string(without_time));
  const Figure of_modulus = youngs_modulus_initial(branch);
  const Figure of_ratio = poissons_ratio_initial(branch);
  if (!of_modulus.value || !of_ratio.value)
    return unknown("the wave speed needs the initial modulus and Poisson's ratio");
  const double nu = *of_ratio.value;
  const double modulus = *of_modulus.value;
  // Stiffness of a thin plate in the plane, of the bulk in space.
  const double stiffness =
    record.dimension() == 2 ? modulus / (1.0 - nu * nu) : modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const double wave_speed = std::sqrt(stiffness / record.bulk_density);
  return known(branch.at_peak().time * wave_speed / record.size[std::size_t(record.dimension()) - 1]);
}

Figure stress_rate_error(const RisingBranch& branch)
{
  return known(largest_loaded(branch,
                              [&](const CurveSample& row) {
                                return std::abs(branch.deviator(row) - branch.record.stress_rate * row.time);
                              }) /
               branch.peak_deviator);
}

Figure servo_error(const RisingBranch& branch)
{
  return of_servo_errors(branch, [](const std::vector<double>& errors) {
    return std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
  });
}

Figure servo_error_largest(const RisingBranch& branch)
{
  return of_servo_errors(branch, [](const std::vector<double>& errors) {
    return std::accumulate(errors.begin(), errors.end(), 0.0,
                           [](const double largest, const double error) { return std::max(largest, error); });
  });
}
} // namespace feldspar::evaluation
