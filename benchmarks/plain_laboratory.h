#pragma once

#include "benchmarks/plain_face.h"
#include "dem/specimen/specimen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

/// A laboratory test of a plane specimen of flat joints as a good programmer writes it for himself: structs and loops, one
/// number at a time, no vectors and no threads. It is the measure of the engine's speed, and a second opinion on its
/// results: it shares with it nothing but the specimen and the equations of docs/theory.md, §1 and §2. Like
/// `feldspar lab` it pulls by grips or presses between smooth platens, with its defaults. Read plain_face.h, and then this
/// from top to bottom.
namespace feldspar::plain
{
constexpr double time_step_safety = 0.8, grip_ratio = 0.1, skin_over_smallest_radius = 0.3;
constexpr std::uint64_t steps_between_looks = 10; // for grains that have come near each other

enum class Loading
{
  none,
  tension,
  compression
};

/// A line of the cache: all of a grain that a joint reads or writes.
struct alignas(64) Grain
{
  double x, y, spin, vx, vy, fx, fy, couple;
};

/// Numbers that only the motion of a grain reads. Held grains have no inverse masses and no damping.
struct Inertia
{
  double one_over_mass, one_over_moment, damping;
};

enum class Bonds : std::uint32_t
{
  all_hold, ///< the face responds as one spring
  some_broken,
  none_and_open ///< the face carries nothing until it closes
};

struct Joint
{
  std::uint32_t one, two;
  double k_n, k_s, radius, half_difference, rest;
  double nx, ny, opening, theta, slip;
  double least_tensile_strength, least_cohesion;
  Bonds bonds;
  std::uint32_t number;
};

/// Two grains near each other without a face.
struct Touch
{
  std::uint32_t one, two;
  double k_n, zero_distance, half_difference;
  double nx, ny, distance, normal, shear;
  bool touching;
};

struct Wall
{
  struct Touch
  {
    std::uint32_t grain;
    double zero_distance, overlap;
  };
  double side, y, velocity, force, y_at_search;
  std::vector<Touch> touches;
};

struct Crack
{
  std::uint64_t step;
  std::uint32_t joint, segment;
  bool in_tension;
};

struct Row
{
  std::uint64_t step;
  double strain, stress, boundary_work, kinetic, strain_energy, slip, released, damping_work;
};

inline std::uint64_t key_of(const std::uint32_t one, const std::uint32_t two) { return std::uint64_t(one) << 32 | two; }

/// The body under test. A step allocates nothing; a search for contacts may.
struct Body
{
  std::vector<Grain> grains;
  std::vector<Inertia> inertia;
  std::vector<double> radius, mass;
  std::vector<Joint> joints;
  std::vector<Segment> segments; ///< n_segments of each joint
  std::vector<Touch> touches;    ///< by their grains
  std::vector<Wall> walls;       ///< platens: below, above
  std::array<std::vector<std::uint32_t>, 2> grips;
  std::array<double, 2> grip_force{};
  double thickness, mu, tan_phi, modulus, stiffness_ratio, mu_touch, area, skin, rate, damping, grip_speed = 0.0;

  double dt = 0.0, previous_dt = 0.0, time = 0.0;
  std::uint64_t n_done = 0, next_look = 1;
  bool contact_made = false;
  std::vector<std::array<double, 2>> place_at_search;
  double boundary_work = 0.0, damping_work = 0.0, slip_energy = 0.0, released = 0.0;
  std::vector<Crack> cracks;

  // Arrays of a search.
  std::vector<std::uint64_t> joined; ///< pairs with a face, ascending
  std::vector<std::uint32_t> order;  ///< of the grains
  std::vector<Touch> found;
  std::vector<std::array<double, 3>> stiffness; ///< of the contacts of each grain

