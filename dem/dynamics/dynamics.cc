#include "dem/dynamics/dynamics.h"

#include "base/hdf5_archive.h"
#include "base/parallel.h"
#include "dem/laws/contact_motion.h"
#include "dem/laws/joint_update.h"
#include "dem/specimen/neighbours.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

namespace feldspar
{
namespace
{
constexpr std::uint64_t most_steps_between_looks = 10; // for grains that have come near each other
constexpr double skin_over_smallest_radius = 0.3;
constexpr double wall_reach_over_skin = 0.25; // as near as a wall may come to a grain that is not in its list

double sign(const double value) { return double(value > 0.0) - double(value < 0.0); }

template <int dim, typename Values>
double squared_norm(const std::array<Values, dim>& components, const std::size_t i)
{
  double sum = 0.0;
  for (int c = 0; c < dim; ++c)
    sum += components[c][i] * components[c][i];
  return sum;
}
} // namespace

template <int dim>
Dynamics<dim>::Dynamics(Specimen<dim> specimen, const DynamicsParameters& wanted, const ZeroForce where)
  : body(std::move(specimen))
  , parameters(wanted)
  , zero_force(where)
  , n_own(body.grains.size())
  , cell(body.cell())
  , held(body.grains.size(), 0)
  , damping_work(body.grains.size(), 0.0)
{
  skin = skin_over_smallest_radius * *std::min_element(body.grains.radius.begin(), body.grains.radius.end());
  if (body.periodic)
    for (std::size_t j = 0; j < body.joints.size(); ++j)
      if (const auto second = body.second_of(j); second.boxes != std::array<int, dim>{})
        body.joints.grain_2[j] = image_number(second);
}

/// The number of an image among the grains; one that is not there yet is put behind them.
template <int dim>
std::uint32_t Dynamics<dim>::image_number(const PeriodicImage<dim>& image)
{
  auto& grains = body.grains;
  const auto [entry, is_new] = number_of_image.try_emplace(image, std::uint32_t(grains.size()));
  if (is_new)
    {
      images.push_back(image);
      const auto repeat = [&](std::vector<double>& values) { values.push_back(values[image.owner]); };
      for (auto* values : {&grains.radius, &grains.mass, &grains.moment_of_inertia})
        repeat(*values);
      for (auto* components : {&grains.position, &grains.velocity, &grains.force})
        for (auto& component : *components)
          repeat(component);
      for (auto* components : {&grains.spin, &grains.couple})
        for (auto& component : *components)
          repeat(component);
      set<dim>(grains.position, entry->second, at<dim>(grains.position, image.owner) + shift(image, cell));
    }
  return entry->second;
}

/// Gives every grain that could come near one of another box its images.
template <int dim>
void Dynamics<dim>::add_images()
{
  Grains<dim> own;
  own.radius.assign(body.grains.radius.begin(), body.grains.radius.begin() + std::ptrdiff_t(n_own));
  for (int c = 0; c < dim; ++c)
    own.position[c].assign(body.grains.position[c].begin(), body.grains.position[c].begin() + std::ptrdiff_t(n_own));
  for (const auto& image : images_within(own, cell, skin))
    image_number(image);
}

template <int dim>
void Dynamics<dim>::move_images()
{
  auto& grains = body.grains;
  for (std::size_t k = 0; k < images.size(); ++k)
    {
      const auto& image = images[k];
      const Vector<dim> way = shift(image, cell);
      const Vector<dim> faster = cell_rate * way;
      for (int c = 0; c < dim; ++c)
        {
          grains.position[c][n_own + k] = grains.position[c][image.owner] + way[c];
          grains.velocity[c][n_own + k] = grains.velocity[c][image.owner] + faster[c];
        }
      for (int c = 0; c < n_rotations<dim>; ++c)
        grains.spin[c][n_own + k] = grains.spin[c][image.owner];
    }
}

template <int dim>
std::size_t Dynamics<dim>::add_wall(const Wall& wall)
{
  wall_list.push_back(wall);
  wall_touches.emplace_back();
  wall_forces.push_back(0.0);
  wall_position_at_search.push_back(wall.position);
  return wall_list.size() - 1;
}

template <int dim>
std::size_t Dynamics<dim>::add_grip(std::vector<std::uint32_t> members, const Vector<dim>& velocity)
{
  for (const auto i : members)
    {
      held[i] = 1;
      set<dim>(body.grains.velocity, i, velocity);
    }
  grips.push_back({std::move(members), velocity});
  return grips.size() - 1;
}

template <int dim>
void Dynamics<dim>::push(const std::uint32_t grain, const Vector<dim>& more)
{
  const double before = kinetic_energy(grain);
  set<dim>(body.grains.velocity, grain, at<dim>(body.grains.velocity, grain) + more);
  if (started)
    kinetic_energy_at_start += kinetic_energy(grain) - before;
}

/// Of a free grain at the last half step [J].
template <int dim>
double Dynamics<dim>::kinetic_energy(const std::uint32_t i) const
{
  const auto& grains = body.grains;
  return held[i] ? 0.0
                 : 0.5 * grains.mass[i] * squared_norm<dim>(grains.velocity, i) +
                     0.5 * grains.moment_of_inertia[i] * squared_norm<n_rotations<dim>>(grains.spin, i);
}

template <int dim>
void Dynamics<dim>::deform_body(const Tensor<dim>& rate)
{
  const Tensor<dim> change = rate - cell_rate;
  const Vector<dim> middle = 0.5 * cell.rowwise().sum();
  if (!change.isZero(0.0))
    for (std::uint32_t i = 0; i < n_own; ++i)
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
}

template <int dim>
std::vector<Break> Dynamics<dim>::step()
{
  if (!started)
    start();
  else if (steps == next_look && contacts_may_be_missed())
    {
      remove_torn_faces();
      find_contacts();
      choose_time_step();
    }
  else if (contact_made)
    choose_time_step();

  add_boundary_work(dt, 0.5);
  integrate();
  for (auto& wall : wall_list)
    wall.position += dt * wall.velocity;
  if (body.periodic)
    {
      cell += dt * cell_rate * cell;
      move_images();
    }
  const auto breaks = update_contacts(dt);
  add_boundary_work(dt, 0.5);
  for (const auto& event : breaks)
    released_energy += event.released_energy;
  current_time += dt;
  previous_dt = dt;
  ++steps;
  return breaks;
}

template <int dim>
void Dynamics<dim>::restart()
{
  touches.clear();
  for (auto& list : wall_touches)
    list.clear();
  zero_force = ZeroForce::at_touch;
  started = false;
}

template <int dim>
void Dynamics<dim>::start()
{
  number_contacts();
  find_contacts();
  zero_force = ZeroForce::at_touch; // the placing is over: later contacts begin where they touch
  update_contacts(0.0);
  choose_time_step();
  previous_dt = 0.0; // the first kick is half a step
  position_at_start = body.grains.position;
  next_look = steps + 1;
  started = true;
  const Energies initial = energies();
  kinetic_energy_at_start = initial.kinetic;
  strain_energy_at_start += initial.strain;
}

template <int dim>
template <typename EndsOf>
typename Dynamics<dim>::Incidence Dynamics<dim>::incidence(const std::size_t n_contacts, EndsOf&& ends_of) const
{
  Incidence result;
  result.first.assign(n_own + 1, 0);
  for (std::size_t k = 0; k < n_contacts; ++k)
    {
      const auto [one, two] = ends_of(k);
      ++result.first[one + 1];
      ++result.first[owner(two) + 1];
    }
  for (std::size_t i = 0; i < n_own; ++i)
    result.first[i + 1] += result.first[i];
  auto next = result.first;
  result.entries.resize(2 * n_contacts);
  for (std::size_t k = 0; k < n_contacts; ++k)
    {
      const auto [one, two] = ends_of(k);
      result.entries[next[one]++] = std::uint32_t(2 * k);
      result.entries[next[owner(two)]++] = std::uint32_t(2 * k + 1);
    }
  return result;
}

template <int dim>
typename Dynamics<dim>::Touch Dynamics<dim>::new_touch(const std::uint32_t grain_1, const std::uint32_t grain_2) const
{
  const double radius_1 = body.grains.radius[grain_1];
  const double radius_2 = body.grains.radius[grain_2];
  const double k_n = touch_stiffness(radius_1, radius_2);
  Touch touch{};
  touch.grain_1 = grain_1;
  touch.grain_2 = grain_2;
  touch.stiffness = {k_n, k_n / body.particle_contact.stiffness_ratio};
  touch.zero_distance = radius_1 + radius_2;
  touch.half_radius_difference = 0.5 * (radius_1 - radius_2);
  return touch;
}

/// Where a pair stands, or would stand, among the touches.
template <int dim>
auto Dynamics<dim>::find_touch(const GrainPair& pair)
{
  return std::lower_bound(touches.begin(), touches.end(), pair,
                          [](const Touch& touch, const GrainPair& wanted) { return touch.ends() < wanted; });
}

/// After joints or touches have come or gone.
template <int dim>
void Dynamics<dim>::number_contacts()
{
  const auto& joints = body.joints;
  joint_incidence =
    incidence(joints.size(), [&](const std::size_t j) { return GrainPair(joints.grain_1[j], joints.grain_2[j]); });
  touch_incidence = incidence(touches.size(), [&](const std::size_t k) { return touches[k].ends(); });
  looks.clear();
  for (const auto& touch : touches)
    looks.push_back({touch.grain_1, touch.grain_2, touch.zero_distance, touch.touching});
}

/// Stored in the segments of a joint [J].
template <int dim>
double Dynamics<dim>::joint_energy(const std::size_t j) const
{
  const auto& joints = body.joints;
  const Face<double> face{joints.normal_stiffness[j], joints.shear_stiffness[j], joints.half_length[j],
                          joints.thickness, joints.friction};
  std::array<double, n_rotations<dim>> rotation;
  for (int c = 0; c < n_rotations<dim>; ++c)
    rotation[c] = joints.rotation[c][j];
  const auto shear_stress_of = [&](const unsigned int i) {
    std::array<double, dim - 1> tau;
    for (int c = 0; c < dim - 1; ++c)
      tau[c] = joints.shear_stress[c][joints.segment(i, j)];
    return tau;
  };
  const auto bonded_of = [&](const unsigned int i) { return joints.bonded[joints.segment(i, j)] > 0.5; };
  return face_energy(face, joints.elements, joints.opening[j], rotation, shear_stress_of, bonded_of);
}

/// A joint loses its faces when nothing holds and they have slid or opened past each other; the pair may touch again.
template <int dim>
void Dynamics<dim>::remove_torn_faces()
{
  auto& joints = body.joints;
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const double reach = 2.0 * joints.half_length[j];
      std::array<double, dim - 1> slip;
      for (int c = 0; c < dim - 1; ++c)
        slip[c] = joints.slip[c][j];
      if ((flat_joint::magnitude(slip) <= reach && joints.opening[j] <= reach) || joints.holds(j))
        kept.push_back(j);
      else
        {
          Touch touch = new_touch(joints.grain_1[j], joints.grain_2[j]);
          touch.zero_distance = std::min(touch.zero_distance, joints.rest_distance[j]);
          // What the face stored and the touch does not is let go in sliding off.
          const double overlap = std::max(0.0, touch.zero_distance - joints.rest_distance[j] - joints.opening[j]);
          slip_energy_of_lost_contacts +=
            joints.slip_energy[j] + joint_energy(j) - 0.5 * touch.stiffness.normal * overlap * overlap;
          touches.insert(find_touch(touch.ends()), touch);
        }
    }
  if (kept.size() < joints.size())
    {
      joints.keep(kept);
      number_contacts();
    }
}

