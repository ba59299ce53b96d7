#include "dem/genesis/genesis.h"

#include "base/input_error.h"
#include "base/random.h"
#include "dem/dynamics/dynamics.h"
#include "dem/genesis/packing_file.h"
#include "dem/specimen/neighbours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace feldspar
{
namespace
{
constexpr double stress_tolerance = 0.01;      // of the packing stress
constexpr double equilibrium_tolerance = 1e-3; // mean unbalanced over mean contact force
constexpr double search_gap_ratio = 1.0;       // largest gap that can get a joint, over the mean radius

/// Uniform radii, as many as fill the solid share of the volume best.
template <int dim>
std::vector<double> draw_radii(const SpecimenParameters& wanted, const double volume, const double thickness,
                               const std::uint64_t seed)
{
  Random random(seed, RandomStream::radii);
  const double solid = (1.0 - wanted.porosity) * volume;
  std::vector<double> radii;
  for (double filled = 0.0;;)
    {
      const double radius = wanted.minimum_radius * random.uniform(1.0, wanted.radius_ratio);
      const double more = grain_volume<dim>(radius, thickness);
      if (std::abs(filled + more - solid) > std::abs(filled - solid))
        return radii;
      radii.push_back(radius);
      filled += more;
    }
}

template <int dim>
void scale_radii(Dynamics<dim>& dynamics, const double factor)
{
  for (double& radius : dynamics.specimen().grains.radius)
    radius *= factor;
  dynamics.restart();
}

/// Runs until the forces balance; the share of the mean contact force that does not.
template <int dim>
double relax(Dynamics<dim>& dynamics, const double tolerance, const unsigned int most_steps,
             const std::function<void()>& check)
{
  constexpr unsigned int steps_between_looks = 50;
  double ratio = 1.0;
  for (unsigned int n = 0; n < most_steps && ratio > tolerance; n += steps_between_looks)
    {
      for (unsigned int k = 0; k < steps_between_looks; ++k)
        {
          check();
          dynamics.step();
        }
      ratio = dynamics.unbalanced_force_ratio();
    }
  return ratio;
}

/// Grains thrown in at random, let calm down without friction, then scaled until the mean stress is reached.
template <int dim>
void pack(Specimen<dim>& specimen, const SpecimenParameters& wanted, const GenesisMonitor& monitor,
          const std::function<void()>& check)
{
  const auto radii = draw_radii<dim>(wanted, specimen.volume(), specimen.thickness, specimen.seed);
  if (radii.size() < 2)
    throw InputError(fmt::format("Specimen: {} grain(s) fill a {} of {} m × {} m; make it larger or the grains smaller",
                                 radii.size(), specimen.round ? "cylinder" : "box", wanted.width, wanted.height));
  Random random(specimen.seed, RandomStream::positions);
  Components<dim> positions;
  for (const double radius : radii)
    {
      const double margin = specimen.periodic ? 0.0 : radius;
      Vector<dim> position;
      do
        for (int c = 0; c < dim; ++c)
          position[c] = random.uniform(margin, specimen.size[c] - margin);
      while (specimen.round && specimen.distance_from_axis(position) > 0.5 * specimen.size[0] - radius);
      for (int c = 0; c < dim; ++c)
        positions[c].push_back(position[c]);
    }

  Specimen<dim> loose = specimen;
  loose.particle_contact.friction = 0.0;
  loose.grains.place(radii, positions);
  loose.grains.set_density(wanted.bulk_density / (1.0 - wanted.porosity), loose.thickness);
  Dynamics<dim> dynamics(std::move(loose), DynamicsParameters{}, ZeroForce::at_touch);
  for (int axis = specimen.round ? dim - 1 : 0; axis < dim && !specimen.periodic; ++axis)
    {
      dynamics.add_wall({axis, 1.0, 0.0, 0.0});
      dynamics.add_wall({axis, -1.0, dynamics.specimen().size[axis], 0.0});
    }
  if (specimen.round)
    dynamics.add_wall(round_wall(specimen));

  // The first overlaps are as large as grains; let go, they would throw grains about: follow the forces step by step
  // without gathering speed.
  constexpr unsigned int n_creeps = 300;
  for (unsigned int k = 0; k < n_creeps; ++k)
    {
      check();
      dynamics.step();
      dynamics.specimen().grains.stop();
      dynamics.restart();
    }

  const double modulus = specimen.particle_contact.modulus;
  const double target = wanted.packing_stress_ratio * modulus;
  constexpr unsigned int most_scalings = 300;
  double multiplier = 1.0;
  for (unsigned int k = 0;; ++k)
    {
      const double ratio = relax(dynamics, equilibrium_tolerance, 4000, check);
      const double stress = -dynamics.mean_stress().trace() / dim;
      const double error = stress / target - 1.0;
      monitor("packing", std::exp(-3.0 * std::max(0.0, std::abs(error) - stress_tolerance)));
      if (std::abs(error) <= stress_tolerance && ratio <= equilibrium_tolerance)
        {
          specimen.report.packing_stress = stress;
          break;
        }
      if (k == most_scalings)
        throw InputError(fmt::format("Specimen: no packing at a mean stress of {:.3g} Pa within {} scalings (reached "
                                     "{:.3g} Pa); another Porosity, Packing stress ratio or seed may do",
                                     target, most_scalings, stress));
      if (std::abs(error) <= stress_tolerance)
        continue; // only time is missing
      // Near jamming the stress of a packing rises by about its contact modulus per unit of relative radius; one that
      // does not touch yet grows faster.
      const double growth = stress < 0.05 * target ? std::max(5e-4, 2.0 * wanted.packing_stress_ratio)
                                                   : std::clamp((target - stress) / modulus, -5e-3, 5e-3);
      scale_radii(dynamics, 1.0 + growth);
      multiplier *= 1.0 + growth;
    }
  specimen.report.radius_multiplier = multiplier;
  const auto& packed = dynamics.specimen().grains;
  const auto own = std::ptrdiff_t(radii.size());
  Components<dim> final_positions;
  for (int c = 0; c < dim; ++c)
    {
      final_positions[c].assign(packed.position[c].begin(), packed.position[c].begin() + own);
      if (specimen.periodic)
        for (double& x : final_positions[c])
          x -= specimen.size[c] * std::floor(x / specimen.size[c]);
    }
  specimen.grains.place({packed.radius.begin(), packed.radius.begin() + own}, final_positions);
}

template <int dim>
void sort_in_space(Grains<dim>& grains)
{
  std::vector<double> radii;
  Components<dim> positions;
  for (const std::uint32_t i : spatial_order(grains))
    {
      radii.push_back(grains.radius[i]);
      for (int c = 0; c < dim; ++c)
        positions[c].push_back(grains.position[c][i]);
    }
  grains.place(radii, positions);
}

/// Two grains, the second perhaps in another box of a periodic body.
template <int dim>
struct PairGap
{
  double gap;
  std::uint32_t first;
  PeriodicImage<dim> second;
  Vector<dim> branch; ///< from centre to centre [m]
};

/// All pairs that could get a joint, by gap.
template <int dim>
std::vector<PairGap<dim>> pair_gaps(const Specimen<dim>& specimen, const double largest_gap)
{
  const auto images = specimen.periodic ? images_within(specimen.grains, specimen.cell(), largest_gap)
                                        : std::vector<PeriodicImage<dim>>();
  const std::size_t n_own = specimen.grains.size();
  const Grains<dim> grains = with_images(specimen.grains, images, specimen.cell());
  std::vector<PairGap<dim>> gaps;
  for (const auto& [first, second] : pairs_within(grains, largest_gap))
    {
      if (first >= n_own || (second >= n_own && !counts(first, images[second - n_own])))
        continue;
      const Vector<dim> branch = at<dim>(grains.position, second) - at<dim>(grains.position, first);
      gaps.push_back({branch.norm() - grains.radius[first] - grains.radius[second], first,
                      second < n_own ? PeriodicImage<dim>{second, {}} : images[second - n_own], branch});
    }
  std::sort(gaps.begin(), gaps.end(), [](const PairGap<dim>& a, const PairGap<dim>& b) {
    return std::tie(a.gap, a.first, a.second) < std::tie(b.gap, b.first, b.second);
  });
  return gaps;
}

/// How many of the pairs, sorted by gap, get a joint. A gap below which exactly so many lie is what bisection on the
/// gap would find.
template <int dim>
std::size_t n_joints_wanted(const std::vector<PairGap<dim>>& gaps, const FlatJointParameters& wanted,
                            const std::size_t n_grains, const double mean_radius)
{
  if (wanted.installation_gap_ratio)
    return std::size_t(std::partition_point(gaps.begin(), gaps.end(),
                                            [&](const PairGap<dim>& entry) {
                                              return entry.gap <= *wanted.installation_gap_ratio * mean_radius;
                                            }) -
                       gaps.begin());
  const double z = *wanted.coordination_number;
  const auto n_overlapping = std::size_t(
    std::partition_point(gaps.begin(), gaps.end(), [](const PairGap<dim>& entry) { return entry.gap <= 0.0; }) -
    gaps.begin());
  const auto n = std::size_t(std::llround(0.5 * z * double(n_grains)));
  if (n < n_overlapping || n > gaps.size())
    throw InputError(fmt::format(
      "Flat joint/Coordination number = {}: this packing allows {:.2f} (pairs that touch) to {:.2f} (gaps up to "
      "the mean radius)",
      z, 2.0 * double(n_overlapping) / double(n_grains), 2.0 * double(gaps.size()) / double(n_grains)));
  return n;
}

template <int dim>
void fill_report(Specimen<dim>& specimen, const std::vector<PairGap<dim>>& gaps)
{
  const auto& grains = specimen.grains;
  auto& report = specimen.report;
  report.n_grains = grains.size();
  report.n_joints = specimen.joints.size();
  report.mean_radius = grains.mean_radius();
  report.coordination_number = 2.0 * double(report.n_joints) / double(report.n_grains);
  report.porosity = 1.0 - grains.volume(specimen.thickness) / specimen.volume();
  report.resolution = specimen.size[0] / (2.0 * report.mean_radius);

  std::vector<unsigned int> n_joints(grains.size(), 0);
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    {
      ++n_joints[specimen.joints.grain_1[j]];
      ++n_joints[specimen.joints.grain_2[j]];
    }
  const double margin = specimen.periodic ? -std::numeric_limits<double>::infinity() : 6.0 * report.mean_radius;
  double sum = 0.0;
  std::size_t n_core = 0;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const Vector<dim> x = at<dim>(grains.position, i);
      const bool inside = !specimen.round || specimen.distance_from_axis(x) < 0.5 * specimen.size[0] - margin;
      if (inside && (x.array() > margin).all() && (x.array() < specimen.size.array() - margin).all())
        {
          sum += n_joints[i];
          ++n_core;
        }
    }
  report.coordination_number_core = n_core > 0 ? sum / double(n_core) : std::numeric_limits<double>::quiet_NaN();

  double overlap = 0.0;
  std::size_t n_overlapping = 0;
  for (const auto& pair : gaps)
    if (pair.gap < 0.0)
      {
        overlap -= pair.gap;
        ++n_overlapping;
      }
  report.mean_overlap_ratio = n_overlapping > 0 ? overlap / double(n_overlapping) / report.mean_radius : 0.0;
  report.largest_overlap_ratio = gaps.empty() ? 0.0 : std::max(0.0, -gaps.front().gap) / report.mean_radius;
}
} // namespace

