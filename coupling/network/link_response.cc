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

/// Share of a segment that counts as closed to shear: 1 at a gap of -width, 0 at +width. The law of dem/ has a jump
/// there, and no equilibrium may be found where one lies on it.
struct Closure
{
  double width; ///< [m]

  double at(const double gap) const { return std::clamp(0.5 - 0.5 * gap / width, 0.0, 1.0); }

  /// Mean on a straight way from gap to gap.
  double mean(const double from, const double to) const
  {
    return is_short(from, to) ? at(0.5 * (from + to)) : (integral(to) - integral(from)) / (to - from);
  }

  /// Derivative of the mean by the gap at the end [1/m].
  double mean_rate(const double from, const double to) const
  {
    if (is_short(from, to))
      return std::abs(to) < width ? -0.25 / width : 0.0;
    return (at(to) - mean(from, to)) / (to - from);
  }

  bool is_short(const double from, const double to) const { return std::abs(to - from) < 1e-6 * width; }

  double integral(const double gap) const
  {
    const double within = std::clamp(gap, -width, width);
    return std::min(gap, -width) + 0.5 * (within + width) - 0.25 * (within * within - width * width) / width;
  }
};

/// A segment of a link on its way from the last event.
template <int dim>
struct MovingSegment
{
  const Link<dim>& link;
  FaceElement<dim> element;
  flat_joint::Segment<dim, double> face;
  ElementRows<dim> rows;
  Vector<dim> before, now; ///< opening since rest, and shear
  double slope;

  double gap_before() const { return link.opening + before[0]; }
  double gap() const { return link.opening + now[0]; }
};

template <int dim>
MovingSegment<dim> moving_segment(const Network<dim>& network, const ActiveLink<dim>& active, const Motion<dim>& motion,
                                  const std::uint32_t i)
{
  const Link<dim>& link = network.links()[active.link];
  // A pair without a face is in contact at a point: no slope, no moment.
  const FaceElement<dim> point{{}, face_area<dim>(1.0, 1.0), 0.0};
  const FaceElement<dim>& element = link.has_face ? network.elements()[i] : point;
  const auto rows = element_rows(element, link.half_length);
  const double slope = dim == 2 && link.has_face ? motion[2] : 0.0; // elements of a disk are lumped
  return {link,          element, segment_of(link, element, network.thickness()), rows, rows * active.motion,
          rows * motion, slope};
}

/// Adds what a segment does, its bond intact or not.
template <int dim>
void add_segment(const MovingSegment<dim>& of, const flat_joint::NormalResponse<double>& normal,
                 const std::array<double, dim - 1>& shear_stress, Motion<dim>& forces)
{
  Vector<dim> force;
  force[0] = -normal.force;
  for (int c = 0; c < dim - 1; ++c)
    force[c + 1] = -shear_stress[c] * of.face.area();
  forces += of.rows.transpose() * force;
  if constexpr (dim == 2)
    if (of.link.has_face)
      forces[2] -= normal.moment;
}

/// Stiffness of the part of an unbonded segment that presses.
template <int dim>
struct PressingStiffness
{
  double share = 0.0;                                                                   ///< of the segment's area
  Eigen::Matrix<double, 1, n_motions<dim>> stress_rate = decltype(stress_rate)::Zero(); ///< dσ̂
  JointStiffness<dim> normal = JointStiffness<dim>::Zero();
};

template <int dim>
PressingStiffness<dim> pressing_stiffness(const MovingSegment<dim>& of, const double thickness)
{
  const Pressing part = pressing_part(of.face, of.gap(), of.slope);
  PressingStiffness<dim> result;
  result.share = part.share;
  if (part.share == 0.0)
    return result;
  const double k_n = of.link.normal_stiffness;
  FaceElement<dim> pressing = of.element;
  pressing.offset[0] += part.offset / of.link.half_length;
  const auto part_rows = element_rows(pressing, of.link.half_length);
  result.stress_rate = k_n * part.share * part_rows.row(0);
  result.normal = of.face.area() * part_rows.row(0).transpose() * result.stress_rate;
  if constexpr (dim == 2)
    {
      const double part_length = part.share * of.face.length;
      const double second_moment = of.link.has_face ? part_length * part_length * part_length * thickness / 12.0 : 0.0;
      result.normal(2, 2) += k_n * second_moment;
    }
  return result;
}

