#include "coupling/network/link_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

namespace feldspar
{
namespace
{
constexpr double closure_width_ratio = 1e-6; // over the half length of the face: 20 kPa between grains of rock

template <int dim>
double shear_squared(const std::array<double, dim - 1>& shear)
{
  double sum = 0.0;
  for (const double component : shear)
    sum += component * component;
  return sum;
}

/// The part of a segment's face that presses.
struct Pressing
{
  double share;  ///< of its area
  double offset; ///< of its centroid from the segment's, along t [m]
};

Pressing pressing_part(const flat_joint::Segment<2, double>& face, const double gap, const double slope)
{
  const double length = flat_joint::closed_part(face, gap, slope).length;
  return {length / face.length, (slope < 0.0 ? -0.5 : 0.5) * (face.length - length)};
}

/// An element of a disk presses with all of its area or none.
Pressing pressing_part(const flat_joint::Segment<3, double>&, const double gap, double)
{
  return {gap < 0.0 ? 1.0 : 0.0, 0.0};
}

template <int dim>
flat_joint::Segment<dim, double> segment_of(const Link<dim>& link, const FaceElement<dim>& element,
                                            const double thickness)
{
  const double r = link.half_length;
  if constexpr (dim == 2)
    return {link.normal_stiffness, link.shear_stiffness, element.area * r, thickness, link.friction};
  else
    return {link.normal_stiffness, link.shear_stiffness, element.area * r * r, link.friction};
}

/// How far a segment counts as closed to shear: wholly at a gap of -width, not at all at +width. The law of dem/ has a
/// jump there, and no equilibrium may be found where one lies on it.
class Closure
{
public:
  explicit Closure(const double of_width)
    : width(of_width)
  {
  }

  double at(const double gap) const { return std::clamp(0.5 - 0.5 * gap / width, 0.0, 1.0); }

  /// Mean on a straight way from gap to gap.
  double mean(const double from, const double to) const
  {
    return is_short(from, to) ? at(0.5 * (from + to)) : (integral(to) - integral(from)) / (to - from);
  }

  /// Of the mean, per change of the gap at the end [1/m].
  double mean_rate(const double from, const double to) const
  {
    if (is_short(from, to))
      return std::abs(to) < width ? -0.25 / width : 0.0;
    return (at(to) - mean(from, to)) / (to - from);
  }

private:
  bool is_short(const double from, const double to) const { return std::abs(to - from) < 1e-6 * width; }

  double integral(const double gap) const
  {
    const double within = std::clamp(gap, -width, width);
    return std::min(gap, -width) + 0.5 * (within + width) - 0.25 * (within * within - width * width) / width;
  }

