#include "laboratory/named_entries.h"
#include "results/evaluation/rising_branch.h"

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

double servo_error(const TestRecord& record, const CurveSample& row)
{
  return std::abs(-row.lateral_stress / record.confining_pressure - 1.0);
}
} // namespace

Figure kinetic_to_strain_energy(const RisingBranch& branch)
{
  double largest = 0.0;
  branch.loaded_rows(
    [&](const CurveSample& row) { largest = std::max(largest, row.energies.kinetic / row.energies.strain); });
  return known(largest);
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
  double largest = 0.0;
  branch.loaded_rows([&](const CurveSample& row) {
    largest = std::max(largest, std::abs(row.end_stress_difference) / branch.peak_deviator);
  });
  return known(largest);
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
  double largest = 0.0;
  branch.loaded_rows([&](const CurveSample& row) {
    largest = std::max(largest, std::abs(branch.deviator(row) - branch.record.stress_rate * row.time));
  });
  return known(largest / branch.peak_deviator);
}

Figure servo_error(const RisingBranch& branch)
{
  if (const char* const reason = objection_to_servo(branch.record))
    return unknown(reason);
  double sum = 0.0;
  for (const CurveSample& row : branch.rows)
    sum += servo_error(branch.record, row);
  return known(sum / double(branch.rows.size()));
}

Figure servo_error_largest(const RisingBranch& branch)
{
  if (const char* const reason = objection_to_servo(branch.record))
    return unknown(reason);
  double largest = 0.0;
  for (const CurveSample& row : branch.rows)
    largest = std::max(largest, servo_error(branch.record, row));
  return known(largest);
}
} // namespace feldspar::evaluation
