#include "dem/dynamics/dynamics.h"

#include "base/hdf5_archive.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "dem/dynamics/contact_stress.h"
#include "dem/dynamics/sweeps/smooth_sweep.h"
#include "dem/dynamics/time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace feldspar
{
namespace
{
template <int dim>
bool face_outlives_bonds(const Joints<dim>& joints)
{
  return std::visit([](const auto& law) { return law.face_outlives_bonds; }, joints.law);
}

/// 1, 0 or -1.
template <typename Real>
Real sign(const Real& value)
{
  return simd::select(value > 0.0, Real(1.0), simd::select(value < 0.0, Real(-1.0), Real(0.0)));
}
} // namespace

template <int dim>
Dynamics<dim>::Dynamics(Specimen<dim> specimen, const DynamicsParameters& wanted, const ZeroForce where)
  : body(std::move(specimen))
  , parameters(wanted)
  , zero_force(where)
  , images(body)
  , groups(body)
  , grips(bodies().size())
  , watch(body.grains)
  , ledger(bodies().size())
{
  if (body.periodic)
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

/// Of a free body at the last half step [J].
template <int dim>
double Dynamics<dim>::kinetic_energy(const std::uint32_t i) const
{
  const auto& grains = bodies();
  return grips.holds(i) ? 0.0
                        : 0.5 * grains.mass[i] * squared_norm<dim>(grains.velocity, i) +
                            0.5 * grains.moment_of_inertia[i] * squared_norm<n_rotations<dim>>(grains.spin, i);
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
  groups.gather(body.grains);
}

template <int dim>
std::vector<Break> Dynamics<dim>::step()
{
  if (!started)
    start();
  else if (watch_is_over() || faces_have_gone)
    {
      remove_lost_contacts();
      find_contacts();
      choose_time_step();
    }
  else if (contact_made)
    choose_time_step();

  add_boundary_work(dt, 0.5);
  integrate();
  wall_set.move(dt);
  if (body.periodic)
    images.move(dt, body.grains);
  auto breaks = update_contacts(dt);
  add_boundary_work(dt, 0.5);
  for (const auto& event : breaks)
    ledger.released += event.released_energy;
  faces_have_gone = !breaks.empty() && !face_outlives_bonds(body.joints);
  current_time += dt;
  previous_dt = dt;
  ++steps;
  return breaks;
}

/// Whether contacts must be searched for anew.
template <int dim>
bool Dynamics<dim>::watch_is_over()
{
  if (!watch.is_due(steps))
    return false;
  check_motion();
  return watch.may_miss_contacts(body, images.n_own(), wall_set, steps, dt);
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
  number_joints();
  find_contacts();
  check();
  zero_force = ZeroForce::at_touch; // the placing is over: later contacts begin where they touch
  update_contacts(0.0);
  check();
  choose_time_step();
  check();
  previous_dt = 0.0; // the first kick is half a step
  position_at_start = bodies().position;
  watch.begin_at(steps);
  started = true;
  const Energies initial = energies();
  ledger.kinetic_at_start = initial.kinetic;
  ledger.strain_at_start += initial.strain;
  check_motion(); // from the outside; a first step too long would take grains where no contact is looked for
}

/// After joints have gone.
template <int dim>
void Dynamics<dim>::number_joints()
{
  const auto& joints = body.joints;
  joints_of = incidence(
    images.n_own(), joints.size(), [&](const std::size_t j) { return GrainPair(joints.grain_1[j], joints.grain_2[j]); },
    [&](const std::uint32_t grain) { return images.owner(grain); });
  sum_order = SumOrder(joints_of);
  sweep_memory = SweepMemory<dim>(joints);
}

/// The grains of a joint that has lost its face may touch again.
template <int dim>
void Dynamics<dim>::remove_lost_contacts()
{
  auto& joints = body.joints;
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      if (has_face(joints, j))
        kept.push_back(j);
      else
        {
          Touch<dim> touch = make_touch(body, joints.grain_1[j], joints.grain_2[j]);
          touch.zero_distance = std::min(touch.zero_distance, joints.rest_distance[j]);
          // The energy that the face stored and the touch does not is released in sliding off.
          const double overlap = std::max(0.0, touch.zero_distance - joints.rest_distance[j] - joints.opening[j]);
          ledger.slip_of_lost_contacts +=
            joints.slip_energy[j] + joint_energy(joints, j) - 0.5 * touch.stiffness.normal * overlap * overlap;
          touches.add(touch);
        }
    }
  // Their grains may have rolled into each other while the sides were open: they touch from where they stand.
  for (const auto& [ends, energy] : remove_ended_smooth_joints(body))
    {
      ledger.slip_of_lost_contacts += energy;
      Touch<dim> touch = make_touch(body, ends.first, ends.second);
      touch.zero_distance =
        std::min(touch.zero_distance,
                 (at<dim>(body.grains.position, ends.second) - at<dim>(body.grains.position, ends.first)).norm());
      touches.add(touch);
    }
  if (kept.size() < joints.size())
    {
      joints.keep(kept);
      number_joints();
      touches.number(images);
    }
}

template <int dim>
void Dynamics<dim>::find_contacts()
{
  check_motion(); // the search could not place what stands nowhere
  if (body.periodic)
    images.add_within(watch.skin(), body.grains);
  touches.search(body, images, joints_of, watch.skin(), zero_force, ledger, check);
  wall_set.search(body, images.n_own(), watch.skin(), zero_force, ledger);
  watch.note_search(body.grains);
}

template <int dim>
void Dynamics<dim>::choose_time_step()
{
  const double largest = largest_stiffness_over_inertia(body, groups, images.n_own(), joints_of, touches, wall_set);
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
  if (const auto stray = find_stray_grain(body, images.n_own(), wall_set, dt))
    {
      Circumstances now = circumstances();
      now.through_wall = stray->through_wall;
      throw Runaway(describe_runaway(fmt::format("grain {} {}", stray->grain, stray->motion), now));
    }
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
  // At the start the contacts have not been looked for.
  const double largest =
    started ? largest_stiffness_over_inertia(body, groups, images.n_own(), joints_of, touches, wall_set) : 0.0;
  return {steps, dt, dt * std::sqrt(largest), fastest,
          *std::min_element(body.grains.radius.begin(), body.grains.radius.end())};
}

template <int dim>
void Dynamics<dim>::integrate()
{
  auto& grains = bodies();
  const double kick = 0.5 * (previous_dt + dt);
  // Of a pack of neighbouring grains or groups, or of one.
  const auto advance = [&]<typename Real>(Real, const std::size_t i, const Real& force,
                                          const std::vector<double>& inertia, std::vector<double>& velocity) {
    const Real old_velocity = simd::load<Real>(&velocity[i]);
    const Real is_free = simd::load<Real>(&grips.freedom()[i]);
    const Real damping_force = -parameters.damping * simd::absolute(force) * sign(old_velocity);
    const Real change = kick * (force + damping_force) * (1.0 / simd::load<Real>(&inertia[i]));
    const Real free_velocity = old_velocity + change;
    const Real work = 0.5 * damping_force * (previous_dt * old_velocity + dt * free_velocity);
    simd::store(old_velocity + is_free * change, &velocity[i]);
    simd::store(simd::load<Real>(&ledger.damping_work[i]) - is_free * work, &ledger.damping_work[i]);
  };
  const auto advance_all = [&]<typename Real>(Real real, const std::size_t i) {
    for (int c = 0; c < dim; ++c)
      {
        const Real weight = simd::load<Real>(&grains.mass[i]) * gravity[c];
        advance(real, i, simd::load<Real>(&grains.force[c][i]) + weight, grains.mass, grains.velocity[c]);
        const Real way = dt * simd::load<Real>(&grains.velocity[c][i]);
        simd::store(simd::load<Real>(&grains.position[c][i]) + way, &grains.position[c][i]);
      }
    for (int c = 0; c < n_rotations<dim>; ++c)
      advance(real, i, simd::load<Real>(&grains.couple[c][i]), grains.moment_of_inertia, grains.spin[c]);
  };
  for_each_block(n_bodies(), [&](std::size_t, const std::size_t begin, const std::size_t end) {
    std::size_t i = begin;
    for (; i + simd::width<simd::Pack> <= end; i += simd::width<simd::Pack>)
      advance_all(simd::Pack(), i);
    for (; i < end; ++i)
      advance_all(double(), i);
  });
  groups.carry_members(body.grains, dt);
}

template <int dim>
std::vector<Break> Dynamics<dim>::update_contacts(const double step)
{
  auto breaks = sweep_joints(body.joints, body.grains, step, sweep_memory);
  contact_made = touches.update(body.grains, body.particle_contact.friction, step) || contact_made;
  sum_forces(body, sum_order, touches);
  if (!body.smooth_joints.empty())
    {
      const auto smooth_breaks = sweep_smooth_joints(body, step);
      breaks.insert(breaks.end(), smooth_breaks.begin(), smooth_breaks.end());
      add_smooth_forces(body);
    }
  contact_made = wall_set.press(step, body) || contact_made;
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < applied_force[c].size(); ++i)
      {
        body.grains.force[c][i] += applied_force[c][i];
        ledger.boundary_work += step * applied_force[c][i] * body.grains.velocity[c][i];
      }
  groups.gather(body.grains);
  return breaks;
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

template <int dim>
Energies Dynamics<dim>::energies() const
{
  const auto& grains = bodies();
  const auto& joints = body.joints;
  Energies sum;
  if (steps == 0 && !started)
    {
      for (std::uint32_t i = 0; i < n_bodies(); ++i)
        sum.kinetic += kinetic_energy(i);
      sum.kinetic_at_start = sum.kinetic;
      return sum;
    }
  sum.boundary_work = ledger.boundary_work;
  sum.released = ledger.released;
  sum.slip = ledger.slip_of_lost_contacts;
  sum.kinetic_at_start = ledger.kinetic_at_start;
  sum.strain = -ledger.strain_at_start;

  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      sum.slip += joints.slip_energy[j];
      sum.strain += joint_energy(joints, j);
      sum.released += dissipated_by_bonds(joints, j);
    }
  sum = with_smooth_joints(wall_set.added_to(touches.added_to(sum), body), body);

  // ½ m v(n-½)·v(n+½), and half of the coming step's damping: the values at the current time.
  const double kick = 0.5 * (previous_dt + dt);
  const auto centre = [&](const double force, const double inertia, const double velocity) {
    const double damping_force = -parameters.damping * std::abs(force) * sign(velocity);
    sum.kinetic += 0.5 * inertia * velocity * (velocity + kick * (force + damping_force) / inertia);
    sum.damping -= 0.5 * damping_force * previous_dt * velocity;
  };
  for (std::size_t i = 0; i < n_bodies(); ++i)
    {
      sum.damping += ledger.damping_work[i];
      sum.boundary_work += grains.mass[i] * gravity.dot(at<dim>(grains.position, i) - at<dim>(position_at_start, i));
      if (grips.holds(i))
        continue;
      for (int c = 0; c < dim; ++c)
        centre(grains.force[c][i] + grains.mass[i] * gravity[c], grains.mass[i], grains.velocity[c][i]);
      for (int c = 0; c < n_rotations<dim>; ++c)
        centre(grains.couple[c][i], grains.moment_of_inertia[i], grains.spin[c][i]);
    }
  return sum;
}