template <int dim>
void Dynamics<dim>::find_contacts()
{
  if (body.periodic)
    add_images();
  const auto& grains = body.grains;
  const auto& joints = body.joints;
  std::vector<Touch> found;
  std::vector<std::uint32_t> jointed_to(grains.size(), std::numeric_limits<std::uint32_t>::max());
  std::uint32_t marked = std::numeric_limits<std::uint32_t>::max();
  for (const auto& [one, two] : pairs_within(grains, skin))
    {
      if (one >= n_own || (two >= n_own && !counts(one, images[two - n_own])))
        continue;
      if (one != marked)
        {
          for (auto k = joint_incidence.first[one]; k < joint_incidence.first[one + 1]; ++k)
            {
              const auto j = joint_incidence.entries[k] / 2;
              if (joints.grain_1[j] == one)
                jointed_to[joints.grain_2[j]] = one;
            }
          marked = one;
        }
      if (jointed_to[two] == one)
        continue;
      const GrainPair pair(one, two);
      if (const auto known = find_touch(pair); known != touches.end() && known->ends() == pair)
        found.push_back(*known);
      else
        {
          found.push_back(new_touch(one, two));
          if (zero_force == ZeroForce::as_placed)
            found.back().zero_distance = std::min(
              found.back().zero_distance, (at<dim>(grains.position, two) - at<dim>(grains.position, one)).norm());
        }
    }
  std::size_t next = 0;
  for (const auto& touch : touches)
    {
      while (next < found.size() && found[next].ends() < touch.ends())
        ++next;
      if (next == found.size() || found[next].ends() != touch.ends())
        slip_energy_of_lost_contacts += touch.slip_energy;
    }
  touches = std::move(found);
  number_contacts();

  for (std::size_t w = 0; w < wall_list.size(); ++w)
    {
      const Wall& wall = wall_list[w];
      const auto& before = wall_touches[w]; // ascending, as `near` will be
      auto known = before.begin();
      std::vector<WallTouch> near;
      for (std::uint32_t i = 0; i < grains.size(); ++i)
        {
          const double distance = (wall_coordinate(wall, i) - wall.position) * wall.side;
          if (distance > grains.radius[i] + skin)
            continue;
          for (; known != before.end() && known->grain < i; ++known)
            slip_energy_of_lost_contacts += known->slip_energy;
          if (known != before.end() && known->grain == i)
            near.push_back(*known++);
          else
            near.push_back(
              {i, zero_force == ZeroForce::as_placed ? std::min(grains.radius[i], distance) : grains.radius[i]});
        }
      for (; known != before.end(); ++known)
        slip_energy_of_lost_contacts += known->slip_energy;
      wall_touches[w] = std::move(near);
      wall_position_at_search[w] = wall.position;
    }
  position_at_search = grains.position;
}

