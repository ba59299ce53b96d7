#include "dem/dynamics/dynamics.h"

#include "dem/dynamics/sweeps/joint_groups.h"
#include "dem/dynamics/sweeps/smooth_sweep.h"
#include "dem/dynamics/time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <variant>

namespace feldspar
{
namespace
{
/// Looking at the groups of joints takes some 2 % of the time of a broken body of 1 948 discs.
constexpr std::uint64_t steps_between_groupings = 256;

template <int dim>
bool face_outlives_bonds(const Joints<dim>& joints)
{
  return std::visit([](const auto& law) { return law.face_outlives_bonds; }, joints.law);
}
} // namespace

template <int dim>
Dynamics<dim>::Dynamics(Specimen<dim> specimen, const DynamicsParameters& wanted, const ZeroForce where)
  : body(std::move(specimen))
  , parameters(wanted)
  , zero_force(where)
  , images(body)
  , part(body.grains.size())
  , groups(body)
  , grips(bodies().size())
  , watch(body.grains)
  , ledger(bodies().size())
{
  if (body.is_periodic())
    for (std::size_t j = 0; j < body.joints.size(); ++j)
      if (const auto second = body.second_of(j); second.boxes != std::array<int, dim>{})
        body.joints.grain_2[j] = images.number_of(second, body.grains);
}

template <int dim>
std::size_t Dynamics<dim>::add_grip(std::vector<std::uint32_t> members, const Vector<dim>& velocity)
{
  if (!groups.empty())
    {
      std::vector<std::uint32_t> n_wanted(groups.size(), 0), n_members(groups.size(), 0);
      for (const auto i : members)
        ++n_wanted[groups.body_of(i)];
      for (std::uint32_t i = 0; i < body.grains.size(); ++i)
        ++n_members[groups.body_of(i)];
      members.clear();
      for (std::uint32_t g = 0; g < groups.size(); ++g)
        if (2 * n_wanted[g] > n_members[g])
          members.push_back(g);
      for (const auto g : members)
        groups.bodies.spin.front()[g] = 0.0;
    }
  return grips.add(std::move(members), velocity, bodies());
}

template <int dim>
void Dynamics<dim>::push(const std::uint32_t grain, const Vector<dim>& more)
{
  const std::uint32_t pushed = groups.empty() ? grain : groups.body_of(grain);
  const double before = kinetic_energy(pushed);
  if (groups.empty())
    set<dim>(body.grains.velocity, grain, at<dim>(body.grains.velocity, grain) + more);
  else
    groups.push(body.grains, grain, more);
  if (started)
    ledger.kinetic_at_start += kinetic_energy(pushed) - before;
}

template <int dim>
void Dynamics<dim>::deform_body(const Tensor<dim>& rate)
{
  const Tensor<dim> change = rate - images.rate();
  const Vector<dim> middle = 0.5 * images.cell().rowwise().sum();
  if (!change.isZero(0.0))
    for (std::uint32_t i = 0; i < images.n_own(); ++i)
      push(i, change * (at<dim>(body.grains.position, i) - middle));
  deform_cell(rate);
}

template <int dim>
void Dynamics<dim>::apply_forces(const Components<dim>& forces)
{
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < forces[c].size(); ++i)
      body.grains.force[c][i] += forces[c][i] - (applied_force[c].empty() ? 0.0 : applied_force[c][i]);
  applied_force = forces;
  term_counts.clear();
  groups.gather(body.grains);
}

template <int dim>
std::vector<Break> Dynamics<dim>::step()
{
  if (!started)
    start();
  else if (watch_is_over() || faces_have_gone)
    {
      if (remove_lost_contacts())
        index_joints();
      find_contacts();
      choose_time_step();
    }
  else if (contact_made)
    choose_time_step();
  if (steps % steps_between_groupings == 0 && regroup_joints())
    index_joints();

  add_boundary_work(dt, 0.5);
  const double farthest_way = part.copy_motions(body.grains, integrate());
  wall_set.move(dt);
  if (body.is_periodic())
    images.move(dt, body.grains);
  auto breaks = update_contacts(dt, farthest_way);
  add_boundary_work(dt, 0.5);
  for (const double energy : released)
    ledger.released += energy;
  faces_have_gone = !released.empty() && !face_outlives_bonds(body.joints);
  current_time += dt;
  previous_dt = dt;
  ++steps;
  return breaks;
}

/// Returns whether contacts must be searched for anew.
template <int dim>
bool Dynamics<dim>::watch_is_over()
{
  if (!watch.is_due(steps))
    return false;
  check_motion();
  return watch.may_miss_contacts(body, part, wall_set, steps, dt);
}

template <int dim>
void Dynamics<dim>::restart()
{
  touches.clear();
  wall_set.clear();
  zero_force = ZeroForce::at_touch;
  started = false;
}