  double width; ///< [m]
};

/// Of a flat joint, or of a pair without a face.
template <int dim>
LinkResponse<dim> face_response(const FlatJoint<dim>& law, const Network<dim>& network, const ActiveLink<dim>& active,
                                const Motion<dim>& motion)
{
  const Link<dim>& link = network.links()[active.link];
  const double k_n = link.normal_stiffness;
  const double k_s = link.shear_stiffness;
  // A pair without a face touches at a point: no slope, no moment.
  const FaceElement<dim> point{{}, face_area<dim>(1.0, 1.0), 0.0};
  const double slope = dim == 2 && link.has_face ? motion[2] : 0.0; // elements of a disk are lumped

  LinkResponse<dim> result;
  result.segments.resize(link.n_segments);
  for (std::uint32_t i = 0; i < link.n_segments; ++i)
    {
      const FaceElement<dim>& element = link.has_face ? network.elements()[i] : point;
      const double r = link.half_length;
      const auto face = segment_of(link, element, network.thickness());
      const double area = face.area();
      const auto rows = element_rows(element, r);
      const Vector<dim> now = rows * motion;
      const Vector<dim> before = rows * active.motion;
      const SegmentHistory<dim>& old = active.segments[i];
      SegmentResponse<dim>& segment = result.segments[i];

      if (old.bonded)
        {
          for (int c = 0; c < dim - 1; ++c)
            segment.shear_stress[c] = -k_s * now[c + 1]; // (13), the whole way since rest
          segment.bond_stress = {k_n * now[0], k_n * now[0], flat_joint::magnitude(segment.shear_stress)}; // (10)
          const JointStiffness<dim> stiffness = law.bonded_stiffness(link.face(network.thickness()), element, rows);
          result.forces += stiffness * motion;
          result.tangent += stiffness;
          result.derivative += stiffness;
          result.stored_energy += 0.5 * motion.dot(stiffness * motion);
          continue;
        }

      // One return map from the last event: first as if nothing slid.
      const Closure closure(closure_width_ratio * r);
      flat_joint::SegmentMotion<dim, double> step;
      step.gap_before = link.opening + before[0];
      step.gap = link.opening + now[0];
      step.slope = slope;
      const double share = closure.mean(step.gap_before, step.gap);
      std::array<double, dim - 1> trial;
      for (int c = 0; c < dim - 1; ++c)
        trial[c] = old.shear_stress[c] - k_s * share * (now[c + 1] - before[c + 1]);
      step.shear_increment = {};
      const auto update = flat_joint::update<dim, double>(face, {0.0, 0.0, 0.0}, {trial, false}, step);
      segment.shear_stress = update.state.shear_stress;

      Vector<dim> force;
      force[0] = -update.normal.force;
      for (int c = 0; c < dim - 1; ++c)
        force[c + 1] = -segment.shear_stress[c] * area;
      result.forces += rows.transpose() * force;
      if constexpr (dim == 2)
        if (link.has_face)
          result.forces[2] -= update.normal.moment;
      result.stored_energy += flat_joint::normal_energy(face, step.gap, step.slope, false) +
                              0.5 * shear_squared<dim>(segment.shear_stress) * area / k_s;
      bool sticks = true;
      for (int c = 0; c < dim - 1; ++c)
        {
          // Of a face an edge may press while the middle is open: what the shear does not follow there is slip too.
          const double left_open = link.has_face ? 1.0 - share : 0.0;
          segment.slip[c] = (trial[c] - segment.shear_stress[c]) / k_s - left_open * (now[c + 1] - before[c + 1]);
          sticks = sticks && trial[c] == segment.shear_stress[c];
        }

      const Pressing part = pressing_part(face, step.gap, step.slope);
      if (part.share == 0.0)
        continue;
      FaceElement<dim> pressing = element;
      pressing.offset[0] += part.offset / r;
      const auto part_rows = element_rows(pressing, r);
      const Eigen::Matrix<double, 1, n_motions<dim>> stress_rate = k_n * part.share * part_rows.row(0);
      JointStiffness<dim> normal = area * part_rows.row(0).transpose() * stress_rate;
      if constexpr (dim == 2)
        {
          const double part_length = part.share * face.length;
          const double second_moment =
            link.has_face ? part_length * part_length * part_length * network.thickness() / 12.0 : 0.0;
          normal(2, 2) += k_n * second_moment;
        }
      result.tangent += normal;
      result.derivative += normal;
      const auto shear_rows = rows.bottomRows(dim - 1);
      if (sticks)
        result.tangent += k_s * closure.at(step.gap) * area * shear_rows.transpose() * shear_rows;

      // Of -τ: as if nothing slid; then |τ| = -μσ̂ along the trial stress, which the slip across it turns.
      using ShearRate = Eigen::Matrix<double, dim - 1, n_motions<dim>>;
      using Shear = Eigen::Matrix<double, dim - 1, 1>;
      ShearRate shear_rate = k_s * (share * shear_rows + (now - before).template tail<dim - 1>() *
                                                           closure.mean_rate(step.gap_before, step.gap) * rows.row(0));
      if (!sticks)
        {
          const double size = flat_joint::magnitude(trial);
          const Shear along = Eigen::Map<const Shear>(trial.data()) / size;
          const ShearRate across = shear_rate - along * (along.transpose() * shear_rate);
          shear_rate =
            link.friction * along * stress_rate + flat_joint::magnitude(segment.shear_stress) / size * across;
        }
      result.derivative += area * shear_rows.transpose() * shear_rate;
    }
  return result;
}

/// Of a parallel bond: beside it the linear contact, by one return map from the last event.
template <int dim>
LinkResponse<dim> face_response(const ParallelBond<dim>& law, const Network<dim>& network,
                                const ActiveLink<dim>& active, const Motion<dim>& motion)
{
  using Shear = Eigen::Matrix<double, dim - 1, 1>;
  const Link<dim>& link = network.links()[active.link];
  const Face<double> face = link.face(network.thickness());
  const SegmentHistory<dim>& old = active.segments.front();
  LinkResponse<dim> result;
  SegmentResponse<dim>& segment = result.segments.emplace_back();
  if (old.bonded)
    {
      const JointStiffness<dim> stiffness = law.bond_stiffness(face);
      result.forces = stiffness * motion;
      result.tangent = result.derivative = stiffness;
      result.stored_energy = 0.5 * motion.dot(result.forces);
      segment.bond_stress = law.bond_stress(face, motion);
    }

  const FaceSprings contact = law.contact_springs(face);
  const double area = network.segment_area(link, 0);
  const double pressure = contact.normal * std::max(0.0, -link.opening - motion[0]);
  const Shear way = (motion - active.motion).template segment<dim - 1>(1);
  const Shear trial = area * Eigen::Map<const Shear>(old.shear_stress.data()) - contact.shear * way;
  const double size = trial.norm();
  const double limit = link.friction * pressure;
  const bool slides = size > limit;
  const Shear force = slides ? Shear(limit / size * trial) : trial;
  for (int c = 0; c < dim - 1; ++c)
    {
      segment.shear_stress[c] = force[c] / area;
      segment.slip[c] = (trial[c] - force[c]) / contact.shear;
    }
  result.forces[0] -= pressure;
  result.forces.template segment<dim - 1>(1) -= force;
  result.stored_energy += 0.5 * pressure * pressure / contact.normal + 0.5 * force.squaredNorm() / contact.shear;
  if (pressure == 0.0)
    return result;

  result.tangent(0, 0) += contact.normal;
  result.derivative(0, 0) += contact.normal;
  using ShearStiffness = Eigen::Matrix<double, dim - 1, dim - 1>;
  const ShearStiffness sticking = contact.shear * ShearStiffness::Identity();
  if (!slides)
    {
      result.tangent.template block<dim - 1, dim - 1>(1, 1) += sticking;
      result.derivative.template block<dim - 1, dim - 1>(1, 1) += sticking;
      return result;
    }
  // The force is μ times the pressure along the trial force, which the slip across it turns.
  const Shear along = trial / size;
  result.derivative.template block<dim - 1, 1>(1, 0) += link.friction * contact.normal * along;
  result.derivative.template block<dim - 1, dim - 1>(1, 1) +=
    limit / size * (sticking - contact.shear * along * along.transpose());
  return result;
}
} // namespace

template <int dim>
LinkResponse<dim> response(const Network<dim>& network, const ActiveLink<dim>& active, const Motion<dim>& motion)
{
  if (!network.links()[active.link].has_face)
    return face_response(FlatJoint<dim>(), network, active, motion);
  return std::visit(
    [&]<typename Law>(const Law& law) -> LinkResponse<dim> {
      if constexpr (Law::has_equilibria)
        return face_response(law, network, active, motion);
      else
        throw std::logic_error(fmt::format("the {} has no equilibria event by event", Law::name));
    },
    network.law());
}

template LinkResponse<2> response<2>(const Network<2>&, const ActiveLink<2>&, const Motion<2>&);
template LinkResponse<3> response<3>(const Network<3>&, const ActiveLink<3>&, const Motion<3>&);
} // namespace feldspar