  Body(const Specimen<2>& specimen, const Loading loading, const double strain_rate, const double alpha)
    : thickness(specimen.thickness)
    , mu(specimen.joints.friction)
    , tan_phi(specimen.joints.friction_slope)
    , modulus(specimen.particle_contact.modulus)
    , stiffness_ratio(specimen.particle_contact.stiffness_ratio)
    , mu_touch(specimen.particle_contact.friction)
    , area(specimen.volume() / specimen.size[1])
    , rate(strain_rate)
    , damping(alpha)
  {
    const auto& g = specimen.grains;
    const auto& j = specimen.joints;
    if (specimen.is_periodic() || j.n_segments != n_segments)
      throw std::logic_error("a box of joints of four segments is wanted");
    const double height = specimen.size[1];
    radius = g.radius;
    mass = g.mass;
    grip_speed = loading == Loading::tension ? 0.5 * rate * (1.0 - 2.0 * grip_ratio) * height : 0.0;
    for (std::size_t i = 0; i < g.size(); ++i)
      {
        const double y = g.position[1][i];
        const double begins_with = loading == Loading::tension ? rate : loading == Loading::compression ? -rate : 0.0;
        grains.push_back({g.position[0][i], y, g.spin[0][i], g.velocity[0][i],
                          g.velocity[1][i] + begins_with * (y - 0.5 * height), 0.0, 0.0, 0.0});
        inertia.push_back({1.0 / mass[i], 1.0 / g.moment_of_inertia[i], damping});
        const bool is_low = y<grip_ratio * height, is_high = y> height - grip_ratio * height;
        if (loading != Loading::tension || !(is_low || is_high))
          continue;
        grips[is_low ? 0 : 1].push_back(std::uint32_t(i));
        grains[i].vy = is_low ? -grip_speed : grip_speed;
        inertia[i] = {0.0, 0.0, 0.0};
      }
    if (loading == Loading::compression)
      walls = {{1.0, 0.0, 0.5 * rate * height, 0.0, 0.0, {}}, {-1.0, height, -0.5 * rate * height, 0.0, height, {}}};
    for (std::size_t k = 0; k < j.size(); ++k)
      {
        constexpr double most = std::numeric_limits<double>::max();
        // clang-format off
        Joint joint{j.grain_1[k], j.grain_2[k], j.normal_stiffness[k], j.shear_stiffness[k], j.half_length[k],
                    j.half_radius_difference[k], j.rest_distance[k], j.normal[0][k], j.normal[1][k], j.opening[k],
                    j.rotation[0][k], j.slip[0][k], most, most, Bonds::all_hold, j.number[k]};
        // clang-format on
        for (unsigned int s = 0; s < n_segments; ++s)
          {
            const std::size_t at = j.segment(s, k);
            segments.push_back({j.shear_stress[0][at], j.tensile_strength[at], j.cohesion[at], j.bonded[at] > 0.5});
            joint.least_tensile_strength = std::min(joint.least_tensile_strength, j.tensile_strength[at]);
            joint.least_cohesion = std::min(joint.least_cohesion, j.cohesion[at]);
            if (!segments.back().bonded)
              joint.bonds = Bonds::some_broken;
          }
        joints.push_back(joint);
      }
    skin = skin_over_smallest_radius * *std::min_element(radius.begin(), radius.end());
    cracks.reserve(segments.size());
    place_at_search.resize(grains.size());
    stiffness.resize(grains.size());
  }

  /// The curve of so many steps.
  std::vector<Row> run(const std::uint64_t n_steps, const double sampling_strain)
  {
    start();
    std::vector<Row> rows{row()};
    while (n_done < n_steps)
      {
        step();
        if (rate * time >= double(rows.size()) * sampling_strain)
          rows.push_back(row());
      }
    return rows;
  }

  void start()
  {
    search(true);
    sweep(0.0);
    update_touches(0.0);
    press_walls();
    sum_grip_forces();
    choose_time_step();
  }

  void step()
  {
    if (dt == 0.0)
      start();
    if (n_done == next_look && may_miss_contacts())
      {
        remove_lost_faces();
        search(false);
        choose_time_step();
      }
    else if (contact_made)
      choose_time_step();

    add_boundary_work();
    move();
    for (Wall& wall : walls)
      wall.y += dt * wall.velocity;
    sweep(dt);
    update_touches(dt);
    press_walls();
    sum_grip_forces();
    add_boundary_work();
    time += dt;
    previous_dt = dt;
    ++n_done;
  }

