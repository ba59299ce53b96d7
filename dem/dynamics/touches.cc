#include "dem/dynamics/touches.h"

#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace feldspar
{
template <int dim>
Touch<dim> make_touch(const Specimen<dim>& body, const std::uint32_t grain_1, const std::uint32_t grain_2)
{
  const double radius_1 = body.grains.radius[grain_1];
  const double radius_2 = body.grains.radius[grain_2];
  const double k_n = touch_stiffness<dim>(body.particle_contact.modulus, radius_1, radius_2, body.thickness);
  Touch<dim> touch{};
  touch.grain_1 = grain_1;
  touch.grain_2 = grain_2;
  touch.stiffness = {k_n, k_n / body.particle_contact.stiffness_ratio};
  touch.half_radius_difference = 0.5 * (radius_1 - radius_2);
  return touch;
}

template <int dim>
NearPair near_pair(const Specimen<dim>& body, const std::uint32_t grain_1, const std::uint32_t grain_2)
{
  return {grain_1, grain_2, body.grains.radius[grain_1] + body.grains.radius[grain_2]};
}

namespace
{
/// Positions round in each step, by 1e-16 of the size of the body. The share of the distance of two grains that is spared for it
/// covers as many steps in a body of 10 000 grains across.
constexpr double share_for_rounding = 1e-6;
constexpr std::size_t most_steps_that_round = 100'000;

/// Returns whether two grains cannot come into contact: a smooth plane, along which they slide past each other, lies
/// between them, or they belong to one rigid body.
template <int dim>
bool never_touch(const Specimen<dim>& body, const GrainPair& pair)
{
  const auto& joints = body.smooth_joints;
  const auto found = std::ranges::lower_bound(joints, pair, {}, &SmoothJoint<dim>::ends);
  return (body.groups_are_rigid && body.groups[pair.first] == body.groups[pair.second]) ||
         (found != joints.end() && found->ends() == pair) || std::ranges::binary_search(body.kept_apart, pair);
}

/// pairs_within() that concern this process, in the same order: of a shared body those of its own grains and the others near
/// the box around them.
template <int dim>
std::vector<GrainPair> near_each_other(const BodyShare<dim>& share, const Grains<dim>& grains, const double skin,
                                       const std::function<void()>& check)
{
  if (!share.is_shared() || share.grains().size() == 0)
    return share.is_shared() ? std::vector<GrainPair>() : pairs_within(grains, skin, check);
  const auto [first, end] = share.grains();
  const double reach = 2.0 * *std::ranges::max_element(grains.radius) + skin;
  Vector<dim> low, high;
  for (int c = 0; c < dim; ++c)
    {
      const auto [least, most] =
        std::minmax_element(grains.position[c].begin() + first, grains.position[c].begin() + end);
      low[c] = *least - reach;
      high[c] = *most + reach;
    }
  std::vector<std::uint32_t> near;
  Grains<dim> part;
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    if (const Vector<dim> place = at<dim>(grains.position, i);
        (place.array() >= low.array()).all() && (place.array() <= high.array()).all())
      {
        near.push_back(i);
        part.radius.push_back(grains.radius[i]);
        for (int c = 0; c < dim; ++c)
          part.position[c].push_back(place[c]);
      }
  std::vector<GrainPair> pairs;
  for (const auto& [one, two] : pairs_within(part, skin, check))
    if (const GrainPair pair(near[one], near[two]); share.concerns(pair))
      pairs.push_back(pair);
  return pairs;
}
} // namespace

/// Finds the place of a pair in the list, or the place where it would be inserted.
template <int dim>
auto Touches<dim>::find(const GrainPair& pair) const
{
  return std::ranges::lower_bound(pairs, pair, {}, &NearPair::ends);
}

template <int dim>
void Touches<dim>::add(const NearPair& pair)
{
  pairs.insert(find(pair.ends()), Near{pair, pair.grain_2, none, false});
}

template <int dim>
std::vector<Touch<dim>> Touches<dim>::in_order() const
{
  std::vector<Touch<dim>> result;
  result.reserve(touches.size());
  for_each_touch([&](const Touch<dim>& touch) { result.push_back(touch); });
  return result;
}

template <int dim>
void Touches<dim>::take(const std::vector<NearPair>& near, std::vector<Touch<dim>> stored)
{
  touches = std::move(stored);
  pairs.clear();
  pairs.reserve(near.size());
  std::uint32_t next = 0;
  for (const NearPair& pair : near)
    {
      const bool has_touch = next < touches.size() && touches[next].ends() == pair.ends();
      pairs.push_back({pair, pair.grain_2, has_touch ? next : none, has_touch && touches[next].touching});
      next += has_touch ? 1 : 0;
    }
}

template <int dim>
void Touches<dim>::number(const Images<dim>& images)
{
  pairs_of = feldspar::incidence(
    images.n_own(), pairs.size(), [&](const std::size_t k) { return pairs[k].ends(); },
    [&](const std::uint32_t grain) { return images.owner(grain); });
  touching_ones.assign(pairs.size(), 0);
  n_touching = 0;
  touching_ones_are_known = false;
  forget_ways();
  for (Near& pair : pairs)
    pair.owner_2 = images.owner(pair.grain_2);
}

/// All pairs are computed in the next update().
template <int dim>
void Touches<dim>::forget_ways()
{
  way_gone = 0.0;
  n_updates = 0;
  apart_until.assign(pairs.size(), 0.0);
}

template <int dim>
void Touches<dim>::search(const Specimen<dim>& body, const Images<dim>& images, const BodyShare<dim>& share,
                          const Incidence& joints_of, const double skin, const ZeroForce zero_force,
                          EnergyLedger& ledger, const std::function<void()>& check)
{
  const auto& grains = body.grains;
  const auto& joints = body.joints;
  std::vector<NearPair> found;
  std::vector<Touch<dim>> stored; // of those of them that have been in contact
  std::vector<std::uint32_t> jointed_to(grains.size(), std::numeric_limits<std::uint32_t>::max());
  std::uint32_t marked = std::numeric_limits<std::uint32_t>::max();
  constexpr std::size_t pairs_between_checks = 100000;
  std::size_t n_checked = 0;
  for (const auto& [one, two] : near_each_other(share, grains, skin, check))
    {
      if (n_checked++ % pairs_between_checks == 0)
        check();
      if (!images.pair_counts(one, two))
        continue;
      if (one != marked)
        {
          for (auto k = joints_of.first[one]; k < joints_of.first[one + 1]; ++k)
            {
              const auto j = joints_of.entries[k] / 2;
              if (joints.grain_1[j] == one)
                jointed_to[joints.grain_2[j]] = one;
            }
          marked = one;
        }
      if (jointed_to[two] == one)
        continue;
      const GrainPair pair(one, two);
      if (never_touch(body, pair))
        continue;
      if (const auto known = find(pair); known != pairs.end() && known->ends() == pair)
        {
          found.push_back(*known);
          if (known->touch != none)
            stored.push_back(touches[known->touch]);
        }
      else
        {
          found.push_back(near_pair(body, one, two));
          if (zero_force == ZeroForce::as_placed)
            found.back().zero_distance = std::min(
              found.back().zero_distance, (at<dim>(grains.position, two) - at<dim>(grains.position, one)).norm());
        }
    }
  std::size_t next = 0;
  for_each_touch([&](const Touch<dim>& touch) {
    while (next < stored.size() && stored[next].ends() < touch.ends())
      ++next;
    if ((next == stored.size() || stored[next].ends() != touch.ends()) && share.counts(touch.grain_1))
      ledger.slip_of_lost_contacts.add(touch.slip_energy);
  });
  take(found, std::move(stored));
  check();
  number(images);
}

namespace
{
/// Carries a pair that presses over a step; `comes`: into contact.
template <int dim>
void press(Touch<dim>& touch, const double zero_distance, const Grains<dim>& grains, const double friction,
           const double dt, const bool comes)
{
  std::array<double, dim> centre_1, centre_2;
  for (int c = 0; c < dim; ++c)
    {
      centre_1[c] = grains.position[c][touch.grain_1];
      centre_2[c] = grains.position[c][touch.grain_2];
    }
  std::array<double, dim - 1> slip{};
  if (!comes && friction > 0.0)
    {
      std::array<double, n_rotations<dim>> turn_1, turn_2;
      for (int c = 0; c < n_rotations<dim>; ++c)
        {
          turn_1[c] = dt * grains.spin[c][touch.grain_1];
          turn_2[c] = dt * grains.spin[c][touch.grain_2];
        }
      const auto motion = contact_motion(touch.frame, centre_1, centre_2, touch.half_radius_difference, turn_1, turn_2);
      touch.frame = motion.frame;
      slip = motion.slip;
    }
  else
    {
      touch.frame = contact_frame<dim, double>(centre_1, centre_2);
      if constexpr (dim == 3)
        touch.frame.tangent = space::tangent_to(touch.frame.normal);
    }
  const auto response = linear_contact::update<dim, double>(touch.stiffness, friction, touch.shear_force,
                                                            zero_distance - touch.frame.distance, slip);
  touch.touching = true;
  touch.normal_force = response.normal_force;
  touch.shear_force = response.shear_force;
  touch.slip_energy += response.slip_energy;
  touch.on_grains = contact_force(touch.frame, touch.half_radius_difference, response.normal_force,
                                  response.shear_force, std::array<double, n_rotations<dim>>{});
}

/// Sliding apart dissipates the shear that was stored.
template <int dim>
void part(Touch<dim>& touch)
{
  for (const double shear : touch.shear_force)
    touch.slip_energy += 0.5 * shear * shear / touch.stiffness.shear;
  touch.touching = false;
  touch.normal_force = 0.0;
  touch.shear_force = {};
  touch.on_grains = {};
}
} // namespace

template <int dim>
bool Touches<dim>::update(const Specimen<dim>& body, const double dt, const double farthest_way)
{
  const Grains<dim>& grains = body.grains;
  const double friction = body.particle_contact.friction;
  bool contact_made = false, contact_changed = !touching_ones_are_known;
  // Several threads may say so.
  const auto say = [](bool& what) { std::atomic_ref(what).store(true, std::memory_order_relaxed); };
  if (++n_updates > most_steps_that_round)
    forget_ways();
  way_gone += farthest_way;
  const bool way_is_known = std::isfinite(way_gone);
  for_each_block(pairs.size(), [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      {
        if (way_gone < apart_until[k])
          continue;
        Near& pair = pairs[k];
        double squared = 0.0;
        for (int c = 0; c < dim; ++c)
          {
            const double between = grains.position[c][pair.grain_2] - grains.position[c][pair.grain_1];
            squared += between * between;
          }
        const bool was_touching = pair.touching;
        pair.touching = squared < pair.zero_distance * pair.zero_distance;
        if (pair.touching)
          apart_until[k] = 0.0;
        else if (way_is_known) // which both may go
          apart_until[k] = way_gone + 0.5 * (std::sqrt(squared) - (1.0 + share_for_rounding) * pair.zero_distance);
        if (!was_touching && !pair.touching)
          continue; // as it was; most of those that are kept in mind never come into contact
        if (was_touching != pair.touching)
          say(contact_changed);
        if (pair.touching && !was_touching)
          say(contact_made);
        if (pair.touching && pair.touch != none)
          press(touches[pair.touch], pair.zero_distance, grains, friction, dt, !was_touching);
        else if (!pair.touching)
          part(touches[pair.touch]);
      }
  });
  if (!contact_changed)
    return contact_made;
  touching_ones_are_known = true;
  n_touching = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) // without branches: which are in contact cannot be foretold
    {
      touching_ones[n_touching] = std::uint32_t(k);
      n_touching += pairs[k].touching ? 1 : 0;
    }
  for (const std::uint32_t k : touching())
    if (Near& pair = pairs[k]; pair.touch == none) // for the first time
      {
        pair.touch = std::uint32_t(touches.size());
        touches.push_back(make_touch(body, pair.grain_1, pair.grain_2));
        press(touches.back(), pair.zero_distance, grains, friction, dt, true);
      }
  return contact_made;
}

template <int dim>
void Touches<dim>::add_energies(EnergySums& sums, const BodyShare<dim>& share) const
{
  for (const auto& touch : touches) // exact sums have no order
    if (share.counts(touch.grain_1))
      {
        sums.slip.add(touch.slip_energy);
        sums.strain.add(0.5 * touch.normal_force * touch.normal_force / touch.stiffness.normal);
        for (const double shear : touch.shear_force)
          sums.strain.add(0.5 * shear * shear / touch.stiffness.shear);
      }
}

template Touch<2> make_touch<2>(const Specimen<2>&, std::uint32_t, std::uint32_t);
template Touch<3> make_touch<3>(const Specimen<3>&, std::uint32_t, std::uint32_t);
template NearPair near_pair<2>(const Specimen<2>&, std::uint32_t, std::uint32_t);
template NearPair near_pair<3>(const Specimen<3>&, std::uint32_t, std::uint32_t);
template class Touches<2>;
template class Touches<3>;
} // namespace feldspar