/// Of the gaps between a wall and the grains that were not near it at the last search, the smallest [m].
template <int dim>
double Dynamics<dim>::smallest_gap_not_listed(const std::size_t w) const
{
  const Wall& wall = wall_list[w];
  double smallest = std::numeric_limits<double>::max();
  auto listed = wall_touches[w].begin(); // in the order of the grains
  for (std::uint32_t i = 0; i < body.grains.size(); ++i)
    if (listed != wall_touches[w].end() && listed->grain == i)
      ++listed;
    else
      smallest = std::min(smallest, (wall_coordinate(wall, i) - wall.position) * wall.side - body.grains.radius[i]);
  return smallest;
}

/// Whether a pair that was not near at the last search could touch before the next look; sets when that is.
template <int dim>
bool Dynamics<dim>::contacts_may_be_missed()
{
  double farthest = 0.0;
  double fastest = 0.0;
  for (std::size_t i = 0; i < n_own; ++i)
    {
      farthest = std::max(farthest, (at<dim>(body.grains.position, i) - at<dim>(position_at_search, i)).squaredNorm());
      fastest = std::max(fastest, squared_norm<dim>(body.grains.velocity, i));
    }
  // Twice the way of the fastest, for what accelerates meanwhile; half the skin, for both grains move.
  const double way_of_a_step = 2.0 * dt * std::sqrt(fastest);
  const double way_left = 0.5 * skin - std::sqrt(farthest);
  bool missed = way_left <= double(most_steps_between_looks) * way_of_a_step;
  double steps_allowed = 0.5 * skin / std::max(way_of_a_step, std::numeric_limits<double>::min());
  // Grains keep to half the skin, so that a wall must have gone the rest of it to be near one that is not listed. One
  // that pushes grains before it finds none: the grains' own way has brought on a search before.
  const double reach = wall_reach_over_skin * skin;
  for (std::size_t w = 0; w < wall_list.size(); ++w)
    if (const Wall& wall = wall_list[w]; wall.velocity != 0.0)
      {
        steps_allowed = std::min(steps_allowed, reach / (way_of_a_step + 2.0 * dt * std::abs(wall.velocity)));
        if (std::abs(wall.position - wall_position_at_search[w]) > 0.5 * skin - reach)
          missed = missed || smallest_gap_not_listed(w) < reach;
      }
  next_look = steps + std::uint64_t(std::clamp(steps_allowed, 1.0, double(most_steps_between_looks)));
  return missed;
}

