#include "results/evaluation.h"

#include "results/paired_moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace feldspar
{
namespace
{
constexpr const char* of_stages = "the curve goes back and forth; each stage has a slope of its own";

Figure known(const double value)
{
  if (std::isfinite(value))
    return {value, ""};
  return {std::nullopt, "too few grains lie in the strain gauge"};
}

Figure unknown(std::string reason) { return {std::nullopt, std::move(reason)}; }

/// Figures of tests that went past their peak.
constexpr Figure TestResults::*figures_of_a_peak[] = {&TestResults::peak_stress,
                                                      &TestResults::strain_at_peak,
                                                      &TestResults::youngs_modulus_initial,
                                                      &TestResults::youngs_modulus_tangent,
                                                      &TestResults::youngs_modulus_secant,
                                                      &TestResults::poissons_ratio_initial,
                                                      &TestResults::poissons_ratio_secant,
                                                      &TestResults::crack_initiation_stress,
                                                      &TestResults::crack_initiation_stress_lateral,
                                                      &TestResults::crack_damage_stress,
                                                      &TestResults::post_peak_drop,
                                                      &TestResults::residual_deviator_ratio,
                                                      &TestResults::n_tension_cracks_at_peak,
                                                      &TestResults::n_shear_cracks_at_peak,
                                                      &TestResults::shear_share_at_peak,
                                                      &TestResults::n_smooth_tension_cracks_at_peak,
                                                      &TestResults::n_smooth_shear_cracks_at_peak,
                                                      &TestResults::smooth_tension_share_at_peak,
                                                      &TestResults::kinetic_to_strain_energy,
                                                      &TestResults::end_stress_difference,
                                                      &TestResults::unbalanced_force_ratio,
                                                      &TestResults::p_wave_transits_to_peak,
                                                      &TestResults::servo_error,
                                                      &TestResults::servo_error_largest,
                                                      &TestResults::fracture_toughness,
                                                      &TestResults::fracture_energy,
                                                      &TestResults::normal_stress_at_peak,
                                                      &TestResults::dilation_angle,
                                                      &TestResults::first_cracks_at_pads_share};

/// The rising branch of a curve, positive in the sense of the test.
class RisingBranch
{
public:
  RisingBranch(const TestRecord& record, const std::size_t peak)
    : kind(record.kind)
    , pressure(record.confining_pressure)
    , rows(record.curve.data(), peak + 1)
    , peak_deviator(deviator(rows.back()))
  {
  }

  double stress(const CurveSample& row) const { return kind.stress(row); }
  double deviator(const CurveSample& row) const { return kind.deviator(row, pressure); }

  /// First row whose deviator reaches this share of the peak's.
  std::size_t row_at(const double share) const
  {
    std::size_t k = 0;
    while (deviator(rows[k]) < share * peak_deviator)
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
    return known(paired_moments(x, y).slope());
  }

  /// A value at a share of the peak, linear between the rows.
  template <typename Value>
  double at_share(const double share, Value&& value_of) const
  {
    const std::size_t k = row_at(share);
    if (k == 0)
      return value_of(rows[0]);
    const double s0 = deviator(rows[k - 1]);
    const double s1 = deviator(rows[k]);
    const double weight = (share * peak_deviator - s0) / (s1 - s0);
    return (1.0 - weight) * value_of(rows[k - 1]) + weight * value_of(rows[k]);
  }

  /// Calls visit(row) from 5 % of the peak to the peak, where shares of the stress mean something.
  template <typename Visitor>
  void loaded_rows(Visitor&& visit) const
  {
    for (std::size_t k = row_at(0.05); k < rows.size(); ++k)
      if (!kind.follows_stages || deviator(rows[k]) >= 0.05 * peak_deviator) // it may unload in between
        visit(rows[k]);
  }

  TestKind kind;
  double pressure;
  std::span<const CurveSample> rows;
  double peak_deviator;
};

std::uint64_t n_cracks(const CurveSample& row) { return row.n_tension_cracks + row.n_shear_cracks; }

Figure crack_initiation(const TestRecord& record, const RisingBranch& branch)
{
  const auto row = crack_initiation_row(record, branch.rows.size() - 1);
  return row ? known(branch.stress(branch.rows[*row])) : unknown("no crack before the peak");
}

/// Where the volume is smallest, if it grows again before the peak.
std::optional<std::size_t> most_contracted_row(const RisingBranch& branch)
{
  const auto row =
    std::min_element(branch.rows.begin(), branch.rows.end(), [](const CurveSample& a, const CurveSample& b) {
      return a.gauge_volumetric_strain < b.gauge_volumetric_strain;
    });
  if (row == branch.rows.begin() || row + 1 == branch.rows.end())
    return std::nullopt;
  return std::size_t(row - branch.rows.begin());
}

/// In which the volume shrinks until cracks open.
bool is_uniform_compression(const TestKind& kind) { return kind.sign < 0.0 && kind.has_uniform_stress; }

/// Where volumetric strain, contracting at first, turns round.
Figure crack_damage(const TestRecord& record, const RisingBranch& branch)
{
  if (!is_uniform_compression(record.kind))
    return unknown("of uniaxial and triaxial compression only");
  if (const auto row = most_contracted_row(branch))
    return known(branch.stress(branch.rows[*row]));
  return unknown(branch.rows.back().gauge_volumetric_strain < 0.0
                   ? "volumetric strain did not turn round before the peak"
                   : "the volume never contracted");
}

/// Lateral strain response: the stress at which the lateral expansion lies furthest below the straight line from the
/// start to crack damage, for there it begins to grow faster. Needs no crack to be counted.
Figure crack_initiation_by_lateral_strain(const TestRecord& record, const RisingBranch& branch)
{
  if (!is_uniform_compression(record.kind))
    return unknown("of uniaxial and triaxial compression only");
  const auto damage = most_contracted_row(branch);
  if (!damage)
    return unknown("needs the crack damage stress");
  const auto expansion = [](const CurveSample& row) { return row.gauge_lateral_strain; };
  const CurveSample& first = branch.rows.front();
  const CurveSample& last = branch.rows[*damage];
  if (!(branch.stress(last) > branch.stress(first)))
    return unknown("no load before the crack damage stress");
  const double slope = (expansion(last) - expansion(first)) / (branch.stress(last) - branch.stress(first));
  double furthest = 0.0;
  std::size_t at = 0;
  for (std::size_t k = 0; k <= *damage; ++k)
    {
      const double on_line = expansion(first) + slope * (branch.stress(branch.rows[k]) - branch.stress(first));
      if (const double distance = on_line - expansion(branch.rows[k]); distance > furthest)
        {
          furthest = distance;
          at = k;
        }
    }
  if (at == 0)
    return unknown("lateral strain never lags behind a straight line");
  return known(branch.stress(branch.rows[at]));
}

constexpr const char* without_time = "equilibrium is sought without time";

/// Moduli and Poisson's ratios, of tests whose stress is uniform.
void evaluate_elasticity(const TestRecord& record, const RisingBranch& branch, TestResults& results)
{
  if (!record.kind.has_uniform_stress)
    {
      const Figure none = unknown(record.kind.follows_stages ? of_stages : "the stress in this test is not uniform");
      results.youngs_modulus_initial = results.youngs_modulus_tangent = results.youngs_modulus_secant = none;
      results.poissons_ratio_initial = results.poissons_ratio_secant = results.p_wave_transits_to_peak = none;
      return;
    }
  const double sign = record.kind.sign;
  const auto stress = [&](const CurveSample& row) { return branch.stress(row); };
  const auto strain = [&](const CurveSample& row) { return record.kind.strain(row); };
  const auto gauge_axial = [sign](const CurveSample& row) { return sign * row.gauge_axial_strain; };
  const auto expansion = [sign](const CurveSample& row) { return -sign * row.gauge_lateral_strain; };
  results.youngs_modulus_initial = branch.slope_between(0.05, 0.20, gauge_axial, stress);
  results.youngs_modulus_tangent = branch.slope_between(0.40, 0.60, strain, stress);
  results.youngs_modulus_secant = known(0.5 * branch.peak_deviator / branch.at_share(0.5, strain));
  results.poissons_ratio_initial = branch.slope_between(0.05, 0.20, gauge_axial, expansion);
  results.poissons_ratio_secant = known(branch.at_share(0.5, expansion) / branch.at_share(0.5, gauge_axial));

  results.p_wave_transits_to_peak =
    unknown(record.body == TestBody::finite_elements ? without_time
                                                     : "the wave speed needs the initial modulus and Poisson's ratio");
  if (record.body == TestBody::grains && results.youngs_modulus_initial.value && results.poissons_ratio_initial.value)
    {
      const double nu = *results.poissons_ratio_initial.value;
      const double modulus = *results.youngs_modulus_initial.value;
      // Of a thin plate in the plane, of the bulk in space.
      const double stiffness =
        record.dimension() == 2 ? modulus / (1.0 - nu * nu) : modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
      const double wave_speed = std::sqrt(stiffness / record.bulk_density);
      results.p_wave_transits_to_peak =
        known(branch.rows.back().time * wave_speed / record.size[std::size_t(record.dimension()) - 1]);
    }
}

/// How near the test was to being quasi-static, and how well the confinement was held.
void evaluate_trust(const TestRecord& record, const RisingBranch& branch, TestResults& results)
{
  double kinetic = 0.0;
  double difference = 0.0;
  double unbalanced = 0.0;
  double n_rows = 0.0;
  branch.loaded_rows([&](const CurveSample& row) {
    kinetic = std::max(kinetic, row.energies.kinetic / row.energies.strain);
    difference = std::max(difference, std::abs(row.end_stress_difference) / branch.peak_deviator);
    unbalanced += row.unbalanced_force_ratio;
    ++n_rows;
  });
  results.kinetic_to_strain_energy = record.body == TestBody::grains ? known(kinetic) : unknown(without_time);
  results.end_stress_difference = known(difference);
  results.unbalanced_force_ratio = record.body == TestBody::grains
                                     ? known(unbalanced / n_rows)
                                     : unknown("Newton's method holds it at Sample/Newton tolerance");

  results.servo_error = results.servo_error_largest = unknown("the test has no servo");
  if (record.kind.follows_stages)
    results.servo_error = results.servo_error_largest = unknown("the confinement follows stages");
  else if (record.normal_stiffness)
    results.servo_error = results.servo_error_largest = unknown("the normal stress follows the opening");
  else if (record.has_servo)
    {
      double sum = 0.0;
      double largest = 0.0;
      for (const auto& row : branch.rows)
        {
          const double error = std::abs(-row.lateral_stress / record.confining_pressure - 1.0);
          sum += error;
          largest = std::max(largest, error);
        }
      results.servo_error = known(sum / double(branch.rows.size()));
      results.servo_error_largest = known(largest);
    }
}

/// K_IC from the peak; the fracture energy from the work that the load did until it had fallen, over the ligament (RILEM
/// 50-FMC 1985, the weight of the body left out).
void evaluate_toughness(const TestRecord& record, const RisingBranch& branch, TestResults& results)
{
  if (!record.notch)
    {
      results.fracture_toughness = results.fracture_energy = unknown("the test has no notch");
      return;
    }
  results.fracture_toughness =
    record.notch->is_valid
      ? known(record.notch->intensity_over_stress * branch.stress(branch.rows.back()))
      : unknown(
          "the body lies outside of the range of the formula: a half disc has a toughness with Tests/Notch ratio from "
          "0.4 to 0.6, a plate that is 1.2 times as long between its grips as it is wide");
  constexpr double small_rest = 0.1; // of the peak: what is left of the work then is less than a hundredth
  double work = 0.0;
  const auto& curve = record.curve;
  for (std::size_t k = 1; k < curve.size(); ++k)
    {
      work += record.notch->work_over_stress * 0.5 * (branch.stress(curve[k]) + branch.stress(curve[k - 1])) *
              (record.kind.strain(curve[k]) - record.kind.strain(curve[k - 1]));
      if (k >= branch.rows.size() && branch.stress(curve[k]) < small_rest * branch.stress(branch.rows.back()))
        {
          results.fracture_energy = known(work / record.notch->ligament_area);
          return;
        }
    }
  results.fracture_energy =
    unknown("the load did not fall to a tenth of its peak; Tests/Stop stress over peak = 0.05 lets it");
}

/// The way of the platen that holds the normal stress is what the work of the walls is more than that of the shear stress:
/// dW = A (τ du - σ_n dv).
void evaluate_shear(const TestRecord& record, const RisingBranch& branch, TestResults& results)
{
  if (!record.kind.pressure_acts_across)
    {
      results.normal_stress_at_peak = results.dilation_angle = unknown("the test shears no plane");
      return;
    }
  const CurveSample& at_peak = branch.rows.back();
  results.normal_stress_at_peak = known(record.normal_stiffness ? -at_peak.lateral_stress : record.confining_pressure);
  const double width = record.size[0];
  const double area = width * (record.dimension() == 2 ? 1.0 : record.size[1]); // in the plane of a slice of 1 m
  const auto& curve = record.curve;
  std::vector<double> shear{0.0};
  std::vector<double> opening{0.0};
  std::size_t start = 0;
  while (mobilised(record, curve[start]) < share_of_strength * mobilised(record, at_peak))
    ++start;
  for (std::size_t k = start + 1; k < curve.size(); ++k)
    {
      if (-curve[k].lateral_stress < 0.5 * record.confining_pressure)
        {
          results.dilation_angle = unknown("the platen lost half of the normal stress after the peak");
          return;
        }
      const double du = width * (record.kind.strain(curve[k]) - record.kind.strain(curve[k - 1]));
      const double mean = 0.5 * (branch.stress(curve[k]) + branch.stress(curve[k - 1]));
      const double work = curve[k].energies.boundary_work - curve[k - 1].energies.boundary_work;
      shear.push_back(shear.back() + du);
      opening.push_back(opening.back() + (mean * du - work / area) / -curve[k].lateral_stress);
    }
  results.dilation_angle = shear.size() < 3 ? unknown("fewer than three rows of the curve from the strength to the end")
                                            : known(std::atan(paired_moments(shear, opening).slope()));
}

/// Where a disc that is to be split breaks first. Hondros' tension across the loaded diameter, of a disc loaded over 20° at
/// either end, is at least half of that in the middle up to 0.68 of the radius (docs/theory.md §4.4). Single grains at a pad
/// may crack before the disc does, so that the first third of the cracks up to the peak counts.
void evaluate_splitting(const TestRecord& record, const CurveSample& at_peak, TestResults& results)
{
  constexpr double middle_part = 0.68;
  constexpr std::ptrdiff_t share_of_first = 3;
  constexpr std::ptrdiff_t fewest = 8;                        // of a brittle disc some of them come after its peak
  if (record.kind.peak_rule != PeakRule::first_before_a_fall) // the rule of discs
    {
      results.first_cracks_at_pads_share = unknown("the test splits no disc");
      return;
    }
  const auto up_to_peak = std::count_if(record.cracks.begin(), record.cracks.end(),
                                        [&](const Crack& crack) { return crack.step <= at_peak.step; });
  const auto n = std::min(std::ptrdiff_t(record.cracks.size()), std::max(fewest, up_to_peak / share_of_first));
  if (n == 0)
    {
      results.first_cracks_at_pads_share = unknown("no crack");
      return;
    }
  const auto axis = std::size_t(record.dimension()) - 1;
  const double radius = 0.5 * record.size[axis];
  const auto n_at_pads = std::count_if(record.cracks.begin(), record.cracks.begin() + n, [&](const Crack& crack) {
    return std::abs(crack.centroid[axis] - radius) > middle_part * radius;
  });
  results.first_cracks_at_pads_share = known(double(n_at_pads) / double(n));
}

void evaluate_fragments(const TestRecord& record, TestResults& results)
{
  results.n_fragments = results.largest_fragment_share = unknown("there are no grains to be counted");
  if (!record.fragments)
    return;
  results.n_fragments = known(double(record.fragments->n));
  results.largest_fragment_share = known(record.fragments->largest_share);
}
} // namespace

std::optional<std::size_t> crack_initiation_row(const TestRecord& record, const std::size_t peak)
{
  const std::uint64_t at_peak = n_cracks(record.curve[peak]);
  if (at_peak == 0)
    return std::nullopt;
  std::size_t row = 0;
  while (double(n_cracks(record.curve[row])) < 0.01 * double(at_peak))
    ++row;
  return row;
}

/// Which part of the cracks at the peak is on smooth joints: in a grain-based model, on grain boundaries.
void evaluate_smooth_joints(const TestRecord& record, const CurveSample& at_peak, TestResults& results)
{
  if (record.specimen.n_smooth_joints == 0)
    {
      results.n_smooth_tension_cracks_at_peak = results.n_smooth_shear_cracks_at_peak =
        results.smooth_tension_share_at_peak = unknown("no smooth joints");
      return;
    }
  const auto n = [&](const CrackKind kind) {
    return double(std::count_if(record.cracks.begin(), record.cracks.end(), [&](const Crack& crack) {
      return crack.on_smooth_joint && crack.kind == kind && crack.step <= at_peak.step;
    }));
  };
  results.n_smooth_tension_cracks_at_peak = known(n(CrackKind::tension));
  results.n_smooth_shear_cracks_at_peak = known(n(CrackKind::shear));
  results.smooth_tension_share_at_peak = n_cracks(at_peak) > 0
                                           ? known(n(CrackKind::tension) / double(n_cracks(at_peak)))
                                           : unknown("no crack before the peak");
}

TestResults evaluate(const TestRecord& record)
{
  TestResults results;
  const auto& curve = record.curve;
  if (!curve.empty())
    {
      results.n_tension_cracks = curve.back().n_tension_cracks;
      results.n_shear_cracks = curve.back().n_shear_cracks;
      results.energy_imbalance = curve.back().energies.imbalance();
      results.energy_imbalance_over_work = curve.back().energies.imbalance_over_work();
    }
  evaluate_fragments(record, results);

  // What looks like a peak before the stop rule was met may not be one.
  const PeakVerdict verdict =
    record.interrupted
      ? PeakVerdict{std::nullopt, record.failure.empty() ? "interrupted before its end" : record.failure}
      : find_peak(record);
  const std::optional<std::size_t> peak = verdict.row;
  if (!peak)
    {
      const Figure none = unknown(verdict.reason);
      for (const auto member : figures_of_a_peak)
        results.*member = none;
      return results;
    }

  const RisingBranch branch(record, *peak);
  const CurveSample& at_peak = curve[*peak];
  results.peak_stress = known(branch.stress(at_peak));
  results.strain_at_peak = known(record.kind.strain(at_peak));
  results.crack_initiation_stress = crack_initiation(record, branch);
  results.crack_initiation_stress_lateral = crack_initiation_by_lateral_strain(record, branch);
  results.crack_damage_stress = crack_damage(record, branch);
  results.post_peak_drop = known(1.0 - branch.stress(curve.back()) / branch.stress(at_peak));
  results.residual_deviator_ratio = known(branch.deviator(curve.back()) / branch.peak_deviator);
  results.n_tension_cracks_at_peak = known(double(at_peak.n_tension_cracks));
  results.n_shear_cracks_at_peak = known(double(at_peak.n_shear_cracks));
  results.shear_share_at_peak = n_cracks(at_peak) > 0
                                  ? known(double(at_peak.n_shear_cracks) / double(n_cracks(at_peak)))
                                  : unknown("no crack before the peak");
  if (record.kind.follows_stages)
    for (const auto member :
         {&TestResults::crack_initiation_stress, &TestResults::crack_initiation_stress_lateral,
          &TestResults::crack_damage_stress, &TestResults::post_peak_drop, &TestResults::residual_deviator_ratio})
      results.*member = unknown(of_stages);
  if (record.kind.peak_rule == PeakRule::first_before_a_fall)
    results.post_peak_drop = results.residual_deviator_ratio =
      unknown("the strength is the stress before the first fall, and what is left of the body may bear more");
  evaluate_smooth_joints(record, at_peak, results);
  evaluate_elasticity(record, branch, results);
  evaluate_trust(record, branch, results);
  evaluate_toughness(record, branch, results);
  evaluate_shear(record, branch, results);
  evaluate_splitting(record, at_peak, results);
  return results;
}
} // namespace feldspar
