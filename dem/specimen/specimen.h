#pragma once

#include "base/body.h"
#include "dem/laws/parameters.h"
#include "dem/specimen/neighbours.h"
#include "dem/specimen/parameters.h"
#include "dem/specimen/periodic_images.h"
#include "dem/storage/grains.h"
#include "dem/storage/joints.h"
#include "dem/storage/smooth_joints.h"
#include "laboratory/specimen_report.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace feldspar
{
/// A hole, slot or closed flaw as it lies in a specimen, for pictures, files and whoever loads it.
template <int dim>
struct Flaw
{
  std::string name;                 ///< as the input calls its kind: hole, slot, closed flaw, joint set
  bool open = false;                ///< grains were taken out; of a closed flaw the faces are still in contact
  std::vector<Vector<dim>> outline; ///< points of a line, of a hole closed; in space of its cut through the middle [m]
  std::uint64_t n_grains = 0;       ///< taken out
  std::uint64_t n_joints = 0;       ///< cut, or of a closed flaw unbonded
};

/// Grains and the joints between them, stress free and at rest, in the box [0, size].
template <int dim>
struct Specimen
{
  Vector<dim> size = Vector<dim>::Zero(); ///< width, (depth,) height [m]; the last axis is that of the tests
  BodyShape shape =
    BodyShape::box;          ///< of a cylinder the box is around it; in a periodic body a joint may lead to an image
  double thickness = 1.0;    ///< of the plane [m]
  double bulk_density = 0.0; ///< [kg/m³]
  std::uint64_t seed = 0;
  ParticleContactParameters particle_contact;
  Grains<dim> grains;
  Joints<dim> joints;
  std::vector<SmoothJoint<dim>> smooth_joints; ///< by their grains; where one stands no joint of the law does
  std::vector<GrainPair> kept_apart;           ///< ascending; on either side of a smooth plane, never in contact
  std::vector<MineralName> minerals;           ///< of the rock; empty: not told apart
  std::vector<std::uint32_t> mineral;          ///< of each grain, a number of `minerals`; or empty
  std::vector<std::uint32_t> groups;           ///< the mineral grain or clump that each grain is a part of; or empty
  bool groups_are_rigid = false;               ///< they are clumps: each moves as one body; numbered without gaps
  SpecimenReport report;
  std::vector<Flaw<dim>> flaws; ///< that have been put in

  /// Returns whether the specimen repeats itself along an axis; where it does not, the body has ends.
  bool repeats(const int axis) const
  {
    return shape == BodyShape::periodic || (shape == BodyShape::periodic_sideways && axis < dim - 1);
  }

  bool is_periodic() const { return feldspar::is_periodic(shape); }
  bool is_round() const { return shape == BodyShape::cylinder; }

  /// The edges of the cell as columns [m]: those of the box; along walled ends so long that no image comes near the body.
  Tensor<dim> cell() const
  {
    Tensor<dim> edges = size.asDiagonal();
    if (shape == BodyShape::periodic_sideways)
      edges(dim - 1, dim - 1) *= 4.0;
    return edges;
  }

  /// The grain, or image of a grain, that a joint leads to.
  PeriodicImage<dim> second_of(const std::size_t joint) const
  {
    // At rest the joint itself tells: its branch vector differs from that between its grains by whole edges.
    const Vector<dim> branch = (joints.rest_distance[joint] + joints.opening[joint]) * at<dim>(joints.normal, joint);
    const Vector<dim> between =
      at<dim>(grains.position, joints.grain_2[joint]) - at<dim>(grains.position, joints.grain_1[joint]);
    PeriodicImage<dim> image{joints.grain_2[joint], {}};
    if (is_periodic())
      for (int c = 0; c < dim; ++c)
        image.boxes[c] = int(std::lround((branch[c] - between[c]) / size[c]));
    return image;
  }

  std::size_t n_joints() const { return joints.size() + smooth_joints.size(); }

  /// Makes the numbers of joints places in lists: those of the law first.
  void number_joints()
  {
    std::iota(joints.number.begin(), joints.number.end(), 0u);
    auto next = std::uint32_t(joints.size());
    for (auto& joint : smooth_joints)
      joint.number = next++;
  }

  double volume() const
  {
    return size.prod() * (dim == 2 ? thickness : 1.0) * (is_round() ? 0.25 * std::numbers::pi : 1.0);
  }

  /// Distance of a point from the axis of the tests through the middle [m].
  double distance_from_axis(const Vector<dim>& point) const
  {
    return (point - 0.5 * size).template head<dim - 1>().norm();
  }
};

template <int dim>
std::vector<MineralShare> shares_of_minerals(const Specimen<dim>& specimen)
{
  std::vector<MineralShare> shares;
  for (const MineralName& mineral : specimen.minerals)
    shares.push_back({mineral});
  const double whole = specimen.grains.volume(specimen.thickness);
  for (std::size_t i = 0; i < specimen.mineral.size(); ++i)
    {
      MineralShare& of_its_kind = shares[specimen.mineral[i]];
      ++of_its_kind.n_grains;
      of_its_kind.share += grain_volume<dim>(specimen.grains.radius[i], specimen.thickness) / whole;
    }
  return shares;
}
} // namespace feldspar
