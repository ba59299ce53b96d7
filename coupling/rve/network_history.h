#pragma once

#include "coupling/network/kinematics.h"
#include "coupling/network/link_response.h"
#include "coupling/network/network_state.h"

#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace feldspar
{
/// Forces of a network whose grains stand at a position.
template <int dim>
struct Balance
{
  Unknowns forces; ///< on grains as they act, then volume × stress
  Voigt<dim> stress;
  double unbalanced_ratio = 0.0;
  double carried_stress = 0.0; ///< Σ |f| |l| / V over the links [Pa]
  double stored_energy = 0.0;
  std::vector<LinkResponse<dim>> active;                            ///< of each active link
  std::vector<std::pair<std::uint32_t, LinkResponse<dim>>> touches; ///< of pairs without a face that press
  std::vector<LinkTurn<dim>> turns;                                 ///< of links with a force; empty in small strains
};

/// Position of a network, and the forces there.
template <int dim>
struct Configuration
{
  Unknowns position;
  Balance<dim> balance;
};

/// A network as it stood at the last event: where its grains were, and the links that are no longer linear.
template <int dim>
class NetworkHistory
{
public:
  /// While the state is intact its response is that of small strains (Network::intact_stiffness()), whatever the kinematics.
  NetworkHistory(const Network<dim>& network, const NetworkState<dim>& state, Kinematics kinematics);

  const Network<dim>& network() const { return of; }
  bool is_finite() const { return finite; }
  /// Switches to finite kinematics; called once an intact network is to break.
  void become_finite();
  /// Motion of a link since rest, with the grains at a position.
  Motion<dim> motion(std::uint32_t link, const Unknowns& at) const;
  const Unknowns& position() const { return position_at_event; }
  /// Active links in the order of their first break or contact.
  const std::vector<ActiveLink<dim>>& active() const { return active_links; }
  bool is_active(const std::uint32_t link) const { return number[link] != none; }
  /// The number of an active link in active().
  std::uint32_t active_number(const std::uint32_t link) const { return number[link]; }

  /// Conditions of the boundary on the pairs that can carry them.
  const std::shared_ptr<const BoundaryConditions<dim>>& conditions() const { return bearing; }
  /// The network's factor with every pair in contact, under these conditions.
  const FactorisedNetwork<dim>& factorised_stiffest() const;

  /// Forces with the grains at a position, by the straight way from the last event. The memory of an earlier balance can
  /// serve again.
  Balance<dim> balance(const Unknowns& at, Balance<dim> memory = {}) const;

  /// A link that is not active as if it were: all bonded, or, where it has no face, not at all.
  ActiveLink<dim> as_at_event(std::uint32_t link) const;

  /// An active link; made one as it stands at the last event, all bonded, where it was not. The segments of the link
  /// may be changed.
  ActiveLink<dim>& activate(std::uint32_t link);

  /// Releases loose pairs; to be called after bonds of its links have been changed.
  void release_loose_pairs();

  /// Makes this the last event: positions and shear stresses are kept, pairs in contact become active.
  void keep(const Configuration<dim>& present);

private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  const Network<dim>& of;
  bool finite;
  std::vector<ActiveLink<dim>> active_links;
  std::vector<std::uint32_t> number; ///< of each link in `active_links`, or none
  Unknowns position_at_event;
  std::shared_ptr<const BoundaryConditions<dim>> bearing;
  mutable std::shared_ptr<const FactorisedNetwork<dim>>
    stiffest; ///< made where it is asked for; one thread has a history
};

/// The work that is done while a network goes straight from its last event to where it stands; nothing is released on
/// the way. One trapezoid gives the work of a link that stays as it is, bonded, open or sticking: exactly in small
/// strains. The way of a link that opens, closes or slides, or turns far, is halved until that makes no difference.
/// `at_event` has its forces at the last event.
template <int dim>
NetworkWork work_on_the_way(const NetworkHistory<dim>& history, const Balance<dim>& at_event,
                            const Configuration<dim>& present);
} // namespace feldspar