template <int dim>
double Dynamics<dim>::touch_stiffness(const double radius_1, const double radius_2) const
{
  return feldspar::touch_stiffness<dim>(body.particle_contact.modulus, radius_1, radius_2, body.thickness);
}

template <int dim>
double Dynamics<dim>::wall_stiffness(const double radius) const
{
  const double modulus = body.particle_contact.modulus;
  return dim == 2 ? 2.0 * modulus * body.thickness : std::numbers::pi * modulus * radius;
}

/// Safety × min over grains of √(m/k) and √(I/k_rot); theory.md §2.2.
template <int dim>
void Dynamics<dim>::choose_time_step()
{
  const auto& grains = body.grains;
  const auto& joints = body.joints;
  Components<dim> k;
  resize<dim>(k, n_own);
  Components<n_rotations<dim>> k_turning;
  resize<n_rotations<dim>>(k_turning, n_own);
  const auto add = [&](const std::uint32_t i, const auto& normal, const double k_n, const double k_s, const double arm,
                       const double k_bending, const double k_twist) {
    for (int c = 0; c < dim; ++c)
      k[c][i] += k_n * normal[c] * normal[c] + k_s * (1.0 - normal[c] * normal[c]);
    for (int c = 0; c < n_rotations<dim>; ++c)
      {
        const double axial = dim == 3 ? normal[c] * normal[c] : 0.0; // discs turn about an axis across every normal
        k_turning[c][i] += (k_s * arm * arm + k_bending) * (1.0 - axial) + k_twist * axial;
      }
  };
  for_each_block(n_own, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (auto i = std::uint32_t(begin); i < end; ++i)
      {
        for (auto e = joint_incidence.first[i]; e < joint_incidence.first[i + 1]; ++e)
          {
            const std::uint32_t j = joint_incidence.entries[e] / 2;
            const bool is_second = joint_incidence.entries[e] % 2;
            const double area = joints.face_area(j);
            const double k_bending = joints.normal_stiffness[j] * joints.face_second_moment(j);
            const double k_twist = joints.shear_stiffness[j] * joints.face_polar_moment(j);
            const auto a = arms(joints.rest_distance[j] + joints.opening[j], joints.half_radius_difference[j]);
            add(i, at<dim>(joints.normal, j), joints.normal_stiffness[j] * area, joints.shear_stiffness[j] * area,
                is_second ? a.two : a.one, k_bending, k_twist);
          }
        for (auto e = touch_incidence.first[i]; e < touch_incidence.first[i + 1]; ++e)
          {
            const Touch& touch = touches[touch_incidence.entries[e] / 2];
            const bool is_second = touch_incidence.entries[e] % 2;
            if (!touch.touching)
              continue;
            const double k_s = body.particle_contact.friction > 0.0 ? touch.stiffness.shear : 0.0;
            const auto a = arms(touch.frame.distance, touch.half_radius_difference);
            add(i, touch.frame.normal, touch.stiffness.normal, k_s, is_second ? a.two : a.one, 0.0, 0.0);
          }
      }
  });
  for (std::size_t w = 0; w < wall_list.size(); ++w)
    for (const auto& touch : wall_touches[w])
      if (touch.overlap > 0.0)
        {
          const double k_n = wall_stiffness(grains.radius[touch.grain]);
          const double k_s = wall_list[w].friction > 0.0 ? k_n / body.particle_contact.stiffness_ratio : 0.0;
          add(touch.grain, wall_direction(wall_list[w], touch.grain), k_n, k_s, touch.zero_distance - touch.overlap,
              0.0, 0.0);
        }

  double largest = 0.0;
  for (std::size_t i = 0; i < n_own; ++i)
    {
      for (int c = 0; c < dim; ++c)
        largest = std::max(largest, k[c][i] / grains.mass[i]);
      for (int c = 0; c < n_rotations<dim>; ++c)
        largest = std::max(largest, k_turning[c][i] / grains.moment_of_inertia[i]);
    }
  if (largest == 0.0) // nothing touches: the stiffest contact a grain could make
    for (std::size_t i = 0; i < n_own; ++i)
      largest = std::max(largest, 4.0 * touch_stiffness(grains.radius[i], grains.radius[i]) / grains.mass[i]);
  dt = parameters.time_step_safety / std::sqrt(largest);
  contact_made = false;
}