template <int dim>
double Dynamics<dim>::unbalanced_force_ratio() const
{
  double unbalanced = 0.0;
  std::size_t n_free = 0;
  for (std::size_t i = 0; i < n_bodies(); ++i)
    if (!grips.holds(i))
      {
        unbalanced += std::sqrt(squared_norm<dim>(bodies().force, i));
        ++n_free;
      }
  const double carried = mean_contact_force(body, touches);
  return carried > 0.0 && n_free > 0 ? unbalanced / double(n_free) / carried : 0.0;
}

template <int dim>
double Dynamics<dim>::largest_unbalanced_force_ratio() const
{
  double largest = 0.0;
  for (std::size_t i = 0; i < n_bodies(); ++i)
    largest = std::max(largest, squared_norm<dim>(bodies().force, i));
  const double carried = mean_contact_force(body, touches);
  return carried > 0.0 ? std::sqrt(largest) / carried : 0.0;
}

template <int dim>
Tensor<dim> Dynamics<dim>::mean_stress() const
{
  return feldspar::mean_stress(body, touches, wall_set);
}

template <int dim>
std::vector<Tensor<dim>> Dynamics<dim>::grain_stresses() const
{
  return feldspar::grain_stresses(body, touches, wall_set);
}

template <int dim>
Tensor<dim> Dynamics<dim>::boundary_stress() const
{
  return feldspar::boundary_stress(body, touches, images);
}