template <int dim>
void Dynamics<dim>::start()
{
  index_joints();
  find_contacts();
  check();
  zero_force = ZeroForce::at_touch; // the placing is over: later contacts begin where surfaces meet
  update_contacts(0.0, 0.0);
  check();
  choose_time_step();
  check();
  previous_dt = 0.0; // the first kick is half a step
  inverse_inertia = InverseInertia(bodies());
  watch.begin_at(steps);
  started = true;
  const Energies initial = energies();
  ledger.kinetic_at_start = initial.kinetic;
  ledger.strain_at_start += initial.strain;
  check_motion(); // from the outside; a first step too long would take grains where no contact is looked for
}

template <int dim>
std::optional<std::size_t> Dynamics<dim>::joint_of(const std::uint32_t grain_1, const std::uint32_t number) const
{
  for (std::uint32_t k = joints_of.first[grain_1]; k < joints_of.first[grain_1 + 1]; ++k)
    if (const std::size_t joint = joints_of.entries[k] / 2; body.joints.number[joint] == number)
      return joint;
  return std::nullopt;
}

template <int dim>
BrokenJoint Dynamics<dim>::joint_of(const Break& event) const
{
  const auto& joints = body.joints;
  if (event.joint < joints.size())
    return {joints.number[event.joint], {joints.grain_1[event.joint], joints.grain_2[event.joint]}, false};
  const SmoothJoint<dim>& joint = body.smooth_joints[event.joint - joints.size()];
  return {joint.number, joint.ends(), true};
}

/// Makes anew all that knows the places of joints, after some have gone or have other places.
template <int dim>
void Dynamics<dim>::index_joints()
{
  const auto& joints = body.joints;
  joints_of = incidence(
    images.n_own(), joints.size(), [&](const std::size_t j) { return GrainPair(joints.grain_1[j], joints.grain_2[j]); },
    [&](const std::uint32_t grain) { return images.owner(grain); });
  // Entries are sorted by the numbers of the joints, wherever these are stored: sums over them have one order.
  const auto number_and_end = [&](const std::uint32_t entry) { return std::pair(joints.number[entry / 2], entry % 2); };
  for (std::size_t i = 0; i < images.n_own(); ++i)
    std::ranges::sort(
      std::span(joints_of.entries).subspan(joints_of.first[i], joints_of.first[i + 1] - joints_of.first[i]), {},
      number_and_end);
  sum_order = SumOrder(joints_of, joints.size(), part.grains());
  sweep_memory = SweepMemory<dim>(joints);
  know_copies();
}

/// Only a law that responds for faces as for one gains by it. A periodic body is left as it stands, because its mean stress may
/// lead its motion and is summed in the order of storage.
template <int dim>
bool Dynamics<dim>::regroup_joints()
{
  return responds_as_one<dim>(body.joints.law) && !body.is_periodic() && regroup(body.joints, sweep_memory);
}

/// The grains of a joint that has lost its face may come into contact again. Returns whether joints have gone.
template <int dim>
bool Dynamics<dim>::remove_lost_contacts()
{
  auto& joints = body.joints;
  const std::size_t n_touches = touches.size();
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      if (has_face(joints, j))
        kept.push_back(j);
      else
        {
          NearPair pair = near_pair(body, joints.grain_1[j], joints.grain_2[j]);
          pair.zero_distance = std::min(pair.zero_distance, joints.rest_distance[j]);
          // The energy that the face stored and the contact does not is released in sliding off.
          const double overlap = std::max(0.0, pair.zero_distance - joints.rest_distance[j] - joints.opening[j]);
          const double k_n = make_touch(body, pair.grain_1, pair.grain_2).stiffness.normal;
          if (part.counts(pair.grain_1))
            ledger.slip_of_lost_contacts.add(joints.slip_energy[j] + joint_energy(joints, j) -
                                             0.5 * k_n * overlap * overlap);
          touches.add(pair);
        }
    }
  // Their grains may have rolled into each other while the sides were open: they are in contact from where they stand.
  for (const auto& [ends, energy] : remove_ended_smooth_joints(body))
    {
      if (part.counts(ends.first))
        ledger.slip_of_lost_contacts.add(energy);
      NearPair pair = near_pair(body, ends.first, ends.second);
      pair.zero_distance =
        std::min(pair.zero_distance,
                 (at<dim>(body.grains.position, ends.second) - at<dim>(body.grains.position, ends.first)).norm());
      touches.add(pair);
    }
  if (touches.size() > n_touches)
    touches.number(images);
  if (kept.size() == joints.size())
    return false;
  joints.keep(kept);
  return true;
}

template <int dim>
void Dynamics<dim>::find_contacts()
{
  check_motion(); // the search could not place what stands nowhere
  if (body.is_periodic())
    images.add_within(watch.skin(), body.grains);
  part.bring_all(body.grains.position);
  touches.search(body, images, part, joints_of, watch.skin(), zero_force, ledger, check);
  wall_set.search(body, part.grains(), watch.skin(), zero_force, ledger);
  watch.note_search(body.grains);
  agree_on_copies();
}

/// Over inertia, with the contacts that press now; where none does, of the stiffest that a grain could make [1/s²].
template <int dim>
double Dynamics<dim>::largest_stiffness_ratio() const
{
  const double of_contacts =
    part.largest({largest_stiffness_over_inertia(body, groups, part.grains(), joints_of, touches, wall_set)})[0];
  return of_contacts > 0.0 ? of_contacts : stiffness_over_inertia_of_touches(body);
}

