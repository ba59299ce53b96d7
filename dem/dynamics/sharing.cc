// A body that several processes compute together: its division, what they agree on in a step, and its whole state.

#include "base/input_error.h"
#include "dem/dynamics/dynamics.h"
#include "dem/specimen/fragments.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace feldspar
{
namespace
{
/// Returns what keeps a body from being computed by several processes, if anything.
template <int dim>
std::string what_is_not_shared(const Specimen<dim>& body)
{
  if (body.is_periodic())
    return "a periodic body";
  if (body.groups_are_rigid)
    return "a body of clumps";
  return {};
}

/// A broken segment as others hear of it.
struct PlainBreak
{
  std::uint32_t joint; ///< by its number
  std::uint32_t segment;
  double released_energy; ///< [J]
};
} // namespace

template <int dim>
void Dynamics<dim>::share(Partners& with)
{
  if (const std::string what = what_is_not_shared(body); !what.empty())
    throw InputError("{} cannot be computed by several processes together yet", what);
  part = BodyShare<dim>(with, body);
  if (!part.is_first())
    ledger.slip_of_lost_contacts = {};
  keep_own();
}

template <int dim>
void Dynamics<dim>::drop()
{
  if (!part.is_shared())
    return;
  if (part.is_first())
    keep_own();
  meet();
}

/// Drops what other processes compute.
template <int dim>
void Dynamics<dim>::keep_own()
{
  auto& joints = body.joints;
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (part.concerns({joints.grain_1[j], joints.grain_2[j]}))
      kept.push_back(j);
  joints.keep(kept);
  std::erase_if(body.smooth_joints, [&](const SmoothJoint<dim>& joint) { return !part.concerns(joint.ends()); });
  body.smooth_joints.shrink_to_fit();
  std::vector<Touch<dim>> own_touches;
  std::ranges::copy_if(touches.list(), std::back_inserter(own_touches),
                       [&](const Touch<dim>& touch) { return part.concerns(touch.ends()); });
  touches.take(std::move(own_touches));
  for (std::size_t w = 0; w < wall_set.size(); ++w)
    {
      std::vector<WallTouch<dim>> near;
      std::ranges::copy_if(wall_set.near(w), std::back_inserter(near),
                           [&](const WallTouch<dim>& touch) { return part.counts(touch.grain); });
      wall_set.take(w, std::move(near));
    }
  if (!started)
    return;
  joint_groups = JointGroups<dim>(joints);
  index_joints();
  touches.number(images);
}

template <int dim>
void Dynamics<dim>::meet()
{
  if (!part.is_shared() || !started)
    return;
  agree_on_copies();
  agree({}, 0.0);
}

template <int dim>
void Dynamics<dim>::agree_on_copies()
{
  if (!part.is_shared())
    return;
  term_counts.clear();
  std::vector<std::uint32_t> needed(body.joints.grain_1.begin(), body.joints.grain_1.end());
  needed.insert(needed.end(), body.joints.grain_2.begin(), body.joints.grain_2.end());
  for (const SmoothJoint<dim>& joint : body.smooth_joints)
    needed.insert(needed.end(), {joint.grain_1, joint.grain_2});
  for (const Touch<dim>& touch : touches.list())
    needed.insert(needed.end(), {touch.grain_1, touch.grain_2});
  part.agree_on_copies(std::move(needed));
  sweep_memory.known = part.grains();
  sweep_memory.copied = part.copies();
}

/// Work of the forces from outside on each own grain over a step of dt [s], component by component [J].
template <int dim>
std::vector<std::vector<double>> Dynamics<dim>::works_of_applied_forces(const double step) const
{
  std::vector<std::vector<double>> works(dim);
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = part.grains().first; i < part.grains().end && !applied_force[c].empty(); ++i)
      if (applied_force[c][i] != 0.0)
        works[std::size_t(c)].push_back(step * applied_force[c][i] * body.grains.velocity[c][i]);
  return works;
}