/// A bond that holds, and has not softened: the stiffness of its segment.
template <int dim>
void add_bonded(const MovingSegment<dim>& of, const JointStiffness<dim>& stiffness, const Motion<dim>& motion,
                LinkResponse<dim>& sum, SegmentResponse<dim>& segment)
{
  const double k_n = of.link.normal_stiffness;
  for (int c = 0; c < dim - 1; ++c)
    segment.shear_stress[c] = -of.link.shear_stiffness * of.now[c + 1]; // (13), the whole way since rest
  segment.bond_stress = {k_n * of.now[0], k_n * of.now[0], flat_joint::magnitude(segment.shear_stress)}; // (10)
  sum.forces += stiffness * motion;
  sum.tangent += stiffness;
  sum.derivative += stiffness;
  sum.stored_energy += 0.5 * motion.dot(stiffness * motion);
}

/// Adds a segment without a bond: one return map from the last event, first as if nothing slid.
template <int dim>
void add_unbonded(const MovingSegment<dim>& of, const SegmentHistory<dim>& old, const double thickness,
                  LinkResponse<dim>& sum, SegmentResponse<dim>& segment)
{
  const Link<dim>& link = of.link;
  const double k_s = link.shear_stiffness;
  const double area = of.face.area();
  const Closure closure{closure_width_ratio * link.half_length};
  flat_joint::SegmentMotion<dim, double> step;
  step.gap_before = of.gap_before();
  step.gap = of.gap();
  step.slope = of.slope;
  const double share = closure.mean(step.gap_before, step.gap);
  std::array<double, dim - 1> trial;
  for (int c = 0; c < dim - 1; ++c)
    trial[c] = old.shear_stress[c] - k_s * share * (of.now[c + 1] - of.before[c + 1]);
  step.shear_increment = {};
  const auto update = flat_joint::update<dim, double>(of.face, {0.0, 0.0, 0.0}, {trial, false}, step);
  segment.shear_stress = update.state.shear_stress;

  add_segment(of, update.normal, segment.shear_stress, sum.forces);
  sum.stored_energy += flat_joint::normal_energy(of.face, step.gap, step.slope, false) +
                       0.5 * shear_squared<dim>(segment.shear_stress) * area / k_s;
  bool sticks = true;
  for (int c = 0; c < dim - 1; ++c)
    {
      // On a face, an edge may press while the middle is open: the displacement there that the shear stress does not
      // follow is slip too.
      const double left_open = link.has_face ? 1.0 - share : 0.0;
      segment.slip[c] = (trial[c] - segment.shear_stress[c]) / k_s - left_open * (of.now[c + 1] - of.before[c + 1]);
      sticks = sticks && trial[c] == segment.shear_stress[c];
    }

  const PressingStiffness<dim> pressing = pressing_stiffness(of, thickness);
  if (pressing.share == 0.0)
    return;
  sum.tangent += pressing.normal;
  sum.derivative += pressing.normal;
  const auto shear_rows = of.rows.bottomRows(dim - 1);
  if (sticks)
    sum.tangent += k_s * closure.at(step.gap) * area * shear_rows.transpose() * shear_rows;

  // Rate of -τ as if nothing slid. While it slides, |τ| = -μσ̂ along the trial stress, whose direction the slip across
  // it turns.
  using ShearRate = Eigen::Matrix<double, dim - 1, n_motions<dim>>;
  using Shear = Eigen::Matrix<double, dim - 1, 1>;
  ShearRate shear_rate = k_s * (share * shear_rows + (of.now - of.before).template tail<dim - 1>() *
                                                       closure.mean_rate(step.gap_before, step.gap) * of.rows.row(0));
  if (!sticks)
    {
      const double size = flat_joint::magnitude(trial);
      const Shear along = Eigen::Map<const Shear>(trial.data()) / size;
      const ShearRate across = shear_rate - along * (along.transpose() * shear_rate);
      shear_rate =
        link.friction * along * pressing.stress_rate + flat_joint::magnitude(segment.shear_stress) / size * across;
    }
  sum.derivative += area * shear_rows.transpose() * shear_rate;
}