template <int dim>
void Dynamics<dim>::integrate()
{
  auto& grains = body.grains;
  // Component by component, without branches and with copies of the members: so the compiler can make packs of it.
  const double step = dt;
  const double step_before = previous_dt;
  const double kick = 0.5 * (step_before + step);
  const double alpha = parameters.damping;
  const auto advance = [=, this](const std::size_t begin, const std::size_t end, const auto& force_on,
                                 const std::vector<double>& inertia, std::vector<double>& velocities) {
    const double* const inertia_of = inertia.data();
    const std::uint8_t* const is_held = held.data();
    double* const velocity = velocities.data();
    double* const dissipated = damping_work.data();
    for (std::size_t i = begin; i < end; ++i)
      {
        const double force = force_on(i);
        const double old_velocity = velocity[i];
        const double damping_force = -alpha * std::abs(force) * sign(old_velocity);
        const double free_velocity = old_velocity + kick * (force + damping_force) * (1.0 / inertia_of[i]);
        const double work = 0.5 * damping_force * (step_before * old_velocity + step * free_velocity);
        velocity[i] = is_held[i] ? old_velocity : free_velocity;
        dissipated[i] -= is_held[i] ? 0.0 : work;
      }
  };
  for_each_block(n_own, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (int c = 0; c < dim; ++c)
      {
        const auto force_on = [force = grains.force[c].data(), mass = grains.mass.data(),
                               pull = gravity[c]](const std::size_t i) { return force[i] + mass[i] * pull; };
        advance(begin, end, force_on, grains.mass, grains.velocity[c]);
        for (std::size_t i = begin; i < end; ++i)
          grains.position[c][i] += step * grains.velocity[c][i];
      }
    for (int c = 0; c < n_rotations<dim>; ++c)
      advance(
        begin, end, [couple = grains.couple[c].data()](const std::size_t i) { return couple[i]; },
        grains.moment_of_inertia, grains.spin[c]);
  });
}

template <int dim>
std::vector<Break> Dynamics<dim>::update_contacts(const double step)
{
  auto breaks = sweep_joints(body.joints, body.grains, step);
  update_touches(step);
  sum_forces();
  press_walls(step);
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < applied_force[c].size(); ++i)
      {
        body.grains.force[c][i] += applied_force[c][i];
        boundary_work += step * applied_force[c][i] * body.grains.velocity[c][i];
      }
  return breaks;
}

template <int dim>
void Dynamics<dim>::update_touches(const double step)
{
  const auto& grains = body.grains;
  const double friction = body.particle_contact.friction;
  for_each_block(touches.size(), [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      {
        TouchLook& look = looks[k];
        std::array<double, dim> centre_1, centre_2;
        double squared = 0.0;
        for (int c = 0; c < dim; ++c)
          {
            centre_1[c] = grains.position[c][look.grain_1];
            centre_2[c] = grains.position[c][look.grain_2];
            squared += (centre_2[c] - centre_1[c]) * (centre_2[c] - centre_1[c]);
          }
        const bool was_touching = look.touching;
        look.touching = squared < look.zero_distance * look.zero_distance;
        if (!was_touching && !look.touching)
          continue; // as it was; most of those that are kept in mind never touch
        Touch& touch = touches[k];
        touch.touching = look.touching;
        if (!look.touching)
          {
            // Sliding apart dissipates the shear that was stored.
            for (const double shear : touch.shear_force)
              touch.slip_energy += 0.5 * shear * shear / touch.stiffness.shear;
            touch.normal_force = 0.0;
            touch.shear_force = {};
            touch.force = {};
            touch.couple_1 = {};
            touch.couple_2 = {};
            continue;
          }
        std::array<double, dim - 1> slip{};
        if (was_touching && friction > 0.0)
          {
            std::array<double, n_rotations<dim>> turn_1, turn_2;
            for (int c = 0; c < n_rotations<dim>; ++c)
              {
                turn_1[c] = step * grains.spin[c][touch.grain_1];
                turn_2[c] = step * grains.spin[c][touch.grain_2];
              }
            const auto motion =
              contact_motion(touch.frame, centre_1, centre_2, touch.half_radius_difference, turn_1, turn_2);
            touch.frame = motion.frame;
            slip = motion.slip;
          }
        else
          {
            touch.frame = contact_frame<dim, double>(centre_1, centre_2);
            if constexpr (dim == 3)
              touch.frame.tangent = space::tangent_to(touch.frame.normal);
          }
        const auto response = linear_contact::update<dim>(touch.stiffness, friction, touch.shear_force,
                                                          touch.zero_distance - touch.frame.distance, slip);
        if (!was_touching)
          std::atomic_ref(contact_made).store(true, std::memory_order_relaxed); // several threads may say so
        touch.normal_force = response.normal_force;
        touch.shear_force = response.shear_force;
        touch.slip_energy += response.slip_energy;
        const auto answer = contact_force(touch.frame, touch.half_radius_difference, response.normal_force,
                                          response.shear_force, std::array<double, n_rotations<dim>>{});
        touch.force = answer.force;
        touch.couple_1 = answer.couple_1;
        touch.couple_2 = answer.couple_2;
      }
  });
}