  /// Half of the work of a step; called before and after the motion.
  void add_boundary_work()
  {
    for (const Wall& wall : walls)
      boundary_work += 0.5 * dt * wall.side * wall.force * wall.velocity;
    boundary_work -= 0.5 * dt * grip_speed * (grip_force[1] - grip_force[0]);
  }

  /// Central differences with local damping. Leaves forces at zero for the sweep.
  void move()
  {
    const double kick = 0.5 * (previous_dt + dt);
    for (std::size_t i = 0; i < grains.size(); ++i)
      {
        Grain& g = grains[i];
        const Inertia& of = inertia[i];
        double work = 0.0;
        const auto advance = [&](double& velocity, const double force, const double one_over_inertia) {
          const double drag = velocity == 0.0 ? 0.0 : -of.damping * std::copysign(std::abs(force), velocity);
          const double after = velocity + kick * (force + drag) * one_over_inertia;
          work += drag * (previous_dt * velocity + dt * after);
          velocity = after;
        };
        advance(g.vx, g.fx, of.one_over_mass);
        advance(g.vy, g.fy, of.one_over_mass);
        advance(g.spin, g.couple, of.one_over_moment);
        damping_work -= 0.5 * work;
        g.x += dt * g.vx;
        g.y += dt * g.vy;
        g.fx = g.fy = g.couple = 0.0;
      }
  }

  void sweep(const double of_time)
  {
    for (std::size_t k = 0; k < joints.size(); ++k)
      {
        Joint& j = joints[k];
        Grain& one = grains[j.one];
        Grain& two = grains[j.two];
        const double dx = two.x - one.x, dy = two.y - one.y;
        const double d = std::sqrt(dx * dx + dy * dy), inverse = 1.0 / d;
        const double nx = dx * inverse, ny = dy * inverse;
        const double half = 0.25 * (j.rest + j.opening + d); // of the mean distance
        const double turn_1 = of_time * one.spin, turn_2 = of_time * two.spin;
        const double slip_increment = 2.0 * half * angle(j.nx * ny - j.ny * nx, j.nx * nx + j.ny * ny) -
                                      (half + j.half_difference) * turn_1 - (half - j.half_difference) * turn_2;
        const double opening = d - j.rest, theta = j.theta + (turn_2 - turn_1), slip = j.slip + slip_increment;

        Resultants r{0.0, 0.0, 0.0};
        if (j.bonds == Bonds::all_hold) [[likely]]
          {
            constexpr double farthest = (n_segments - 1.0) / n_segments; // centroid, over the radius of the face
            const double highest = j.k_n * (opening + std::abs(theta) * farthest * j.radius);
            const double shear = j.k_s * slip;
            const double face = 2.0 * j.radius * thickness;
            r = {-j.k_n * face * opening, -shear * face, -j.k_n * face * (1.0 / 3.0) * j.radius * j.radius * theta};
            if (!(highest <= j.least_tensile_strength &&
                  std::abs(shear) <= std::max(0.0, j.least_cohesion - highest * tan_phi))) [[unlikely]]
              {
                const Resultants by_segments = update_segments(k, opening, theta, slip_increment);
                if (j.bonds != Bonds::all_hold)
                  r = by_segments;
              }
          }
        else if (!(j.bonds == Bonds::none_and_open && opening > 1.001 * std::abs(theta) * j.radius))
          r = update_segments(k, opening, theta, slip_increment);
        j.nx = nx;
        j.ny = ny;
        j.opening = opening;
        j.theta = theta;
        j.slip = slip;

        const double fx = r.normal * nx - r.shear * ny, fy = r.normal * ny + r.shear * nx;
        one.fx -= fx;
        one.fy -= fy;
        two.fx += fx;
        two.fy += fy;
        one.couple -= r.moment + (0.5 * d + j.half_difference) * r.shear;
        two.couple += r.moment - (0.5 * d - j.half_difference) * r.shear;
      }
  }

  double shear_stress(const std::size_t joint, const std::size_t segment) const
  {
    const Joint& j = joints[joint];
    return j.bonds == Bonds::all_hold ? -j.k_s * j.slip : segments[n_segments * joint + segment].tau;
  }

