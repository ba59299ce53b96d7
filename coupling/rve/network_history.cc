#include "coupling/rve/network_history.h"

#include <algorithm>
#include <optional>

namespace feldspar
{
namespace
{
// Strain at which the mean link has the least force that balance is measured by: a body that has come apart has no
// forces.
constexpr double least_strain = 1e-9;
} // namespace

template <int dim>
NetworkHistory<dim>::NetworkHistory(const Network<dim>& network, const NetworkState<dim>& state,
                                    const Kinematics kinematics)
  : of(network)
  , finite(kinematics == Kinematics::finite && !state.intact)
  , number(network.links().size(), none)
  , position_at_event(unknowns_of(network, state))
  , bearing(network.conditions())
{
  const auto activated = [&](const std::uint32_t segment) -> SegmentHistory<dim>& {
    const std::uint32_t link = network.link_of_segment(segment);
    return activate(link).segments[segment - network.links()[link].first_segment];
  };
  for (const auto& unbonded : state.unbonded)
    activated(unbonded.segment) = {false, unbonded.shear_stress};
  release_loose_pairs();
  for (const auto& softened : state.softened)
    activated(softened.segment) = {true, softened.shear_stress, softened.more};
  if (network.is_linear_while_bonded())
    return;
  for (std::uint32_t link = 0; link < network.n_joints(); ++link)
    {
      ActiveLink<dim>& face = activate(link);
      if (!state.contact_shear.empty())
        for (std::size_t i = 0; i < face.segments.size(); ++i)
          face.segments[i].shear_stress = state.contact_shear[network.links()[link].first_segment + i];
    }
}

template <int dim>
void NetworkHistory<dim>::become_finite()
{
  finite = true;
  for (ActiveLink<dim>& link : active_links)
    link.motion = motion(link.link, position_at_event);
}

template <int dim>
Motion<dim> NetworkHistory<dim>::motion(const std::uint32_t link, const Unknowns& at) const
{
  return finite ? TurnedLink<dim>(of.links()[link], at).motion() : link_motion(of.links()[link], at);
}

template <int dim>
ActiveLink<dim> NetworkHistory<dim>::as_at_event(const std::uint32_t link) const
{
  const Link<dim>& as_built = of.links()[link];
  ActiveLink<dim> result{link, motion(link, position_at_event), {}};
  result.segments.resize(as_built.n_segments);
  result.segments.front().bonded = as_built.has_face;
  return result;
}

template <int dim>
ActiveLink<dim>& NetworkHistory<dim>::activate(const std::uint32_t link)
{
  if (number[link] == none)
    {
      number[link] = std::uint32_t(active_links.size());
      active_links.push_back(as_at_event(link));
    }
  return active_links[number[link]];
}

template <int dim>
void NetworkHistory<dim>::release_loose_pairs()
{
  if (bearing->pieces().empty())
    return;
  const auto holds = [&](const std::uint32_t joint) {
    if (number[joint] == none)
      return true;
    const auto& segments = active_links[number[joint]].segments;
    return std::ranges::any_of(segments, [](const auto& segment) { return segment.bonded; });
  };
  auto left = bearing->that_bear(of.links(), of.n_joints(), of.n_grains(), holds);
  const auto n_pairs = [](const BoundaryConditions<dim>& conditions) {
    std::size_t n = 0;
    for (const auto& piece : conditions.pieces())
      n += piece.size();
    return n;
  };
  if (n_pairs(left) == n_pairs(*bearing))
    return;
  bearing = std::make_shared<const BoundaryConditions<dim>>(std::move(left));
  stiffest.reset();
}

template <int dim>
const FactorisedNetwork<dim>& NetworkHistory<dim>::factorised_stiffest() const
{
  if (bearing == of.conditions())
    return of.factorised_stiffest();
  if (!stiffest)
    stiffest = std::make_shared<const FactorisedNetwork<dim>>(of.factorised_stiffest().under(bearing));
  return *stiffest;
}

template <int dim>
void NetworkHistory<dim>::keep(const Configuration<dim>& present)
{
  for (std::size_t a = 0; a < active_links.size(); ++a)
    {
      active_links[a].motion = motion(active_links[a].link, present.position);
      for (std::size_t i = 0; i < active_links[a].segments.size(); ++i)
        if (auto& segment = active_links[a].segments[i];
            !segment.bonded || segment.has_softened() || !of.is_linear_while_bonded())
          segment.shear_stress = present.balance.active[a].segments[i].shear_stress;
    }
  position_at_event = present.position;
  for (const auto& [link, touch] : present.balance.touches)
    activate(link).segments.front().shear_stress = touch.segments.front().shear_stress;
}

template <int dim>
Balance<dim> NetworkHistory<dim>::balance(const Unknowns& at, Balance<dim> result) const
{
  const auto& links = of.links();
  result.forces.setZero(of.n_unknowns());
  result.carried_stress = result.stored_energy = 0.0;
  result.active.resize(active_links.size());
  result.touches.clear();
  result.turns.resize(finite ? links.size() : 0);
  double carried = 0.0;
  std::size_t n_carrying = 0;
  std::optional<TurnedLink<dim>> turned;
  const auto add = [&](const std::uint32_t k, const Motion<dim>& forces) {
    const Link<dim>& link = links[k];
    if (turned)
      {
        result.turns[k] = {turned->gradient(), turned->stiffness(forces), forces};
        add_forces(link, result.turns[k].gradient, forces, result.forces);
      }
    else
      add_forces(link, forces, result.forces);
    const double force = forces.template head<dim>().norm();
    carried += force;
    ++n_carrying;
    result.carried_stress += force * link.branch.norm() / of.volume();
  };
  const auto add_response = [&](const std::uint32_t k, const LinkResponse<dim>& response) {
    add(k, response.forces);
    result.stored_energy += response.stored_energy;
  };
  for (std::uint32_t k = 0; k < links.size(); ++k)
    {
      if (finite)
        turned.emplace(links[k], at);
      const Motion<dim> motion = turned ? turned->motion() : link_motion(links[k], at);
      if (number[k] != none)
        {
          auto& of_link = result.active[number[k]];
          of_link = response(of, active_links[number[k]], motion, std::move(of_link));
          add_response(k, of_link);
        }
      else if (links[k].has_face)
        {
          const Motion<dim> forces = of.bonded_stiffness(k) * motion;
          add(k, forces);
          result.stored_energy += 0.5 * motion.dot(forces);
        }
      else if (links[k].opening + motion[0] < 0.0)
        {
          result.touches.emplace_back(k, response(of, as_at_event(k), motion));
          add_response(k, result.touches.back().second);
        }
    }
  result.stress = result.forces.template tail<n_voigt<dim>>() / of.volume();

  bearing->project(result.forces);

  double largest = 0.0;
  for (std::size_t i = 0; i < of.n_grains(); ++i)
    {
      const auto force = result.forces.template segment<n_motions<dim>>(n_motions<dim> * Eigen::Index(i));
      largest = std::max(
        {largest, force.template head<dim>().norm(), force.template tail<n_rotations<dim>>().norm() / of.radii()[i]});
    }
  const double least = least_strain * of.mean_normal_stiffness();
  const double mean_force = n_carrying > 0 ? carried / double(n_carrying) : 0.0;
  result.unbalanced_ratio = largest / std::max(mean_force, least);
  result.carried_stress =
    std::max(result.carried_stress, least * double(of.n_joints()) * of.mean_branch() / of.volume());
  // Forces on grains act against the links' own.
  result.forces.head(of.n_unknowns() - n_voigt<dim>) *= -1.0;
  return result;
}

template class NetworkHistory<2>;
template class NetworkHistory<3>;
} // namespace feldspar