/// Adds a segment with a bond that has softened, and softens no further before the next event: between bonded and
/// unbonded, and elastic in shear.
template <int dim>
void add_softened(const MovingSegment<dim>& of, const JointStiffness<dim>& bonded_stiffness,
                  const SegmentHistory<dim>& old, const double thickness, LinkResponse<dim>& sum,
                  SegmentResponse<dim>& segment)
{
  const double k_s = of.link.shear_stiffness;
  const double area = of.face.area();
  const double damage = old.more.front();
  for (int c = 0; c < dim - 1; ++c)
    segment.shear_stress[c] = old.shear_stress[c] - k_s * (of.now[c + 1] - of.before[c + 1]);
  add_segment(of, softening::damaged_response<dim, double>(of.face, of.gap(), of.slope, damage), segment.shear_stress,
              sum.forces);
  sum.stored_energy += flat_joint::normal_energy(of.face, of.gap(), of.slope, false) +
                       (1.0 - damage) * softening::energy_of_bond<dim, double>(of.face, of.gap(), of.slope) +
                       0.5 * shear_squared<dim>(segment.shear_stress) * area / k_s;

  const auto shear_rows = of.rows.bottomRows(dim - 1);
  const JointStiffness<dim> shear = k_s * area * shear_rows.transpose() * shear_rows;
  const JointStiffness<dim> normal_of_bond = bonded_stiffness - shear;
  const JointStiffness<dim> stiffness =
    shear + normal_of_bond + damage * (pressing_stiffness(of, thickness).normal - normal_of_bond);
  sum.tangent += stiffness;
  sum.derivative += stiffness;
}

/// Response of a flat joint, whose bonds may soften, or of a pair without a face.
template <typename Law, int dim>
void face_response(const Law& law, const Network<dim>& network, const ActiveLink<dim>& active,
                   const Motion<dim>& motion, LinkResponse<dim>& result)
{
  for (std::uint32_t i = 0; i < active.segments.size(); ++i)
    {
      const auto moving = moving_segment(network, active, motion, i);
      const SegmentHistory<dim>& old = active.segments[i];
      SegmentResponse<dim>& segment = result.segments[i];
      if (!old.bonded)
        {
          add_unbonded(moving, old, network.thickness(), result, segment);
          continue;
        }
      const JointStiffness<dim> stiffness =
        law.bonded_stiffness(moving.link.face(network.thickness()), moving.element, moving.rows);
      if (old.has_softened())
        add_softened(moving, stiffness, old, network.thickness(), result, segment);
      else
        add_bonded(moving, stiffness, motion, result, segment);
    }
}

/// Response of a parallel bond and of the linear contact beside it, by one return map from the last event.
template <int dim>
void face_response(const ParallelBond<dim>& law, const Network<dim>& network, const ActiveLink<dim>& active,
                   const Motion<dim>& motion, LinkResponse<dim>& result)
{
  using Shear = Eigen::Matrix<double, dim - 1, 1>;
  const Link<dim>& link = network.links()[active.link];
  const Face<double> face = link.face(network.thickness());
  const SegmentHistory<dim>& old = active.segments.front();
  SegmentResponse<dim>& segment = result.segments.front();
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
    return;

  result.tangent(0, 0) += contact.normal;
  result.derivative(0, 0) += contact.normal;
  using ShearStiffness = Eigen::Matrix<double, dim - 1, dim - 1>;
  const ShearStiffness sticking = contact.shear * ShearStiffness::Identity();
  if (!slides)
    {
      result.tangent.template block<dim - 1, dim - 1>(1, 1) += sticking;
      result.derivative.template block<dim - 1, dim - 1>(1, 1) += sticking;
      return;
    }
  // The force is μ times the pressure along the trial force, which the slip across it turns.
  const Shear along = trial / size;
  result.derivative.template block<dim - 1, 1>(1, 0) += link.friction * contact.normal * along;
  result.derivative.template block<dim - 1, dim - 1>(1, 1) +=
    limit / size * (sticking - contact.shear * along * along.transpose());
}
} // namespace

template <int dim>
LinkResponse<dim> response(const Network<dim>& network, const ActiveLink<dim>& active, const Motion<dim>& motion,
                           LinkResponse<dim> result)
{
  result.forces.setZero();
  result.tangent.setZero();
  result.derivative.setZero();
  result.segments.assign(active.segments.size(), {});
  result.stored_energy = 0.0;
  if (!network.links()[active.link].has_face)
    {
      face_response(FlatJoint<dim>(), network, active, motion, result);
      return result;
    }
  std::visit(
    [&]<typename Law>(const Law& law) {
      if constexpr (Law::has_equilibria)
        face_response(law, network, active, motion, result);
      else
        throw std::logic_error(fmt::format("the {} has no equilibria event by event", Law::name));
    },
    network.law());
  return result;
}