  /// The segments one by one, docs/theory.md §1.4. The joint has its state from before the step.
  Resultants update_segments(const std::size_t k, const double opening, const double theta, const double slip_increment)
  {
    Joint& j = joints[k];
    const bool was_whole = j.bonds == Bonds::all_hold;
    const double l = 2.0 * j.radius / n_segments, face = l * thickness;
    std::array<double, n_segments> taus;
    bool some_broke = false, some_bear = false;
    Resultants sum{0.0, 0.0, 0.0};
    for (std::size_t s = 0; s < n_segments; ++s)
      {
        Segment& segment = segments[n_segments * k + s];
        const double rho = j.radius * centroid(s);
        const double gap = opening - theta * rho, gap_before = j.opening - j.theta * rho;
        const double old = shear_stress(k, s);
        double tau = 0.0;
        NormalResponse normal = normal_response(j.k_n, l, thickness, gap, theta, segment.bonded);
        if (segment.bonded)
          {
            const double sigma = j.k_n * gap;
            tau = old - j.k_s * slip_increment;
            const bool in_tension = sigma > segment.tensile_strength;
            if (in_tension || std::abs(tau) > std::max(0.0, segment.cohesion - sigma * tan_phi))
              {
                const double stored = normal.energy + 0.5 * old * tau * face / j.k_s;
                normal = normal_response(j.k_n, l, thickness, gap, theta, false);
                released += stored - normal.energy;
                tau = 0.0;
                segment.bonded = false;
                some_broke = true;
                cracks.push_back({n_done + 1, j.number, std::uint32_t(s), in_tension});
              }
          }
        else
          {
            const double limit = mu * std::max(0.0, normal.force / face);
            tau = old - j.k_s * closed_share(gap_before, gap) * slip_increment;
            tau = std::clamp(tau, -limit, limit);
            slip_energy += 0.5 * (old + tau) * (old - j.k_s * slip_increment - tau) * face / j.k_s;
          }
        taus[s] = tau;
        some_bear = some_bear || segment.bonded || tau != 0.0;
        sum.normal += normal.force;
        sum.shear += tau * face;
        sum.moment += normal.moment - rho * normal.force;
      }
    if (was_whole && !some_broke)
      return sum;
    for (std::size_t s = 0; s < n_segments; ++s)
      segments[n_segments * k + s].tau = taus[s];
    const bool is_open = opening > 1.001 * std::abs(theta) * j.radius;
    j.bonds = is_open && !some_bear ? Bonds::none_and_open : Bonds::some_broken;
    return sum;
  }

  void update_touches(const double of_time)
  {
    for (Touch& t : touches)
      {
        Grain& one = grains[t.one];
        Grain& two = grains[t.two];
        const double dx = two.x - one.x, dy = two.y - one.y, squared = dx * dx + dy * dy;
        const bool was_touching = t.touching;
        t.touching = squared < t.zero_distance * t.zero_distance;
        if (!t.touching) [[likely]]
          {
            if (was_touching) // sliding apart dissipates the shear that was stored
              {
                slip_energy += 0.5 * t.shear * t.shear * stiffness_ratio / t.k_n;
                t.normal = t.shear = 0.0;
              }
            continue;
          }
        const double d = std::sqrt(squared), nx = dx / d, ny = dy / d;
        double slip = 0.0;
        if (was_touching && mu_touch > 0.0)
          {
            const double half = 0.25 * (t.distance + d);
            slip = 2.0 * half * angle(t.nx * ny - t.ny * nx, t.nx * nx + t.ny * ny) -
                   (half + t.half_difference) * of_time * one.spin - (half - t.half_difference) * of_time * two.spin;
          }
        contact_made = contact_made || !was_touching;
        t.nx = nx;
        t.ny = ny;
        t.distance = d;
        t.normal = t.k_n * (t.zero_distance - d);
        const double k_s = t.k_n / stiffness_ratio, trial = t.shear - k_s * slip, limit = mu_touch * t.normal;
        const double shear = std::clamp(trial, -limit, limit);
        slip_energy += 0.5 * (t.shear + shear) * (trial - shear) / k_s;
        t.shear = shear;
        const double fx = t.normal * nx - shear * ny, fy = t.normal * ny + shear * nx;
        one.fx -= fx;
        one.fy -= fy;
        two.fx += fx;
        two.fy += fy;
        one.couple -= (0.5 * d + t.half_difference) * shear;
        two.couple -= (0.5 * d - t.half_difference) * shear;
      }
  }