template <int dim>
void Dynamics<dim>::choose_time_step()
{
  const double largest = largest_stiffness_ratio();
  dt = parameters.time_step_safety / std::sqrt(largest);
  if (!(std::isnormal(dt) && current_time + dt > current_time))
    throw Runaway(
      fmt::format("numbers went wrong: the time step is {:g} s after {:g} s, for stiffnesses over masses of "
                  "up to {:g} 1/s²",
                  dt, current_time, largest));
  contact_made = false;
}

template <int dim>
void Dynamics<dim>::check_motion() const
{
  std::vector<StrayGrain> strays;
  if (const auto here = find_stray_grain(body, part.grains(), wall_set, dt))
    strays.push_back(*here);
  strays = part.gathered(strays); // which all then know
  if (strays.empty())
    return;
  const auto& first = *std::ranges::min_element(strays, {}, &StrayGrain::through_wall); // of those in the open
  Circumstances now = circumstances();
  now.through_wall = first.through_wall;
  throw Runaway(describe_runaway(fmt::format("grain {} {}", first.grain, first.motion()), now));
}

template <int dim>
Runaway Dynamics<dim>::runaway(const std::string& trouble) const
{
  std::uint32_t fastest = 0;
  for (std::uint32_t i = 1; i < images.n_own(); ++i)
    if (!(squared_norm<dim>(body.grains.velocity, i) <= squared_norm<dim>(body.grains.velocity, fastest)))
      fastest = i;
  return Runaway(describe_runaway(fmt::format("{}, the fastest grain is {},", trouble, fastest), circumstances()));
}

template <int dim>
Circumstances Dynamics<dim>::circumstances() const
{
  double fastest = images.rate().norm() * body.size.norm();
  for (const Wall& wall : wall_set.list())
    fastest = std::max(fastest, std::abs(wall.velocity));
  for (std::size_t g = 0; g < grips.size(); ++g)
    fastest = std::max(fastest, grips.velocity(g).norm());
  // Contacts have not been searched for at the start.
  const double largest = started ? largest_stiffness_ratio() : 0.0;
  return {steps, dt, dt * std::sqrt(largest), fastest,
          *std::min_element(body.grains.radius.begin(), body.grains.radius.end())};
}

/// Returns the work of gravity over a step on all bodies [J].
template <int dim>
double Dynamics<dim>::work_of_gravity() const
{
  ExactSum work;
  for (std::size_t i = moved().first; i < moved().end; ++i)
    work.add(dt * bodies().mass[i] * gravity.dot(at<dim>(bodies().velocity, i)));
  return part.totals({work})[0];
}

/// Returns how far a grain has gone at most [m]: infinite in a periodic body, whose images move with the cell too, and with rigid
/// groups, whose members turn.
template <int dim>
double Dynamics<dim>::integrate()
{
  const double farthest_way =
    move_bodies(bodies(), moved(), inverse_inertia, {previous_dt, dt, parameters.damping, gravity}, grips.freedom(),
                ledger.damping_work);
  if (!gravity.isZero(0.0))
    ledger.boundary_work += work_of_gravity();
  groups.carry_members(body.grains, dt);
  return body.is_periodic() || !groups.empty() ? std::numeric_limits<double>::infinity() : farthest_way;
}

template <int dim>
std::vector<Break> Dynamics<dim>::update_contacts(const double step, const double farthest_way)
{
  auto breaks = sweep_joints(
    body.joints, body.grains, step, sweep_memory,
    {sum_order.blocks_in_a_row, [&](const std::size_t block) { sum_forces_behind(block, body, sum_order); }});
  contact_made = touches.update(body, step, farthest_way) || contact_made;
  sum_remaining_forces(body, sum_order, touches);
  if (!body.smooth_joints.empty())
    {
      const auto smooth_breaks = sweep_smooth_joints(body, step);
      breaks.insert(breaks.end(), smooth_breaks.begin(), smooth_breaks.end());
      add_smooth_forces(body);
    }
  contact_made = wall_set.press(step, body, part) || contact_made;
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < applied_force[c].size(); ++i)
      body.grains.force[c][i] += applied_force[c][i];
  groups.gather(body.grains);
  return agree(std::move(breaks), step);
}

/// Called before and after the motion of a step with half of it each: the trapezoid of force over way.
template <int dim>
void Dynamics<dim>::add_boundary_work(const double step, const double share)
{
  for (std::size_t w = 0; w < wall_set.size(); ++w)
    ledger.boundary_work += share * step * wall_set[w].side * wall_set.force(w) * wall_set[w].velocity;
  for (std::size_t g = 0; g < grips.size(); ++g)
    ledger.boundary_work -= share * step * grip_force(g).dot(grips.velocity(g));
  if (const Tensor<dim>& rate = images.rate(); !rate.isZero())
    ledger.boundary_work += share * step * body.volume() * (boundary_stress().array() * rate.array()).sum();
}

template class Dynamics<2>;
template class Dynamics<3>;
} // namespace feldspar