template <int dim>
double Dynamics<dim>::force_across(const double height) const
{
  return feldspar::force_across(body, touches, height);
}

template <int dim>
double Dynamics<dim>::faceless_coordination_number() const
{
  const auto& all = touches.list();
  const auto n = std::count_if(all.begin(), all.end(), [](const Touch<dim>& touch) { return touch.touching; });
  return 2.0 * double(n) / double(images.n_own());
}

template <int dim>
template <typename Archive>
void Dynamics<dim>::transfer(Archive& archive)
{
  auto& grains = body.grains;
  const auto all_of = [&](const std::string& name, auto& components) {
    for (std::size_t c = 0; c < components.size(); ++c)
      archive.array(name + "_" + "xyz"[c], components[c]);
  };
  all_of("position", grains.position);
  all_of("velocity", grains.velocity);
  all_of("spin", grains.spin);
  all_of("force", grains.force);
  all_of("couple", grains.couple);
  all_of("applied_force", applied_force);
  all_of("position_at_start", position_at_start);
  images.transfer(archive, grains);
  groups.transfer(archive);

  auto& joints = body.joints;
  archive.array("grain_1", joints.grain_1);
  archive.array("grain_2", joints.grain_2);
  archive.array("number", joints.number);
  if constexpr (Archive::reads)
    joints.resize_all(joints.grain_1.size());
  const auto pass = [&](const std::string& name, auto& values) { transfer_numbers(archive, name, values); };
  joints.visit_per_joint(pass);
  joints.visit_per_segment(pass);
  const auto pass_all = [&](const std::string& name, auto& components) {
    for (std::size_t c = 0; c < components.size(); ++c)
      pass(name + "_" + "xyz"[c], components[c]);
  };
  pass_all("joint_force", joints.force);
  pass_all("joint_couple_1", joints.couple_1);
  pass_all("joint_couple_2", joints.couple_2);

  archive.bytes("smooth_joints", body.smooth_joints);
  touches.transfer(archive);
  wall_set.transfer(archive);
  watch.transfer(archive);
  ledger.transfer(archive);

  std::uint32_t flags = std::uint32_t(started) + 2 * std::uint32_t(contact_made) +
                        4 * std::uint32_t(zero_force == ZeroForce::as_placed) + 8 * std::uint32_t(faces_have_gone);
  archive.value("flags", flags);
  started = flags & 1;
  contact_made = flags & 2;
  faces_have_gone = flags & 8;
  zero_force = flags & 4 ? ZeroForce::as_placed : ZeroForce::at_touch;
  archive.value("steps", steps);
  archive.value("dt", dt);
  archive.value("previous_dt", previous_dt);
  archive.value("current_time", current_time);
  number_joints();
  touches.number(images);
}

template class Dynamics<2>;
template void Dynamics<2>::transfer(Hdf5Writer&);
template void Dynamics<2>::transfer(Hdf5Reader&);
template class Dynamics<3>;
template void Dynamics<3>::transfer(Hdf5Writer&);
template void Dynamics<3>::transfer(Hdf5Reader&);
} // namespace feldspar