template <int dim>
void Dynamics<dim>::sum_forces()
{
  auto& grains = body.grains;
  const auto& joints = body.joints;
  for_each_block(n_own, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      {
        std::array<double, dim> force{};
        std::array<double, n_rotations<dim>> couple{};
        for (auto e = joint_incidence.first[i]; e < joint_incidence.first[i + 1]; ++e)
          {
            // Answers of joints with grains of lower numbers lie far back: asked for some grains ahead.
            if (constexpr std::size_t ahead = 32; e + ahead < joint_incidence.entries.size())
              {
                const double* const later = joints.answer.at(0, joint_incidence.entries[e + ahead] / 2);
                __builtin_prefetch(later);
                __builtin_prefetch(later + joints.n_answer_rows - 1);
              }
            const std::uint32_t entry = joint_incidence.entries[e];
            const std::uint32_t j = entry / 2;
            const bool is_second = entry % 2;
            const double direction = is_second ? 1.0 : -1.0;
            const double* const answer = joints.answer.at(0, j);
            for (int c = 0; c < dim; ++c)
              force[c] += direction * answer[joints.first_force + c];
            for (int c = 0; c < n_rotations<dim>; ++c)
              couple[c] += answer[(is_second ? joints.first_couple_2 : 0) + c];
          }
        for (auto e = touch_incidence.first[i]; e < touch_incidence.first[i + 1]; ++e)
          {
            const std::uint32_t entry = touch_incidence.entries[e];
            if (!looks[entry / 2].touching)
              continue;
            const Touch& touch = touches[entry / 2];
            const double direction = entry % 2 ? 1.0 : -1.0;
            for (int c = 0; c < dim; ++c)
              force[c] += direction * touch.force[c];
            for (int c = 0; c < n_rotations<dim>; ++c)
              couple[c] += (entry % 2 ? touch.couple_2 : touch.couple_1)[c];
          }
        for (int c = 0; c < dim; ++c)
          grains.force[c][i] = force[c];
        for (int c = 0; c < n_rotations<dim>; ++c)
          grains.couple[c][i] = couple[c];
      }
  });
}

/// Along which the coordinate of a wall grows.
template <int dim>
Vector<dim> Dynamics<dim>::wall_direction(const Wall& wall, const std::uint32_t grain) const
{
  if (!wall.round)
    return Vector<dim>::Unit(wall.axis);
  Vector<dim> from_axis = at<dim>(body.grains.position, grain) - 0.5 * body.size;
  from_axis[dim - 1] = 0.0;
  return from_axis.normalized();
}

template <int dim>
double Dynamics<dim>::wall_coordinate(const Wall& wall, const std::uint32_t grain) const
{
  if (!wall.round)
    return body.grains.position[wall.axis][grain];
  return body.distance_from_axis(at<dim>(body.grains.position, grain));
}

template <int dim>
void Dynamics<dim>::press_walls(const double step)
{
  auto& grains = body.grains;
  for (std::size_t w = 0; w < wall_list.size(); ++w)
    {
      const Wall& wall = wall_list[w];
      double sum = 0.0;
      for (auto& touch : wall_touches[w])
        {
          const std::uint32_t i = touch.grain;
          const double distance = (wall_coordinate(wall, i) - wall.position) * wall.side;
          const double k_n = wall_stiffness(grains.radius[i]);
          const double overlap = touch.zero_distance - distance;
          if (touch.overlap == 0.0 && overlap > 0.0)
            contact_made = true;
          // A grain that begins to touch, or a smooth wall, gathers no shear.
          std::array<double, dim - 1> slip{};
          if (wall.friction > 0.0 && touch.overlap > 0.0)
            slip = slip_on_wall(wall, i, distance, step);
          const auto response = linear_contact::update<dim>({k_n, k_n / body.particle_contact.stiffness_ratio},
                                                            wall.friction, touch.shear_force, overlap, slip);
          touch.overlap = std::max(0.0, overlap);
          touch.shear_force = response.shear_force;
          touch.slip_energy += response.slip_energy;
          if (wall.round)
            set<dim>(grains.force, i,
                     at<dim>(grains.force, i) + wall.side * response.normal_force * wall_direction(wall, i));
          else
            grains.force[wall.axis][i] += wall.side * response.normal_force;
          if (wall.friction > 0.0)
            add_wall_shear(wall, i, distance, response.shear_force);
          sum += response.normal_force;
        }
      wall_forces[w] = sum;
    }
}

template <int dim>
double Dynamics<dim>::wall_stiffness_in_touch(const std::size_t wall) const
{
  double sum = 0.0;
  for (const auto& touch : wall_touches[wall])
    if (touch.overlap > 0.0)
      sum += wall_stiffness(body.grains.radius[touch.grain]);
  return sum;
}

template <int dim>
Vector<dim> Dynamics<dim>::grip_force(const std::size_t grip) const
{
  Vector<dim> sum = Vector<dim>::Zero();
  for (const auto i : grips[grip].members)
    sum += at<dim>(body.grains.force, i);
  return sum;
}

/// Called before and after the motion of a step with half of it each: the trapezoid of force over way.
template <int dim>
void Dynamics<dim>::add_boundary_work(const double step, const double share)
{
  for (std::size_t w = 0; w < wall_list.size(); ++w)
    boundary_work += share * step * wall_list[w].side * wall_forces[w] * wall_list[w].velocity;
  for (std::size_t g = 0; g < grips.size(); ++g)
    boundary_work -= share * step * grip_force(g).dot(grips[g].velocity);
  if (!cell_rate.isZero())
    boundary_work += share * step * body.volume() * (boundary_stress().array() * cell_rate.array()).sum();
}