  /// Smooth platens.
  void press_walls()
  {
    const double k_n = 2.0 * modulus * thickness;
    for (Wall& wall : walls)
      {
        wall.force = 0.0;
        for (Wall::Touch& t : wall.touches)
          {
            const double overlap = std::max(0.0, t.zero_distance - (grains[t.grain].y - wall.y) * wall.side);
            contact_made = contact_made || (t.overlap == 0.0 && overlap > 0.0);
            t.overlap = overlap;
            grains[t.grain].fy += wall.side * k_n * overlap;
            wall.force += k_n * overlap;
          }
      }
  }

  void sum_grip_forces()
  {
    for (std::size_t k = 0; k < grips.size(); ++k)
      {
        grip_force[k] = 0.0;
        for (const std::uint32_t i : grips[k])
          grip_force[k] += grains[i].fy;
      }
  }

  /// Returns whether grains or platens could come to others that are not in the lists before the next look, and sets that look.
  bool may_miss_contacts()
  {
    double farthest = 0.0, fastest = 0.0;
    for (std::size_t i = 0; i < grains.size(); ++i)
      {
        const Grain& g = grains[i];
        const auto [x, y] = place_at_search[i];
        farthest = std::max(farthest, (g.x - x) * (g.x - x) + (g.y - y) * (g.y - y));
        fastest = std::max(fastest, g.vx * g.vx + g.vy * g.vy);
      }
    const double way_of_a_step = 2.0 * dt * std::sqrt(fastest); // twice, for what accelerates meanwhile
    bool missed = 0.5 * skin - std::sqrt(farthest) <= double(steps_between_looks) * way_of_a_step;
    double allowed = 0.5 * skin / std::max(way_of_a_step, std::numeric_limits<double>::min());
    const double reach = 0.25 * skin;
    for (const Wall& wall : walls)
      {
        allowed = std::min(allowed, reach / (way_of_a_step + 2.0 * dt * std::abs(wall.velocity)));
        if (std::abs(wall.y - wall.y_at_search) <= 0.5 * skin - reach)
          continue;
        auto listed = wall.touches.begin();
        for (std::size_t i = 0; i < grains.size(); ++i)
          if (listed != wall.touches.end() && listed->grain == i)
            ++listed;
          else
            missed = missed || (grains[i].y - wall.y) * wall.side - radius[i] < reach;
      }
    next_look = n_done + std::uint64_t(std::clamp(allowed, 1.0, double(steps_between_looks)));
    return missed;
  }

  Touch touch_of(const std::uint32_t one, const std::uint32_t two, const double zero_distance) const
  {
    const double k_n = modulus / (radius[one] + radius[two]) * 2.0 * std::min(radius[one], radius[two]) * thickness;
    return {one, two, k_n, zero_distance, 0.5 * (radius[one] - radius[two]), 0.0, 0.0, 0.0, 0.0, 0.0, false};
  }

  /// Without a bond, slid or opened by more than the length of the face. The grains may touch again.
  void remove_lost_faces()
  {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < joints.size(); ++k)
      {
        const Joint& j = joints[k];
        const auto first = segments.begin() + std::ptrdiff_t(n_segments * k);
        const bool holds = std::any_of(first, first + n_segments, [](const Segment& s) { return s.bonded; });
        if (holds || (std::abs(j.slip) <= 2.0 * j.radius && j.opening <= 2.0 * j.radius))
          {
            std::copy(first, first + n_segments, segments.begin() + std::ptrdiff_t(n_segments * kept));
            joints[kept++] = j;
            continue;
          }
        const Touch touch = touch_of(j.one, j.two, std::min(radius[j.one] + radius[j.two], j.rest));
        const double overlap = std::max(0.0, touch.zero_distance - j.rest - j.opening), l = 2.0 * j.radius / n_segments;
        for (std::size_t s = 0; s < n_segments; ++s)
          {
            const double rho = j.radius * centroid(s), tau = first[s].tau;
            slip_energy += normal_response(j.k_n, l, thickness, j.opening - j.theta * rho, j.theta, false).energy +
                           0.5 * tau * tau * l * thickness / j.k_s;
          }
        slip_energy -= 0.5 * touch.k_n * overlap * overlap;
        touches.push_back(touch);
      }
    joints.resize(kept, joints.front());
    segments.resize(n_segments * kept, segments.front());
  }