template <int dim>
void install_joints(Specimen<dim>& specimen, const FlatJointParameters& wanted)
{
  const auto& grains = specimen.grains;
  const double mean_radius = grains.mean_radius();
  const double search_gap = std::max(search_gap_ratio, wanted.installation_gap_ratio.value_or(0.0)) * mean_radius;
  const auto gaps = pair_gaps(specimen, search_gap * (1.0 + 1e-12));
  const std::size_t n = n_joints_wanted(gaps, wanted, grains.size(), mean_radius);
  specimen.report.installation_gap_ratio = wanted.installation_gap_ratio ? *wanted.installation_gap_ratio
                                           : n > 0                       ? gaps[n - 1].gap / mean_radius
                                                                         : 0.0;

  std::vector<PairGap<dim>> pairs(gaps.begin(), gaps.begin() + std::ptrdiff_t(n));
  std::sort(pairs.begin(), pairs.end(), [](const PairGap<dim>& a, const PairGap<dim>& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });

  auto& joints = specimen.joints;
  joints.divide(face_division<dim>(wanted));
  joints.thickness = specimen.thickness;
  joints.friction = wanted.friction;
  joints.friction_slope = std::tan(wanted.bond_friction_angle);
  joints.resize_all(n);
  for (std::size_t j = 0; j < n; ++j)
    {
      const std::uint32_t one = pairs[j].first;
      const std::uint32_t two = pairs[j].second.owner;
      const double radius_1 = grains.radius[one];
      const double radius_2 = grains.radius[two];
      const Vector<dim>& branch = pairs[j].branch;
      joints.grain_1[j] = one;
      joints.grain_2[j] = two;
      joints.number[j] = std::uint32_t(j);
      joints.normal_stiffness[j] = stiffness_per_area(wanted.modulus, radius_1, radius_2);
      joints.shear_stiffness[j] = joints.normal_stiffness[j] / wanted.stiffness_ratio;
      joints.half_length[j] = face_half_length(wanted.radius_multiplier, radius_1, radius_2);
      joints.half_radius_difference[j] = 0.5 * (radius_1 - radius_2);
      joints.rest_distance[j] = branch.norm();
      for (int c = 0; c < dim; ++c)
        joints.normal[c][j] = branch[c] / joints.rest_distance[j];
      if constexpr (dim == 3)
        {
          const auto tangent = space::tangent_to({joints.normal[0][j], joints.normal[1][j], joints.normal[2][j]});
          for (int c = 0; c < 3; ++c)
            joints.tangent[c][j] = tangent[c];
        }
    }

  // Slit and gapped joints are drawn from all by lot.
  std::vector<std::size_t> lot(n);
  std::iota(lot.begin(), lot.end(), std::size_t(0));
  Random(specimen.seed, RandomStream::bonds).shuffle(lot);
  const auto n_gapped = std::size_t(std::llround(wanted.gapped_fraction * double(n)));
  const auto n_slit = std::min(n - n_gapped, std::size_t(std::llround(wanted.slit_fraction * double(n))));
  std::fill(joints.bonded.begin(), joints.bonded.end(), 1.0);
  for (std::size_t k = 0; k < n_gapped + n_slit; ++k)
    {
      for (unsigned int i = 0; i < joints.n_segments; ++i)
        joints.bonded[joints.segment(i, lot[k])] = 0.0;
      if (k < n_gapped)
        {
          joints.opening[lot[k]] = wanted.initial_gap;
          joints.rest_distance[lot[k]] -= wanted.initial_gap;
        }
    }

  Random random(specimen.seed, RandomStream::strengths);
  for (std::size_t j = 0; j < n; ++j)
    for (unsigned int i = 0; i < joints.n_segments; ++i)
      {
        const std::size_t k = joints.segment(i, j);
        if (i > 0 && wanted.strength_draw == StrengthDraw::per_contact)
          {
            joints.tensile_strength[k] = joints.tensile_strength[joints.segment(0, j)];
            joints.cohesion[k] = joints.cohesion[joints.segment(0, j)];
            continue;
          }
        joints.tensile_strength[k] =
          random.non_negative_normal(wanted.bond_tensile_strength, wanted.bond_tensile_strength_deviation);
        joints.cohesion[k] = random.non_negative_normal(wanted.bond_cohesion, wanted.bond_cohesion_deviation);
      }
  fill_report(specimen, gaps);
}