template <int dim>
Energies Dynamics<dim>::energies() const
{
  const auto& grains = body.grains;
  const auto& joints = body.joints;
  Energies sum;
  if (steps == 0 && !started)
    {
      for (std::uint32_t i = 0; i < n_own; ++i)
        sum.kinetic += kinetic_energy(i);
      sum.kinetic_at_start = sum.kinetic;
      return sum;
    }
  sum.boundary_work = boundary_work;
  sum.released = released_energy;
  sum.slip = slip_energy_of_lost_contacts;
  sum.kinetic_at_start = kinetic_energy_at_start;
  sum.strain = -strain_energy_at_start;

  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      sum.slip += joints.slip_energy[j];
      sum.strain += joint_energy(j);
    }
  for (const auto& touch : touches)
    {
      sum.slip += touch.slip_energy;
      sum.strain += 0.5 * touch.normal_force * touch.normal_force / touch.stiffness.normal;
      for (const double shear : touch.shear_force)
        sum.strain += 0.5 * shear * shear / touch.stiffness.shear;
    }
  for (const auto& list : wall_touches)
    for (const auto& touch : list)
      {
        const double k_n = wall_stiffness(grains.radius[touch.grain]);
        sum.slip += touch.slip_energy;
        sum.strain += 0.5 * k_n * touch.overlap * touch.overlap;
        for (const double shear : touch.shear_force)
          sum.strain += 0.5 * shear * shear / (k_n / body.particle_contact.stiffness_ratio);
      }

  // ½ m v(n-½)·v(n+½), and half of the coming step's damping: the values at the current time.
  const double kick = 0.5 * (previous_dt + dt);
  const auto centre = [&](const double force, const double inertia, const double velocity) {
    const double damping_force = -parameters.damping * std::abs(force) * sign(velocity);
    sum.kinetic += 0.5 * inertia * velocity * (velocity + kick * (force + damping_force) / inertia);
    sum.damping -= 0.5 * damping_force * previous_dt * velocity;
  };
  for (std::size_t i = 0; i < n_own; ++i)
    {
      sum.damping += damping_work[i];
      sum.boundary_work += grains.mass[i] * gravity.dot(at<dim>(grains.position, i) - at<dim>(position_at_start, i));
      if (held[i])
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
  for (std::size_t i = 0; i < n_own; ++i)
    if (!held[i])
      {
        unbalanced += std::sqrt(squared_norm<dim>(body.grains.force, i));
        ++n_free;
      }
  const double carried = mean_contact_force();
  return carried > 0.0 && n_free > 0 ? unbalanced / double(n_free) / carried : 0.0;
}

template <int dim>
double Dynamics<dim>::largest_unbalanced_force_ratio() const
{
  double largest = 0.0;
  for (std::size_t i = 0; i < n_own; ++i)
    largest = std::max(largest, squared_norm<dim>(body.grains.force, i));
  const double carried = mean_contact_force();
  return carried > 0.0 ? std::sqrt(largest) / carried : 0.0;
}

/// Over the joints and the pairs that touch [N]; 0 without any.
template <int dim>
double Dynamics<dim>::mean_contact_force() const
{
  double sum = 0.0;
  std::size_t n_contacts = body.joints.size();
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    sum += std::sqrt(squared_norm<dim>(body.joints.force, j));
  for (const auto& touch : touches)
    if (touch.touching)
      {
        sum += std::hypot(touch.normal_force, flat_joint::magnitude(touch.shear_force));
        ++n_contacts;
      }
  return n_contacts > 0 ? sum / double(n_contacts) : 0.0;
}