  /// Notes the pairs without a face and the grains at the platens that are nearer than the skin. What overlaps where the test
  /// begins counts as without force.
  void search(const bool placing)
  {
    joined.clear();
    for (const Joint& j : joints)
      joined.push_back(key_of(j.one, j.two));
    std::sort(joined.begin(), joined.end());
    const auto by_grains = [](const Touch& a, const Touch& b) { return key_of(a.one, a.two) < key_of(b.one, b.two); };
    std::sort(touches.begin(), touches.end(), by_grains);
    find_pairs(placing);
    std::sort(found.begin(), found.end(), by_grains);
    std::swap(touches, found);

    for (Wall& wall : walls)
      {
        std::vector<Wall::Touch> near;
        auto known = wall.touches.begin();
        for (std::uint32_t i = 0; i < grains.size(); ++i)
          {
            const double distance = (grains[i].y - wall.y) * wall.side;
            const bool is_known = known != wall.touches.end() && known->grain == i;
            if (distance <= radius[i] + skin)
              near.push_back(is_known ? *known
                                      : Wall::Touch{i, placing ? std::min(radius[i], distance) : radius[i], 0.0});
            else if (is_known)
              slip_energy += modulus * thickness * known->overlap * known->overlap;
            known += is_known;
          }
        wall.touches = std::move(near);
        wall.y_at_search = wall.y;
      }
    for (std::size_t i = 0; i < grains.size(); ++i)
      place_at_search[i] = {grains[i].x, grains[i].y};
  }