/// Makes known to all what the contacts of a step of dt [s] gave: sums over walls, grips and forces from outside, in the order of
/// the grains, and breaks, of which it returns those that this process counts.
template <int dim>
std::vector<Break> Dynamics<dim>::agree(std::vector<Break> breaks, const double step)
{
  const auto add_works = [&](const auto& works) {
    for (std::size_t c = 0; c < dim; ++c)
      for (const double work : works[c])
        ledger.boundary_work += work;
  };
  const auto note = [&](const auto& all) {
    released.clear();
    for (const auto& one : all)
      released.push_back(one.released_energy);
  };
  if (!part.is_shared())
    {
      if (!applied_force[0].empty())
        add_works(works_of_applied_forces(step));
      note(breaks);
      return breaks;
    }

  // The sums, each a list of its terms.
  std::vector<std::vector<double>> terms = works_of_applied_forces(step);
  for (std::size_t w = 0; w < wall_set.size(); ++w)
    {
      terms.push_back(wall_set.pressures(w));
      terms.push_back(wall_set.stiffnesses_in_touch(body, w));
    }
  for (std::size_t g = 0; g < grips.size(); ++g)
    for (int c = 0; c < dim; ++c)
      {
        auto& forces = terms.emplace_back();
        for (const std::uint32_t i : grips.members(g))
          if (part.grains().has(i))
            forces.push_back(body.grains.force[c][i]);
      }
  std::erase_if(breaks, [&](const Break& event) { return !part.counts(joint_of(event).ends.first); });
  terms.push_back({contact_made ? 1.0 : 0.0, double(breaks.size())});
  terms = part.gathered_lists(terms, term_counts);

  add_works(terms);
  auto next = terms.begin() + dim;
  for (std::size_t w = 0; w < wall_set.size(); ++w, next += 2)
    wall_set.set_sums(w, next[0], next[1]);
  shared_grip_forces.assign(grips.size(), Vector<dim>::Zero());
  for (Vector<dim>& force : shared_grip_forces)
    for (int c = 0; c < dim; ++c, ++next)
      for (const double term : *next)
        force[c] += term;
  double n_breaks_of_all = 0.0;
  for (std::size_t k = 0; k < next->size(); k += 2)
    {
      contact_made = contact_made || (*next)[k] > 0.0;
      n_breaks_of_all += (*next)[k + 1];
    }
  std::vector<PlainBreak> plain;
  if (n_breaks_of_all > 0.0)
    {
      plain.reserve(breaks.size());
      for (const Break& event : breaks)
        plain.push_back({joint_of(event).number, event.segment, event.released_energy});
      plain = part.gathered(plain);
      std::ranges::sort(plain, {}, [](const PlainBreak& one) { return std::pair(one.joint, one.segment); });
    }
  note(plain);
  return breaks;
}

template <int dim>
void Dynamics<dim>::know_all_positions()
{
  part.bring_all(body.grains.position);
}

template <int dim>
void Dynamics<dim>::know_all_motions()
{
  auto& grains = body.grains;
  know_all_positions();
  part.bring_all(grains.velocity);
  part.bring_all(grains.spin);
}

template <int dim>
std::vector<std::uint32_t> Dynamics<dim>::fragments() const
{
  if (!part.is_shared())
    return feldspar::fragments(body);
  std::vector<std::uint32_t> held; // the two grains of each joint
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    if (part.counts(body.joints.grain_1[j]) && body.joints.holds(j))
      held.insert(held.end(), {body.joints.grain_1[j], body.joints.grain_2[j]});
  for (const SmoothJoint<dim>& joint : body.smooth_joints)
    if (part.counts(joint.grain_1) && joint.state.bonded)
      held.insert(held.end(), {joint.grain_1, joint.grain_2});
  held = part.gathered(held);
  DisjointSets sets(body.grains.size());
  for (std::size_t k = 0; k < held.size(); k += 2)
    sets.merge(held[k], held[k + 1]);
  return feldspar::fragments(std::move(sets), body.grains.size());
}