template <int dim>
Specimen<dim> make_specimen(const SpecimenParameters& wanted, const FlatJointParameters& flat_joint,
                            const ParticleContactParameters& particle_contact, const std::uint64_t seed,
                            const GenesisMonitor& monitor, const std::function<void()>& check)
{
  Specimen<dim> specimen;
  specimen.size.setConstant(wanted.width);
  specimen.size[dim - 1] = wanted.height;
  specimen.periodic = wanted.shape == "periodic";
  specimen.round = wanted.shape == "cylinder";
  specimen.bulk_density = wanted.bulk_density;
  specimen.seed = seed;
  specimen.particle_contact = particle_contact;
  if (wanted.packing_file.empty())
    pack(specimen, wanted, monitor, check);
  else
    specimen.grains = read_packing<dim>(wanted);
  sort_in_space(specimen.grains);
  const double porosity = 1.0 - specimen.grains.volume(specimen.thickness) / specimen.volume();
  specimen.grains.set_density(wanted.bulk_density / (1.0 - porosity), specimen.thickness);
  install_joints(specimen, flat_joint);
  return specimen;
}

template Specimen<2> make_specimen<2>(const SpecimenParameters&, const FlatJointParameters&,
                                      const ParticleContactParameters&, std::uint64_t, const GenesisMonitor&,
                                      const std::function<void()>&);
template Specimen<3> make_specimen<3>(const SpecimenParameters&, const FlatJointParameters&,
                                      const ParticleContactParameters&, std::uint64_t, const GenesisMonitor&,
                                      const std::function<void()>&);
template void install_joints<2>(Specimen<2>&, const FlatJointParameters&);
template void install_joints<3>(Specimen<3>&, const FlatJointParameters&);
} // namespace feldspar