  /// Goes through the grains by their height.
  void find_pairs(const bool placing)
  {
    order.resize(grains.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](const auto a, const auto b) { return grains[a].y < grains[b].y; });
    const double farthest = 2.0 * *std::max_element(radius.begin(), radius.end()) + skin;
    found.clear();
    for (std::size_t low = 0; low < order.size(); ++low)
      for (std::size_t high = low + 1; high < order.size(); ++high)
        {
          const auto [one, two] = std::minmax(order[low], order[high]);
          const double dx = grains[two].x - grains[one].x, dy = grains[two].y - grains[one].y;
          if (std::abs(dy) >= farthest)
            break;
          const double reach = radius[one] + radius[two], squared = dx * dx + dy * dy;
          const std::uint64_t pair = key_of(one, two);
          if (squared >= (reach + skin) * (reach + skin) || std::binary_search(joined.begin(), joined.end(), pair))
            continue;
          const auto known = std::lower_bound(touches.begin(), touches.end(), pair, [](const Touch& t, const auto key) {
            return key_of(t.one, t.two) < key;
          });
          if (known != touches.end() && key_of(known->one, known->two) == pair)
            found.push_back(*known);
          else
            found.push_back(touch_of(one, two, placing ? std::min(reach, std::sqrt(squared)) : reach));
        }
  }

  /// 0.8 √(m/k) of the grain with the stiffest contacts over its mass, docs/theory.md §2.2.
  void choose_time_step()
  {
    std::fill(stiffness.begin(), stiffness.end(), std::array<double, 3>{});
    const auto add = [&](const std::uint32_t i, const double nx, const double ny, const double k_n, const double k_s,
                         const double turning) {
      stiffness[i][0] += k_n * nx * nx + k_s * (1.0 - nx * nx);
      stiffness[i][1] += k_n * ny * ny + k_s * (1.0 - ny * ny);
      stiffness[i][2] += turning;
    };
    const auto add_pair = [&](const auto& c, const double distance, const double k_n, const double k_s,
                              const double bending) {
      const double a_1 = 0.5 * distance + c.half_difference, a_2 = 0.5 * distance - c.half_difference;
      add(c.one, c.nx, c.ny, k_n, k_s, k_s * a_1 * a_1 + bending);
      add(c.two, c.nx, c.ny, k_n, k_s, k_s * a_2 * a_2 + bending);
    };
    for (const Joint& j : joints)
      {
        const double face = 2.0 * j.radius * thickness;
        add_pair(j, j.rest + j.opening, j.k_n * face, j.k_s * face, j.k_n * face * j.radius * j.radius / 3.0);
      }
    for (const Touch& t : touches)
      if (t.touching)
        add_pair(t, t.distance, t.k_n, mu_touch > 0.0 ? t.k_n / stiffness_ratio : 0.0, 0.0);
    for (const Wall& wall : walls)
      for (const Wall::Touch& t : wall.touches)
        if (t.overlap > 0.0)
          add(t.grain, 0.0, 1.0, 2.0 * modulus * thickness, 0.0, 0.0);
    double largest = 0.0;
    for (std::size_t i = 0; i < grains.size(); ++i)
      {
        const auto& [along_x, along_y, turning] = stiffness[i];
        const double moment = 0.5 * mass[i] * radius[i] * radius[i]; // of a disc
        largest = std::max({largest, along_x / mass[i], along_y / mass[i], turning / moment});
      }
    dt = time_step_safety / std::sqrt(largest);
    contact_made = false;
  }

  Row row() const
  {
    Row row{n_done, rate * time, 0.0, boundary_work, 0.0, 0.0, slip_energy, released, damping_work};
    row.stress =
      walls.empty() ? 0.5 * (grip_force[0] - grip_force[1]) / area : 0.5 * (walls[0].force + walls[1].force) / area;
    for (std::size_t k = 0; k < joints.size(); ++k)
      {
        const Joint& j = joints[k];
        const double face = 2.0 * j.radius * thickness;
        if (j.bonds == Bonds::all_hold)
          row.strain_energy +=
            0.5 * face *
            (j.k_n * (j.opening * j.opening + j.radius * j.radius * j.theta * j.theta / 3.0) + j.k_s * j.slip * j.slip);
        else
          for (std::size_t s = 0; s < n_segments; ++s)
            {
              const Segment& segment = segments[n_segments * k + s];
              const double gap = j.opening - j.theta * j.radius * centroid(s);
              row.strain_energy +=
                normal_response(j.k_n, 2.0 * j.radius / n_segments, thickness, gap, j.theta, segment.bonded).energy +
                0.5 * segment.tau * segment.tau * face / n_segments / j.k_s;
            }
      }
    for (const Touch& t : touches)
      row.strain_energy += 0.5 * (t.normal * t.normal + t.shear * t.shear * stiffness_ratio) / t.k_n;
    for (const Wall& wall : walls)
      for (const Wall::Touch& t : wall.touches)
        row.strain_energy += modulus * thickness * t.overlap * t.overlap;

    // Velocities of half a step before, at the present time.
    const double kick = 0.5 * (previous_dt + dt);
    for (std::size_t i = 0; i < grains.size(); ++i)
      {
        const Grain& g = grains[i];
        if (inertia[i].one_over_mass == 0.0)
          continue;
        const auto centre = [&](const double velocity, const double force, const double one_over_inertia) {
          const double drag = velocity == 0.0 ? 0.0 : -damping * std::copysign(std::abs(force), velocity);
          row.kinetic += 0.5 * velocity * (velocity / one_over_inertia + (n_done > 0 ? kick * (force + drag) : 0.0));
          row.damping_work -= 0.5 * drag * previous_dt * velocity;
        };
        centre(g.vx, g.fx, inertia[i].one_over_mass);
        centre(g.vy, g.fy, inertia[i].one_over_mass);
        centre(g.spin, g.couple, inertia[i].one_over_moment);
      }
    return row;
  }
};
} // namespace feldspar::plain