template <int dim>
void Dynamics<dim>::collect()
{
  if (!part.is_shared())
    return;
  know_all_motions();
  part.bring_all(body.grains.force);
  part.bring_all(body.grains.couple);
  part.bring(ledger.damping_work);
  part.add_up(ledger.slip_of_lost_contacts);
  if (!part.is_first())
    ledger.slip_of_lost_contacts = {};

  auto& joints = body.joints;
  std::vector<std::size_t> own = joints.by_number();
  std::erase_if(own, [&](const std::size_t j) { return !part.counts(joints.grain_1[j]); });
  const auto of_all = [&](const auto& values) {
    std::vector<std::uint32_t> of_own;
    of_own.reserve(own.size());
    std::ranges::transform(own, std::back_inserter(of_own), [&](const std::size_t j) { return values[j]; });
    return part.gathered(of_own);
  };
  auto number = of_all(joints.number), grain_1 = of_all(joints.grain_1), grain_2 = of_all(joints.grain_2);
  const std::size_t n = number.size();
  Joints<dim> whole;
  if (part.is_first())
    {
      whole.law = joints.law;
      whole.divide(joints.division, joints.n_more);
      whole.thickness = joints.thickness;
      whole.friction = joints.friction;
      whole.friction_slope = joints.friction_slope;
      whole.resize_all(n);
      whole.number = std::move(number);
      std::ranges::copy(grain_1, whole.grain_1.begin());
      std::ranges::copy(grain_2, whole.grain_2.begin());
    }
  std::size_t field = 0;
  joints.visit_all([&](const auto& values) {
    std::vector<double> of_own;
    of_own.reserve(joints.size() > 0 ? own.size() * (values.size() / joints.size()) : 0);
    for (const std::size_t j : own)
      for (std::size_t i = j; i < values.size(); i += joints.size())
        of_own.push_back(values[i]);
    const std::vector<double> all = part.gathered(of_own);
    std::size_t its_number = 0;
    if (const std::size_t per_joint = n > 0 ? all.size() / n : 0; part.is_first())
      whole.visit_all([&](auto& into) {
        if (its_number++ == field)
          for (std::size_t k = 0; k < per_joint * n; ++k)
            into[k % per_joint * n + k / per_joint] = all[k];
      });
    ++field;
  });
  if (part.is_first())
    {
      whole.reorder(whole.by_number());
      joints = std::move(whole);
    }

  std::vector<SmoothJoint<dim>> counted_smooth;
  std::ranges::copy_if(body.smooth_joints, std::back_inserter(counted_smooth),
                       [&](const SmoothJoint<dim>& joint) { return part.counts(joint.grain_1); });
  counted_smooth = part.gathered(counted_smooth);
  if (part.is_first())
    body.smooth_joints = std::move(counted_smooth);
  std::vector<Touch<dim>> counted;
  std::ranges::copy_if(touches.list(), std::back_inserter(counted),
                       [&](const Touch<dim>& touch) { return part.counts(touch.grain_1); });
  counted = part.gathered(counted);
  if (part.is_first())
    touches.take(std::move(counted));
  for (std::size_t w = 0; w < wall_set.size(); ++w)
    if (auto near = part.gathered(wall_set.near(w)); part.is_first())
      wall_set.take(w, std::move(near));
}

template void Dynamics<2>::share(Partners&);
template void Dynamics<3>::share(Partners&);
template void Dynamics<2>::meet();
template void Dynamics<3>::meet();
template void Dynamics<2>::drop();
template void Dynamics<3>::drop();
template void Dynamics<2>::agree_on_copies();
template void Dynamics<3>::agree_on_copies();
template std::vector<std::vector<double>> Dynamics<2>::works_of_applied_forces(double) const;
template std::vector<std::vector<double>> Dynamics<3>::works_of_applied_forces(double) const;
template std::vector<Break> Dynamics<2>::agree(std::vector<Break>, double);
template std::vector<Break> Dynamics<3>::agree(std::vector<Break>, double);
template void Dynamics<2>::know_all_positions();
template void Dynamics<3>::know_all_positions();
template void Dynamics<2>::know_all_motions();
template void Dynamics<3>::know_all_motions();
template std::vector<std::uint32_t> Dynamics<2>::fragments() const;
template std::vector<std::uint32_t> Dynamics<3>::fragments() const;
template void Dynamics<2>::collect();
template void Dynamics<3>::collect();
} // namespace feldspar
