#pragma once

#include "coupling/rve/network_history.h"

namespace feldspar
{
/// The work that is done while a network goes straight from its last event to where it stands; nothing is released on
/// the way. One trapezoid gives the work of a link that stays as it is, bonded, open or sticking: exactly in small
/// strains. The way of a link that opens, closes or slides, or turns far, is halved until that makes no difference.
/// `at_event` has its forces at the last event.
template <int dim>
NetworkWork work_on_the_way(const NetworkHistory<dim>& history, const Balance<dim>& at_event,
                            const Configuration<dim>& present);
} // namespace feldspar
