#include "dem/lab_results.h"

#include "dem/lab_tests.h"

#include <algorithm>
#include <cmath>
#include <span>
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
    }
  throw std::logic_error("a test kind without a name");
}

double laboratory_sign(const TestKind kind) { return kind == TestKind::direct_tension ? 1.0 : -1.0; }

double Energies::imbalance() const
{
  const double sum = boundary_work - kinetic - strain - slip - released - damping;
  const double terms = std::abs(boundary_work) + std::abs(kinetic) + std::abs(strain) + std::abs(slip) +
                       std::abs(released) + std::abs(damping);
  return terms > 0.0 ? std::abs(sum) / terms : 0.0;
}

namespace
{
/// Slope of y over x by least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y)
{
  const auto n = double(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
    {
      mean_x += x[k] / n;
      mean_y += y[k] / n;
    }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
    {
      xx += (x[k] - mean_x) * (x[k] - mean_x);
      xy += (x[k] - mean_x) * (y[k] - mean_y);
    }
  return xy / xx;
}

Figure known(const double value)
{
  if (std::isfinite(value))
    return {value, ""};
  return {std::nullopt, "too few grains lie in the strain gauge"};
}

Figure unknown(std::string reason) { return {std::nullopt, std::move(reason)}; }

/// The rising branch of a curve, positive in the sense of the test.
class RisingBranch
{
public:
  RisingBranch(const TestRecord& record, const std::size_t peak)
    : sign(laboratory_sign(record.kind))
    , rows(record.curve.data(), peak + 1)
    , peak_stress(stress(rows.back()))
  {
  }

  double stress(const CurveSample& row) const { return sign * row.axial_stress; }

  /// First row whose stress reaches this share of the peak.
  std::size_t row_at(const double share) const
  {
    std::size_t k = 0;
    while (stress(rows[k]) < share * peak_stress)
      ++k;
    return k;
  }

  /// Slope of y over x between two shares of the peak.
  template <typename X, typename Y>
  Figure slope_between(const double low, const double high, X&& x_of, Y&& y_of) const
  {
    const std::size_t begin = row_at(low);
    const std::size_t end = row_at(high);
    if (end < begin + 2)
      return unknown("fewer than three rows of the curve between these stresses: choose a smaller sampling strain");
    std::vector<double> x, y;
    for (std::size_t k = begin; k <= end; ++k)
      {
        x.push_back(x_of(rows[k]));
        y.push_back(y_of(rows[k]));
      }
    return known(slope(x, y));
  }

  /// A value at a share of the peak, linear between the rows.
  template <typename Value>
  double at_share(const double share, Value&& value_of) const
  {
    const std::size_t k = row_at(share);
    if (k == 0)
      return value_of(rows[0]);
    const double s0 = stress(rows[k - 1]);
    const double s1 = stress(rows[k]);
    const double weight = (share * peak_stress - s0) / (s1 - s0);
    return (1.0 - weight) * value_of(rows[k - 1]) + weight * value_of(rows[k]);
  }

  /// Calls visit(row) from 5 % of the peak to the peak, where shares of the stress mean something.
  template <typename Visitor>
  void loaded_rows(Visitor&& visit) const
  {
    for (std::size_t k = row_at(0.05); k < rows.size(); ++k)
      visit(rows[k]);
  }

  double sign;
  std::span<const CurveSample> rows;
  double peak_stress;
};

std::uint64_t n_cracks(const CurveSample& row) { return row.n_tension_cracks + row.n_shear_cracks; }

Figure crack_initiation(const RisingBranch& branch)
{
  const std::uint64_t at_peak = n_cracks(branch.rows.back());
  if (at_peak == 0)
    return unknown("no crack before the peak");
  for (const auto& row : branch.rows)
    if (double(n_cracks(row)) >= 0.01 * double(at_peak))
      return known(branch.stress(row));
  return unknown("no crack before the peak");
}

/// Where volumetric strain, contracting at first, turns round.
Figure crack_damage(const TestRecord& record, const RisingBranch& branch)
{
  if (record.kind == TestKind::direct_tension)
    return unknown("a specimen in tension does not contract first");
  const auto most_contracted =
    std::min_element(branch.rows.begin(), branch.rows.end(), [](const CurveSample& a, const CurveSample& b) {
      return a.gauge_volumetric_strain < b.gauge_volumetric_strain;
    });
  if (most_contracted + 1 == branch.rows.end())
    return unknown("volumetric strain did not turn round before the peak");
  return known(branch.stress(*most_contracted));
}
} // namespace

TestResults evaluate(const TestRecord& record)
{
  TestResults results;
  const double sign = laboratory_sign(record.kind);
  const auto& curve = record.curve;
  results.n_tension_cracks = curve.back().n_tension_cracks;
  results.n_shear_cracks = curve.back().n_shear_cracks;
  results.energy_imbalance = curve.back().energies.imbalance();

  const auto peak = std::size_t(std::max_element(curve.begin(), curve.end(),
                                                 [sign](const CurveSample& a, const CurveSample& b) {
                                                   return sign * a.axial_stress < sign * b.axial_stress;
                                                 }) -
                                curve.begin());
  if (peak + 1 == curve.size() || peak == 0)
    {
      const Figure none = unknown(record.interrupted ? "interrupted before the peak" : "the stress never peaked");
      for (Figure* figure :
           {&results.peak_stress, &results.strain_at_peak, &results.youngs_modulus_initial,
            &results.youngs_modulus_tangent, &results.youngs_modulus_secant, &results.poissons_ratio_initial,
            &results.poissons_ratio_secant, &results.crack_initiation_stress, &results.crack_damage_stress,
            &results.post_peak_drop, &results.n_tension_cracks_at_peak, &results.n_shear_cracks_at_peak,
            &results.kinetic_to_strain_energy, &results.end_stress_difference, &results.unbalanced_force_ratio,
            &results.p_wave_transits_to_peak})
        *figure = none;
      return results;
    }

  const RisingBranch branch(record, peak);
  const auto stress = [sign](const CurveSample& row) { return sign * row.axial_stress; };
  const auto strain = [sign](const CurveSample& row) { return sign * row.axial_strain; };
  const auto gauge_axial = [sign](const CurveSample& row) { return sign * row.gauge_axial_strain; };
  const auto lateral_expansion = [sign](const CurveSample& row) { return -sign * row.gauge_lateral_strain; };

  results.peak_stress = known(branch.peak_stress);
  results.strain_at_peak = known(strain(curve[peak]));
  results.youngs_modulus_initial = branch.slope_between(0.05, 0.20, gauge_axial, stress);
  results.youngs_modulus_tangent = branch.slope_between(0.40, 0.60, strain, stress);
  results.youngs_modulus_secant = known(0.5 * branch.peak_stress / branch.at_share(0.5, strain));
  results.poissons_ratio_initial = branch.slope_between(0.05, 0.20, gauge_axial, lateral_expansion);
  results.poissons_ratio_secant = known(branch.at_share(0.5, lateral_expansion) / branch.at_share(0.5, gauge_axial));
  results.crack_initiation_stress = crack_initiation(branch);
  results.crack_damage_stress = crack_damage(record, branch);
  results.post_peak_drop = known((branch.peak_stress - stress(curve.back())) / branch.peak_stress);
  results.n_tension_cracks_at_peak = known(double(curve[peak].n_tension_cracks));
  results.n_shear_cracks_at_peak = known(double(curve[peak].n_shear_cracks));

  double kinetic = 0.0;
  double difference = 0.0;
  double unbalanced = 0.0;
  double n_rows = 0.0;
  branch.loaded_rows([&](const CurveSample& row) {
    kinetic = std::max(kinetic, row.energies.kinetic / row.energies.strain);
    difference = std::max(difference, std::abs(row.end_stress_difference) / branch.peak_stress);
    unbalanced += row.unbalanced_force_ratio;
    ++n_rows;
  });
  results.kinetic_to_strain_energy = known(kinetic);
  results.end_stress_difference = known(difference);
  results.unbalanced_force_ratio = known(unbalanced / n_rows);
  if (results.youngs_modulus_initial.value && results.poissons_ratio_initial.value)
    {
      const double nu = *results.poissons_ratio_initial.value;
      const double wave_speed =
        std::sqrt(*results.youngs_modulus_initial.value / ((1.0 - nu * nu) * record.bulk_density));
      results.p_wave_transits_to_peak = known(curve[peak].time * wave_speed / record.size[1]);
    }
  else
    results.p_wave_transits_to_peak = unknown("the wave speed needs the initial modulus and Poisson's ratio");
  return results;
}
} // namespace feldspar
