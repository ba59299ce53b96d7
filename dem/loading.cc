#include "dem/loading.h"

#include "dem/flat_joint_law.h"
#include "dem/fragments.h"
#include "dem/strain_gauge.h"

#include <chrono>
#include <cmath>

namespace feldspar
{
namespace
{
template <int dim>
std::array<double, 3> in_space(const Vector<dim>& vector)
{
  std::array<double, 3> point{};
  for (int c = 0; c < dim; ++c)
    point[c] = vector[c];
  return point;
}

template <int dim>
Crack crack(const Dynamics<dim>& dynamics, const Break& event, const double axial_strain)
{
  const auto& joints = dynamics.specimen().joints;
  const Vector<dim> normal = at<dim>(joints.normal, event.joint);
  const double arm = 0.5 * (joints.rest_distance[event.joint] + joints.opening[event.joint]) +
                     joints.half_radius_difference[event.joint];
  const double rho = flat_joint::segment_offset(event.segment, joints.n_segments, joints.half_length[event.joint]);
  const Vector<dim> tangent(-normal[1], normal[0]);

  Crack result;
  result.kind = event.in_tension ? CrackKind::tension : CrackKind::shear;
  result.joint = joints.number[event.joint];
  result.segment = event.segment;
  result.step = dynamics.n_steps();
  result.axial_strain = axial_strain;
  result.centroid = in_space<dim>(at<dim>(dynamics.specimen().grains.position, joints.grain_1[event.joint]) +
                                  arm * normal + rho * tangent);
  result.normal = in_space<dim>(normal);
  result.size = 2.0 * joints.half_length[event.joint] / joints.n_segments;
  result.released_energy = event.released_energy;
  return result;
}

/// Whether the curve has come to its end; docs/theory.md §4.3.
class StopRule
{
public:
  StopRule(const TestParameters& parameters, const double laboratory_sign)
    : wanted(parameters)
    , sign(laboratory_sign)
  {
  }

  bool reached(const CurveSample& sample)
  {
    const double strain = sign * sample.axial_strain;
    const double stress = sign * sample.axial_stress;
    if (stress > peak_stress)
      {
        peak_stress = stress;
        strain_at_peak = strain;
      }
    if (wanted.stop_strain)
      return strain >= *wanted.stop_strain;
    // Waves ripple the first rows; a peak without a crack is not the rock's.
    if (sample.n_tension_cracks + sample.n_shear_cracks == 0)
      return false;
    if (wanted.stop_stress_over_peak)
      return stress <= *wanted.stop_stress_over_peak * peak_stress;
    return strain >= wanted.stop_strain_over_peak_strain * strain_at_peak;
  }

private:
  const TestParameters& wanted;
  double sign;
  double peak_stress = 0.0;
  double strain_at_peak = 0.0;
};
} // namespace

template <int dim>
void start_steadily(Dynamics<dim>& dynamics, const double strain_rate)
{
  constexpr int axis = dim - 1;
  auto& grains = dynamics.specimen().grains;
  for (std::size_t i = 0; i < grains.size(); ++i)
    grains.velocity[axis][i] = strain_rate * (grains.position[axis][i] - 0.5 * dynamics.specimen().size[axis]);
}

template <int dim>
TestRecord load_until_stop(Dynamics<dim>& dynamics, const Loading<dim>& loading, const TestParameters& wanted,
                           const TestMonitor& monitor)
{
  const auto clock_at_start = std::chrono::steady_clock::now();
  const Specimen<dim>& specimen = dynamics.specimen();
  const StrainGauge<dim> gauge(specimen);
  const double height = specimen.size[dim - 1];
  const double area = specimen.volume() / height;

  TestRecord record;
  record.kind = loading.kind;
  record.seed = specimen.seed;
  record.strain_rate = std::abs(loading.strain_rate);
  record.size = in_space<dim>(specimen.size);
  record.specimen = specimen.report;
  record.bulk_density = specimen.bulk_density;

  std::uint64_t n_tension = 0;
  std::uint64_t n_shear = 0;
  const auto take_sample = [&] {
    CurveSample sample;
    sample.step = dynamics.n_steps();
    sample.time = dynamics.time();
    sample.axial_strain = loading.strain_rate * dynamics.time();
    const auto [lower, upper] = loading.end_forces(dynamics);
    sample.axial_stress = 0.5 * (lower + upper) / area;
    sample.end_stress_difference = (upper - lower) / area;
    sample.mid_stress = -dynamics.force_across(0.5 * height) / area; // pulled down from below: tension
    const Tensor<dim> gradient = gauge.displacement_gradient(specimen.grains);
    sample.gauge_axial_strain = gradient(dim - 1, dim - 1);
    sample.gauge_volumetric_strain = gradient.trace();
    sample.gauge_lateral_strain = (gradient.trace() - gradient(dim - 1, dim - 1)) / (dim - 1);
    sample.n_tension_cracks = n_tension;
    sample.n_shear_cracks = n_shear;
    sample.unbalanced_force_ratio = dynamics.unbalanced_force_ratio();
    sample.energies = dynamics.energies();
    return sample;
  };

  StopRule stop(wanted, laboratory_sign(loading.kind));
  record.curve.emplace_back(); // at rest, stress free
  for (std::uint64_t n_samples = 1;;)
    {
      const auto breaks = dynamics.step();
      const double strain = loading.strain_rate * dynamics.time();
      for (const auto& event : breaks)
        {
          record.cracks.push_back(crack(dynamics, event, strain));
          ++(event.in_tension ? n_tension : n_shear);
        }
      if (std::abs(strain) < double(n_samples) * loading.sampling_strain)
        continue;
      ++n_samples;
      record.curve.push_back(take_sample());
      if (stop.reached(record.curve.back()))
        break;
      if (!monitor(record.curve.back()))
        {
          record.interrupted = true;
          break;
        }
    }

  record.steps = dynamics.n_steps();
  record.time_step = dynamics.time_step();
  const auto fragment = fragments(specimen.joints, specimen.grains.size());
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    record.grains_at_end.push_back(
      {in_space<dim>(at<dim>(specimen.grains.position, i)), specimen.grains.radius[i], fragment[i]});
  record.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_at_start).count();
  return record;
}

template void start_steadily<2>(Dynamics<2>&, double);
template TestRecord load_until_stop<2>(Dynamics<2>&, const Loading<2>&, const TestParameters&, const TestMonitor&);
} // namespace feldspar
