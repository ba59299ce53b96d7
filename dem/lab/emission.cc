#include "dem/lab/emission.h"

#include "base/system/hdf5_archive.h"
#include "dem/lab/servo.h"
#include "dem/laws/flat_joint.h"
#include "dem/storage/segment_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <variant>

namespace feldspar
{
namespace
{
constexpr double poisson_ratio = 0.25; // of the rock, for the speed of shear waves alone
// Between two measurements of an event; under damping its moment rises to its end.
constexpr std::size_t steps_between = 4;
constexpr std::size_t segments_a_step = 16;

/// A force on grain 2 by its parts along the axes of a face.
template <int dim>
struct FaceForce
{
  double across;
  std::array<double, dim - 1> along;
};

/// The force on grain 2 by a broken segment, less that by the same segment with its bond [N].
template <int dim>
FaceForce<dim> lost_force(const Joints<dim>& joints, const std::size_t joint, const unsigned int number)
{
  const auto placed = place_segment(joints.face(joint), joints.elements[number]);
  const auto& segment = placed.segment;
  const auto of_joint = [&](const auto& row) { return row[joint]; };
  std::array<double, n_rotations<dim>> rotation;
  std::ranges::transform(joints.rotation, rotation.begin(), of_joint);
  std::array<double, dim - 1> slip;
  std::ranges::transform(joints.slip, slip.begin(), of_joint);
  const double gap = flat_joint::gap_at(joints.opening[joint], rotation, placed.offset);
  const double slope = dim == 2 ? rotation[0] : 0.0;
  slip = flat_joint::slip_at(slip, rotation[0], placed.offset);
  const auto shear = shear_stress(joints, number, joint);
  // A contact beside the bond, which makes a law not linear, presses with it and without it.
  const bool contact_stays = std::visit([](const auto& law) { return !law.linear_while_bonded; }, joints.law);
  const auto carried = [&](const bool bonded) {
    return flat_joint::normal_response(segment, gap, slope, bonded).force;
  };
  FaceForce<dim> force{(contact_stays ? 0.0 : carried(false)) - carried(true), {}};
  for (std::size_t c = 0; c < slip.size(); ++c)
    force.along[c] = (shear[c] + segment.shear_stiffness * slip[c]) * segment.area();
  return force;
}

template <int dim>
FaceForce<dim> lost_force(const SmoothJoint<dim>& joint)
{
  FaceForce<dim> force{
    joint.area * (joint.face.normal_stiffness * joint.opening - smooth_joint::normal_stress(joint.face, joint.state)),
    {}};
  for (std::size_t c = 0; c < force.along.size(); ++c)
    force.along[c] = joint.area * (joint.state.shear_stress[c] + joint.face.shear_stiffness * joint.slip[c]);
  return force;
}

/// The pair of forces on the grains of a broken segment that its bond no longer exerts, as a tensor [N m]; none if the joint is gone.
template <int dim, class Segment>
std::optional<Tensor<dim>> moment_of(const Dynamics<dim>& dynamics, const Segment& broken)
{
  const Specimen<dim>& body = dynamics.specimen();
  FaceForce<dim> force;
  Vector<dim> normal;
  std::array<Vector<dim>, dim - 1> axes;
  if (broken.on_smooth_joint)
    {
      const GrainPair ends(broken.grain_1, broken.grain_2);
      const auto joint = std::ranges::lower_bound(body.smooth_joints, ends, {}, &SmoothJoint<dim>::ends);
      if (joint == body.smooth_joints.end() || joint->number != broken.joint)
        return std::nullopt;
      force = lost_force(*joint);
      normal = Eigen::Map<const Vector<dim>>(joint->normal.data());
      axes = plane_axes<dim>(normal);
    }
  else
    {
      const std::optional<std::size_t> joint = dynamics.joint_of(broken.grain_1, broken.joint);
      if (!joint)
        return std::nullopt;
      force = lost_force(body.joints, *joint, broken.segment);
      normal = at<dim>(body.joints.normal, *joint);
      axes = face_axes(body.joints, *joint);
    }
  Vector<dim> on_grain_2 = force.across * normal;
  for (std::size_t c = 0; c < axes.size(); ++c)
    on_grain_2 += force.along[c] * axes[c];
  const Vector<dim> branch =
    at<dim>(body.grains.position, broken.grain_2) - at<dim>(body.grains.position, broken.grain_1);
  const Tensor<dim> moment = on_grain_2 * branch.transpose();
  return 0.5 * (moment + moment.transpose());
}
} // namespace

template <int dim>
void EmissionWatch<dim>::keep_larger(Moment& moment, const Moment& other)
{
  const auto squared_norm = [](const Moment& one) { return Eigen::Map<const Tensor<dim>>(one.data()).squaredNorm(); };
  if (squared_norm(other) > squared_norm(moment))
    moment = other;
}

template <int dim>
EmissionWatch<dim>::EmissionWatch(const Specimen<dim>& body, const EmissionParameters& wanted)
  : least_radius(wanted.event_radius * 2.0 * body.report.mean_radius)
  , duration_over_radius(wanted.event_duration * std::sqrt(2.0 * (1.0 + poisson_ratio)) / wave_speed(body))
{
  if (dim == 2)
    thickness_ratio = wanted.thickness.value_or(body.size[0]) / body.thickness;
}

template <int dim>
void EmissionWatch<dim>::Source::add(const BrokenSegment& one)
{
  const Eigen::Map<const Vector<dim>> place(one.place.data());
  const Vector<dim> before = broken.empty() ? Vector<dim>(place) : centre();
  broken.push_back(one);
  sum_of_places += place;
  const Vector<dim> now = centre();
  const double moved = (now - before).norm(), own = (place - now).norm();
  farthest = {std::max(farthest[0] - moved, own), std::max(farthest[1] + moved, own)};
  has_grown = true;
}

template <int dim>
void EmissionWatch<dim>::Source::measure_extent()
{
  const Vector<dim> middle = centre();
  double squared = 0.0;
  for (const BrokenSegment& one : broken)
    squared = std::max(squared, (Eigen::Map<const Vector<dim>>(one.place.data()) - middle).squaredNorm());
  farthest.fill(std::sqrt(squared));
}

template <int dim>
bool EmissionWatch<dim>::Source::is_near(const Vector<dim>& place, const double more)
{
  constexpr double for_rounding = 1e-9; // relative; the bounds round once for each break of a step
  const double distance = (place - centre()).norm() - more;
  if (distance <= (1.0 - for_rounding) * farthest[0])
    return true;
  if (distance > (1.0 + for_rounding) * farthest[1])
    return false;
  measure_extent();
  return distance <= farthest[0];
}

/// The event that a break at a place belongs to: the first of those that it is near to, which takes the others over, or a
/// new one.
template <int dim>
typename EmissionWatch<dim>::Source& EmissionWatch<dim>::source_at(const Vector<dim>& place, const double time)
{
  const auto is_near = [&](Source& source) { return source.is_near(place, least_radius); };
  const auto first = std::ranges::find_if(sources, is_near);
  if (first == sources.end())
    {
      const std::uint64_t event = events.size();
      events.push_back({time, event, {}});
      sources.emplace_back().event = event;
      return sources.back();
    }
  sources.erase(std::remove_if(std::next(first), sources.end(),
                               [&](Source& other) {
                                 if (!is_near(other))
                                   return false;
                                 events[other.event].part_of = first->event;
                                 keep_larger(events[first->event].moment, events[other.event].moment);
                                 for (const BrokenSegment& one : other.broken)
                                   first->add(one);
                                 return true;
                               }),
                sources.end());
  return *first;
}

/// Sets the moments of segments whose joints are there; of a shared body the process that counts a joint measures it.
template <int dim>
void EmissionWatch<dim>::measure(const Dynamics<dim>& dynamics, const std::vector<BrokenSegment*>& segments)
{
  if (!dynamics.sharing().is_shared())
    {
      for (BrokenSegment* const broken : segments)
        if (const auto moment = moment_of(dynamics, *broken))
          Eigen::Map<Tensor<dim>>(broken->moment.data()) = *moment;
      return;
    }
  if (segments.empty())
    return;
  std::vector<double> numbers, moments; // of those measured
  for (std::size_t k = 0; k < segments.size(); ++k)
    if (dynamics.sharing().counts(segments[k]->grain_1))
      if (const auto moment = moment_of(dynamics, *segments[k]))
        {
          numbers.push_back(double(k));
          moments.insert(moments.end(), moment->data(), moment->data() + moment->size());
        }
  std::vector<std::size_t> counts;
  const auto of_all = dynamics.sharing().gathered_lists({numbers, moments}, counts);
  auto next = of_all[1].begin();
  for (const double number : of_all[0])
    {
      Moment& moment = segments[std::size_t(number)]->moment;
      std::copy_n(next, moment.size(), moment.begin());
      next += std::ptrdiff_t(moment.size());
    }
}

template <int dim>
void EmissionWatch<dim>::measure(const Dynamics<dim>& dynamics, const std::vector<Source*>& those)
{
  std::vector<BrokenSegment*> segments;
  for (Source* source : those)
    for (BrokenSegment& broken : source->broken)
      segments.push_back(&broken);
  measure(dynamics, segments);
  for (const Source* source : those)
    keep_larger(events[source->event].moment, sum_of(*source));
}

template <int dim>
auto EmissionWatch<dim>::sum_of(const Source& source) -> Moment
{
  Moment sum{};
  for (const BrokenSegment& broken : source.broken)
    std::transform(sum.begin(), sum.end(), broken.moment.begin(), sum.begin(), std::plus<>());
  return sum;
}

template <int dim>
void EmissionWatch<dim>::follow(const Dynamics<dim>& dynamics, const std::vector<CrackBetween>& of_step,
                                std::vector<Crack>& all)
{
  const double now = dynamics.time();
  const auto measure_those = [&](const auto& is_due) {
    std::vector<Source*> due;
    for (Source& source : sources)
      if (is_due(source))
        due.push_back(&source);
    measure(dynamics, due);
  };
  const auto has_ended = [&](const Source& source) { return source.end < now; };
  measure_those(has_ended);
  std::erase_if(sources, has_ended);

  std::vector<BrokenSegment> broken_now;
  broken_now.reserve(of_step.size());
  for (const auto& [crack, grain_1, grain_2] : of_step)
    {
      broken_now.push_back(
        {grain_1, grain_2, std::uint32_t(crack.joint), crack.segment, crack.on_smooth_joint, {}, {}});
      std::copy_n(crack.centroid.begin(), dim, broken_now.back().place.begin());
    }
  std::vector<BrokenSegment*> each;
  each.reserve(broken_now.size());
  for (BrokenSegment& broken : broken_now)
    each.push_back(&broken);
  measure(dynamics, each); // a joint may go before its event is measured
  for (std::size_t k = 0; k < broken_now.size(); ++k)
    {
      const BrokenSegment& broken = broken_now[k];
      Source& source = source_at(Eigen::Map<const Vector<dim>>(broken.place.data()), now);
      all[all.size() - broken_now.size() + k].event = source.event;
      source.add(broken);
    }
  for (Source& source : sources)
    if (std::exchange(source.has_grown, false))
      {
        source.measure_extent();
        source.end = now + duration_over_radius * (least_radius + source.farthest[0]);
      }
  // A large event changes slowly, and costs no more than a small one if it is measured as much more seldom.
  measure_those([&](const Source& source) {
    return dynamics.n_steps() % (steps_between + source.broken.size() / segments_a_step) == 0;
  });
}

template <int dim>
std::vector<EmissionEvent> EmissionWatch<dim>::catalogue(std::vector<Crack>& cracks, const double start) const
{
  std::vector<Event> until_now = events;
  for (const Source& running : sources)
    keep_larger(until_now[running.event].moment, sum_of(running));
  std::vector<EmissionEvent> list;
  std::map<std::uint64_t, std::size_t> place_of_event;
  for (Crack& crack : cracks)
    {
      std::uint64_t event = crack.event;
      while (events[event].part_of != event)
        event = events[event].part_of;
      const auto [known, is_new] = place_of_event.emplace(event, list.size());
      if (is_new)
        {
          EmissionEvent one{.number = list.size() + 1,
                            .step = crack.step,
                            .time = events[event].time - start,
                            .axial_strain = crack.axial_strain};
          const Eigen::Map<const Tensor<dim>> moment(until_now[event].moment.data());
          for (int a = 0, k = 0; a < 3; ++a)
            for (int b = a; b < 3; ++b, ++k)
              one.moment[k] = b < dim ? thickness_ratio * moment(a, b) : 0.0;
          list.push_back(one);
        }
      EmissionEvent& one = list[known->second];
      crack.event = one.number;
      ++(crack.kind == CrackKind::tension ? one.n_tension : one.n_shear);
      one.released_energy += thickness_ratio * crack.released_energy;
      for (int c = 0; c < dim; ++c)
        one.centroid[c] += crack.centroid[c];
    }
  for (EmissionEvent& one : list)
    for (double& coordinate : one.centroid)
      coordinate /= double(one.n_breaks());
  for (const Crack& crack : cracks)
    {
      EmissionEvent& one = list[crack.event - 1];
      one.extent = std::max(
        one.extent,
        (Eigen::Map<const Vector<3>>(crack.centroid.data()) - Eigen::Map<const Vector<3>>(one.centroid.data())).norm());
    }
  return list;
}

template <int dim>
template <typename Archive>
void EmissionWatch<dim>::transfer(Archive& archive)
{
  archive.array("events", events);
  std::uint64_t n_sources = sources.size();
  archive.value("n_sources", n_sources);
  sources.resize(n_sources);
  for (std::size_t k = 0; k < n_sources; ++k)
    {
      Source& source = sources[k];
      auto group = archive.subgroup(fmt::format("source_{}", k));
      group.value("event", source.event);
      group.value("end", source.end);
      group.array("broken", source.broken);
      source.sum_of_places.setZero();
      for (const BrokenSegment& one : source.broken)
        source.sum_of_places += Eigen::Map<const Vector<dim>>(one.place.data());
      source.measure_extent();
    }
}

template class EmissionWatch<2>;
template class EmissionWatch<3>;
template void EmissionWatch<2>::transfer(Hdf5Writer&);
template void EmissionWatch<2>::transfer(Hdf5Reader&);
template void EmissionWatch<3>::transfer(Hdf5Writer&);
template void EmissionWatch<3>::transfer(Hdf5Reader&);
} // namespace feldspar