namespace
{
/// d that is asked of a bond, by tension and then by shear. In shear a bond that an event has softened farther than was asked of
/// it has done half a step of the next way already; in tension its opening says how far it is.
struct Asked
{
  double by_tension;
  double by_shear;

  double d() const { return by_tension + by_shear; }
};

Asked asked(const softening::Demand<double>& of, const Memory& memory, const double least_step)
{
  const bool is_ahead = memory[1] > 0.0 && of.now < 1.0; // at its end it breaks
  return {of.pulled, std::max(0.0, of.now - of.pulled - (is_ahead ? 0.5 * least_step : 0.0))};
}
} // namespace

template <int dim>
SofteningDemand softening_demand(const Network<dim>& network, const Link<dim>& link, const std::uint32_t i,
                                 const SegmentHistory<dim>& old, const double opening,
                                 const std::array<double, dim - 1>& shear_stress, const double least_step)
{
  const auto segment = segment_of(link, network.elements()[i], network.thickness());
  const Bond<double>& bond = network.bond(link.first_segment + i);
  const double over_opening = network.softening_opening().value();
  const auto of =
    softening::demand<dim, double>(segment, bond, over_opening, old.more.front(), link.opening + opening, shear_stress);
  // Ratios as if nothing of the bond had softened: the demand over the strength and the displacement softened so far.
  const double softened = of.before * over_opening;
  const double by_tension =
    segment.normal_stiffness * (link.opening + opening) / (bond.tensile_strength + segment.normal_stiffness * softened);
  const double by_shear =
    (of.size + segment.shear_stiffness * softened) / (of.limit(of.before) + segment.shear_stiffness * softened);
  return {std::max(by_tension, by_shear),
          asked(of, old.more, least_step).d() >= std::min(1.0, of.before + 0.5 * least_step)};
}

template <int dim>
BondEvent loosen(const Network<dim>& network, ActiveLink<dim>& active, const std::uint32_t i, const bool in_tension,
                 const double least_step)
{
  SegmentHistory<dim>& segment = active.segments[i];
  const auto softening_opening = network.softening_opening();
  if (!softening_opening)
    {
      segment.bonded = false;
      if (network.is_linear_while_bonded())
        segment.shear_stress = {};
      return {true, in_tension, 0.0, 0.0};
    }
  const auto at = moving_segment(network, active, active.motion, i);
  const auto tau = response(network, active, active.motion).segments[i].shear_stress;
  const softening::State<dim, double> old{tau, true, segment.more};
  const Bond<double>& bond = network.bond(at.link.first_segment + i);
  const double over_opening = *softening_opening;
  const auto of = softening::demand<dim, double>(at.face, bond, over_opening, segment.more.front(), at.gap(), tau);
  const Asked by = asked(of, segment.more, least_step);
  const double d = std::min(1.0, by.d() + 0.5 * least_step);
  const bool sheared = by.by_shear > by.by_tension - of.before;
  const auto update =
    softening::soften<dim, double>(at.face, bond, over_opening, old, {at.gap(), at.gap(), at.slope, {}}, tau, of, d,
                                   sheared ? d - by.by_tension : by.by_shear);
  segment = {update.state.bonded, update.state.shear_stress, update.state.more};
  return {!update.state.bonded, update.tension_break, update.slip_energy, update.released_energy};
}

template SofteningDemand softening_demand(const Network<2>&, const Link<2>&, std::uint32_t, const SegmentHistory<2>&,
                                          double, const std::array<double, 1>&, double);
template SofteningDemand softening_demand(const Network<3>&, const Link<3>&, std::uint32_t, const SegmentHistory<3>&,
                                          double, const std::array<double, 2>&, double);
template BondEvent loosen(const Network<2>&, ActiveLink<2>&, std::uint32_t, bool, double);
template BondEvent loosen(const Network<3>&, ActiveLink<3>&, std::uint32_t, bool, double);
template LinkResponse<2> response(const Network<2>&, const ActiveLink<2>&, const Motion<2>&, LinkResponse<2>);
template LinkResponse<3> response(const Network<3>&, const ActiveLink<3>&, const Motion<3>&, LinkResponse<3>);
} // namespace feldspar
