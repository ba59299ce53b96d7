#pragma once

#include "base/parameter_id.h"
#include "base/random.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/joint_law.h"
#include "dem/specimen/neighbours.h"
#include "dem/specimen/specimen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

/// Installation of joints, written over the law; docs/theory.md §3. It reads from every law's parameters modulus,
/// stiffness_ratio, radius_multiplier, bond_friction_angle, installation_gap_ratio, coordination_number,
/// gapped_fraction, slit_fraction and initial_gap as FlatJointParameters has them; the law divides the faces and draws
/// the strengths.
namespace feldspar
{
namespace installation
{
inline constexpr double search_gap_ratio = 1.0; // largest gap that can get a joint, over the mean radius

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
std::vector<PairGap<dim>> pair_gaps(
  const Specimen<dim>& specimen, const double largest_gap, const std::function<void()>& check = [] {})
{
  const auto images = specimen.is_periodic() ? images_within(specimen.grains, specimen.cell(), largest_gap)
                                             : std::vector<PeriodicImage<dim>>();
  const std::size_t n_own = specimen.grains.size();
  const Grains<dim> grains = with_images(specimen.grains, images, specimen.cell());
  std::vector<PairGap<dim>> gaps;
  for (const auto& [first, second] : pairs_within(grains, largest_gap, check))
    {
      if (first >= n_own || (second >= n_own && !counts(first, images[second - n_own])))
        continue;
      const Vector<dim> branch = at<dim>(grains.position, second) - at<dim>(grains.position, first);
      gaps.push_back({branch.norm() - grains.radius[first] - grains.radius[second], first,
                      second < n_own ? PeriodicImage<dim>{second, {}} : images[second - n_own], branch});
    }
  check();
  std::ranges::sort(gaps, {}, [](const PairGap<dim>& one) { return std::tie(one.gap, one.first, one.second); });
  return gaps;
}

/// Number of pairs, sorted by gap, that get a joint. Bisection on the gap would find a gap below which exactly so many
/// pairs lie.
template <int dim, typename Parameters>
std::size_t n_joints_wanted(const std::vector<PairGap<dim>>& gaps, const Parameters& wanted, const std::size_t n_grains,
                            const double mean_radius)
{
  if (!wanted.coordination_number)
    return std::size_t(
      std::ranges::partition_point(
        gaps, [&](const PairGap<dim>& entry) { return entry.gap <= *wanted.installation_gap_ratio * mean_radius; }) -
      gaps.begin());
  const double z = *wanted.coordination_number;
  const auto n_overlapping = std::size_t(
    std::ranges::partition_point(gaps, [](const PairGap<dim>& entry) { return entry.gap <= 0.0; }) - gaps.begin());
  const auto n = std::size_t(std::llround(0.5 * z * double(n_grains)));
  if (n < n_overlapping || n > gaps.size())
    throw ParameterError(parameter_id<&Parameters::coordination_number, Parameters>(), fmt::format("{}", z),
                         fmt::format("this packing allows {:.2f} (pairs that touch) to {:.2f} (gaps up to "
                                     "the mean radius)",
                                     2.0 * double(n_overlapping) / double(n_grains),
                                     2.0 * double(gaps.size()) / double(n_grains)));
  return n;
}

/// The pairs, sorted by gap, that bonds name; of images of a grain the nearest.
template <int dim, typename Parameters>
std::vector<PairGap<dim>> bonded_pairs(const std::vector<PairGap<dim>>& gaps, const Parameters& wanted,
                                       const std::vector<GrainPair>& bonds)
{
  if (wanted.coordination_number)
    throw ParameterError(parameter_id<&Parameters::coordination_number, Parameters>(),
                         fmt::format("{}", *wanted.coordination_number),
                         "the bonds of the packing say already which grains are joined; leave it out");
  std::set<GrainPair> missing(bonds.begin(), bonds.end());
  std::vector<PairGap<dim>> pairs;
  for (const PairGap<dim>& entry : gaps)
    if (missing.erase(std::minmax(entry.first, entry.second.owner)) > 0)
      pairs.push_back(entry);
  return pairs;
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
  const double margin = specimen.is_periodic() ? -std::numeric_limits<double>::infinity() : 6.0 * report.mean_radius;
  double sum = 0.0;
  std::size_t n_core = 0;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const Vector<dim> x = at<dim>(grains.position, i);
      const bool inside = !specimen.is_round() || specimen.distance_from_axis(x) < 0.5 * specimen.size[0] - margin;
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
} // namespace installation

/// Joints of the law, stress free, between the grains of a specimen that has none; fills in its report. The law itself
/// is not put into the specimen. `listed`: exactly these pairs get one; empty: those that come near enough.
template <int dim, JointLaw<dim> Law>
void install_joints(
  Specimen<dim>& specimen, const Law& law, const typename Law::Parameters& wanted,
  const std::vector<GrainPair>& listed = {}, const std::function<void()>& check = [] {})
{
  using namespace installation;
  const auto& grains = specimen.grains;
  const double mean_radius = grains.mean_radius();
  const double search_gap = std::max(search_gap_ratio, wanted.installation_gap_ratio.value_or(0.0)) * mean_radius;
  const auto gaps = pair_gaps(specimen, search_gap * (1.0 + 1e-12), check);
  std::vector<PairGap<dim>> pairs =
    listed.empty()
      ? std::vector(gaps.begin(),
                    gaps.begin() + std::ptrdiff_t(n_joints_wanted(gaps, wanted, grains.size(), mean_radius)))
      : bonded_pairs(gaps, wanted, listed);
  const std::size_t n = pairs.size();
  specimen.report.installation_gap_ratio = listed.empty() && !wanted.coordination_number
                                             ? *wanted.installation_gap_ratio
                                           : n > 0 ? pairs.back().gap / mean_radius
                                                   : 0.0;

  std::ranges::sort(pairs, {}, [](const PairGap<dim>& one) { return std::tie(one.first, one.second); });

  check();
  auto& joints = specimen.joints;
  joints.divide(law.division(wanted), Law::n_more);
  joints.thickness = specimen.thickness;
  joints.friction = Law::friction(wanted, specimen.particle_contact);
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

  // Slit and gapped joints are drawn from all at random.
  std::vector<std::size_t> lot(n);
  std::iota(lot.begin(), lot.end(), std::size_t(0));
  Random(specimen.seed, RandomStream::bonds).shuffle(lot);
  const auto n_gapped = std::size_t(std::llround(wanted.gapped_fraction * double(n)));
  const auto n_slit = std::min(n - n_gapped, std::size_t(std::llround(wanted.slit_fraction * double(n))));
  std::ranges::fill(joints.bonded, 1.0);
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
    {
      const std::vector<Bond<double>> bonds = law.draw_bonds(wanted, joints.n_segments, random);
      for (unsigned int i = 0; i < joints.n_segments; ++i)
        {
          joints.tensile_strength[joints.segment(i, j)] = bonds[i].tensile_strength;
          joints.cohesion[joints.segment(i, j)] = bonds[i].cohesion;
        }
    }
  fill_report(specimen, gaps);
}
} // namespace feldspar
