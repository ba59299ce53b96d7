// A body that several processes compute together: its division, what they agree on in a step, and its whole state.

#include "base/input_error.h"
#include "base/mapped.h"
#include "dem/dynamics/dynamics.h"
#include "dem/specimen/fragments.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
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
  if (started)
    throw std::logic_error("a body is shared before its first step");
  auto& joints = body.joints;
  part = BodyShare<dim>(
    with, work_of_joints<dim>(body.grains.size(), joints.law, joints.grain_1, joints.bonded, body.smooth_joints));
  joints.keep_if([&](const std::size_t j) { return part.concerns({joints.grain_1[j], joints.grain_2[j]}); });
  keep_own();
}

/// Drops what other processes compute, but for the joints of the law and contacts without a face.
template <int dim>
void Dynamics<dim>::keep_own()
{
  if (!part.is_first())
    ledger.slip_of_lost_contacts = {};
  std::erase_if(body.smooth_joints, [&](const SmoothJoint<dim>& joint) { return !part.concerns(joint.ends()); });
  body.smooth_joints.shrink_to_fit();
  for (std::size_t w = 0; w < wall_set.size(); ++w)
    {
      std::vector<WallTouch<dim>> near;
      std::ranges::copy_if(wall_set.near(w), std::back_inserter(near),
                           [&](const WallTouch<dim>& touch) { return part.counts(touch.grain); });
      wall_set.take(w, std::move(near));
    }
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
  for (const NearPair& pair : touches.near_pairs())
    needed.insert(needed.end(), {pair.grain_1, pair.grain_2});
  part.agree_on_copies(std::move(needed));
  know_copies();
}

/// Tells the sweep whose motions are known.
template <int dim>
void Dynamics<dim>::know_copies()
{
  if (!part.is_shared())
    return;
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
  const auto note = [&]<typename Event>(const std::vector<Event>& all) {
    released = mapped<double>(all, &Event::released_energy);
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
      for (const Break& event : breaks)
        plain.push_back({joint_of(event).number, event.segment, event.released_energy});
      plain = part.gathered(plain);
      std::ranges::sort(plain, {}, [](const PlainBreak& one) { return std::pair(one.joint, one.segment); });
    }
  note(plain);
  return breaks;
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
void Dynamics<dim>::know_all()
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
}

template void Dynamics<2>::share(Partners&);
template void Dynamics<3>::share(Partners&);
template void Dynamics<2>::meet();
template void Dynamics<3>::meet();
template void Dynamics<2>::keep_own();
template void Dynamics<3>::keep_own();
template void Dynamics<2>::agree_on_copies();
template void Dynamics<3>::agree_on_copies();
template void Dynamics<2>::know_copies();
template void Dynamics<3>::know_copies();
template std::vector<Break> Dynamics<2>::agree(std::vector<Break>, double);
template std::vector<Break> Dynamics<3>::agree(std::vector<Break>, double);
template void Dynamics<2>::know_all_motions();
template void Dynamics<3>::know_all_motions();
template std::vector<std::uint32_t> Dynamics<2>::fragments() const;
template std::vector<std::uint32_t> Dynamics<3>::fragments() const;
template void Dynamics<2>::know_all();
template void Dynamics<3>::know_all();
} // namespace feldspar