template <int dim>
Tensor<dim> Dynamics<dim>::mean_stress() const
{
  const auto& grains = body.grains;
  Tensor<dim> sum = Tensor<dim>::Zero();
  const auto add = [&](const Vector<dim>& force, const std::uint32_t one, const std::uint32_t two) {
    sum -= force * (at<dim>(grains.position, two) - at<dim>(grains.position, one)).transpose();
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(at<dim>(body.joints.force, j), body.joints.grain_1[j], body.joints.grain_2[j]);
  for (const auto& touch : touches)
    add(Eigen::Map<const Vector<dim>>(touch.force.data()), touch.grain_1, touch.grain_2);
  for (std::size_t w = 0; w < wall_list.size(); ++w)
    for (const auto& touch : wall_touches[w])
      {
        const Vector<dim> normal = wall_direction(wall_list[w], touch.grain);
        const double distance = std::abs(wall_coordinate(wall_list[w], touch.grain) - wall_list[w].position);
        sum -= wall_stiffness(grains.radius[touch.grain]) * touch.overlap * distance * (normal * normal.transpose());
      }
  return sum / body.volume();
}

template <int dim>
Tensor<dim> Dynamics<dim>::boundary_stress() const
{
  Tensor<dim> sum = Tensor<dim>::Zero();
  const auto add = [&](const Vector<dim>& force, const std::uint32_t two) {
    if (two >= n_own)
      sum -= force * shift(images[two - n_own], cell).transpose();
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(at<dim>(body.joints.force, j), body.joints.grain_2[j]);
  for (const auto& touch : touches)
    add(Eigen::Map<const Vector<dim>>(touch.force.data()), touch.grain_2);
  return sum / body.volume();
}

template <int dim>
double Dynamics<dim>::force_across(const double height) const
{
  const auto& y = body.grains.position[dim - 1];
  double sum = 0.0;
  const auto add = [&](const double force, const std::uint32_t one, const std::uint32_t two) {
    if ((y[one] < height) != (y[two] < height))
      sum += y[two] < height ? -force : force;
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    add(body.joints.force[dim - 1][j], body.joints.grain_1[j], body.joints.grain_2[j]);
  for (const auto& touch : touches)
    add(touch.force[dim - 1], touch.grain_1, touch.grain_2);
  return sum;
}

template <int dim>
double Dynamics<dim>::faceless_coordination_number() const
{
  const auto n = std::count_if(touches.begin(), touches.end(), [](const Touch& touch) { return touch.touching; });
  return 2.0 * double(n) / double(n_own);
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
  all_of("position_at_search", position_at_search);
  all_of("position_at_start", position_at_start);
  archive.array("damping_work", damping_work);

  // Of a periodic body.
  archive.bytes("images", images);
  for (int c = 0; c < dim; ++c)
    for (int r = 0; r < dim; ++r)
      {
        archive.value(std::string("cell_") + "xyz"[r] + "xyz"[c], cell(r, c));
        archive.value(std::string("cell_rate_") + "xyz"[r] + "xyz"[c], cell_rate(r, c));
      }
  number_of_image.clear();
  for (std::size_t k = 0; k < images.size(); ++k)
    number_of_image[images[k]] = std::uint32_t(n_own + k);
  for (auto* values : {&grains.radius, &grains.mass, &grains.moment_of_inertia})
    {
      values->resize(n_own);
      for (const auto& image : images)
        values->push_back((*values)[image.owner]);
    }

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

  archive.bytes("touches", touches);
  archive.bytes("walls", wall_list);
  archive.array("wall_forces", wall_forces);
  archive.array("wall_position_at_search", wall_position_at_search);
  for (std::size_t w = 0; w < wall_list.size(); ++w)
    archive.bytes("wall_touches_" + std::to_string(w), wall_touches[w]);

  std::uint32_t flags =
    std::uint32_t(started) + 2 * std::uint32_t(contact_made) + 4 * std::uint32_t(zero_force == ZeroForce::as_placed);
  archive.value("flags", flags);
  started = flags & 1;
  contact_made = flags & 2;
  zero_force = flags & 4 ? ZeroForce::as_placed : ZeroForce::at_touch;
  archive.value("steps", steps);
  archive.value("next_look", next_look);
  archive.value("dt", dt);
  archive.value("previous_dt", previous_dt);
  archive.value("current_time", current_time);
  archive.value("boundary_work", boundary_work);
  archive.value("released_energy", released_energy);
  archive.value("strain_energy_at_start", strain_energy_at_start);
  archive.value("kinetic_energy_at_start", kinetic_energy_at_start);
  archive.value("slip_energy_of_lost_contacts", slip_energy_of_lost_contacts);
  number_contacts();
}

/// The wall is grain 1, without rotation; n points from it to the grain, t = n turned by +90°.
template <>
std::array<double, 1> Dynamics<2>::slip_on_wall(const Wall& wall, const std::uint32_t grain, const double distance,
                                                const double step) const
{
  const int along = 1 - wall.axis;
  const double tangent = wall.axis == 0 ? wall.side : -wall.side; // t = (-n_y, n_x)
  return {step * (tangent * body.grains.velocity[along][grain] - distance * body.grains.spin[0][grain])};
}

template <>
void Dynamics<2>::add_wall_shear(const Wall& wall, const std::uint32_t grain, const double distance,
                                 const std::array<double, 1>& shear_force)
{
  const int along = 1 - wall.axis;
  const double tangent = wall.axis == 0 ? wall.side : -wall.side;
  body.grains.force[along][grain] += tangent * shear_force[0];
  body.grains.couple[0][grain] -= distance * shear_force[0];
}

/// Planes only. The shear force has components along the two other axes, in cyclic order.
template <>
std::array<double, 2> Dynamics<3>::slip_on_wall(const Wall& wall, const std::uint32_t grain, const double distance,
                                                const double step) const
{
  const int one = (wall.axis + 1) % 3;
  const int two = (wall.axis + 2) % 3;
  // The contact lies at -d n from the centre, n along `side` of the axis: v + ω × (-d n).
  const double arm = distance * wall.side;
  const auto& velocity = body.grains.velocity;
  const auto& spin = body.grains.spin;
  return {step * (velocity[one][grain] - arm * spin[two][grain]),
          step * (velocity[two][grain] + arm * spin[one][grain])};
}

template <>
void Dynamics<3>::add_wall_shear(const Wall& wall, const std::uint32_t grain, const double distance,
                                 const std::array<double, 2>& shear_force)
{
  const int one = (wall.axis + 1) % 3;
  const int two = (wall.axis + 2) % 3;
  const double arm = distance * wall.side;
  body.grains.force[one][grain] += shear_force[0];
  body.grains.force[two][grain] += shear_force[1];
  body.grains.couple[one][grain] += arm * shear_force[1];
  body.grains.couple[two][grain] -= arm * shear_force[0];
}

template class Dynamics<2>;
template void Dynamics<2>::transfer(Hdf5Writer&);
template void Dynamics<2>::transfer(Hdf5Reader&);
template class Dynamics<3>;
template void Dynamics<3>::transfer(Hdf5Writer&);
template void Dynamics<3>::transfer(Hdf5Reader&);
} // namespace feldspar
