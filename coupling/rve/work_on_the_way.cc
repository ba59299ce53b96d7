#include "coupling/rve/network_history.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
constexpr double work_tolerance = 1e-3;   // of a link: over what is moved on the whole way
constexpr double least_work = 1e-8;       // of all links together: below this share of what is stored nothing is halved
constexpr unsigned int most_halvings = 9; // of a way

/// Way of the network from the last event, for grains and strain apart.
struct Way
{
  const Unknowns& from;
  const Unknowns& to;
  const Unknowns of_grains; ///< without strain
  const Unknowns of_strain; ///< without motions
  std::map<double, Unknowns> between = {};

  /// Position of the network at a share of the way; all links halve the way at the same places.
  const Unknowns& position(const double share)
  {
    if (share == 0.0 || share == 1.0)
      return share == 0.0 ? from : to;
    const auto found = between.find(share);
    return found != between.end() ? found->second : between.emplace(share, from + share * (to - from)).first->second;
  }
};

/// A link somewhere on the way.
template <int dim>
struct Stop
{
  double share; ///< of the way
  LinkResponse<dim> response;
  double boundary; ///< work over the whole way, did the forces stay as they are here [J]
  double settled;  ///< the same
};

/// The work between two stops, and what else balances it [J].
struct Stretch
{
  double boundary = 0.0;
  double settled = 0.0;
  double slip = 0.0;
  double stored = 0.0;

  Stretch& operator+=(const Stretch& other)
  {
    boundary += other.boundary;
    settled += other.settled;
    slip += other.slip;
    stored += other.stored;
    return *this;
  }
  double moved() const { return std::abs(boundary) + std::abs(settled) + std::abs(slip) + std::abs(stored); }
  double imbalance() const { return std::abs(boundary - settled - slip - stored); }
  double difference(const Stretch& other) const
  {
    return std::max(
      {std::abs(boundary - other.boundary), std::abs(settled - other.settled), std::abs(slip - other.slip)});
  }
};

template <int dim>
class LinkOnTheWay
{
public:
  /// its_history: none of a link that is not active.
  LinkOnTheWay(const NetworkHistory<dim>& of, const std::uint32_t number, const ActiveLink<dim>* its_history,
               Way& its_way)
    : history(of)
    , link(number)
    , at_event(its_history)
    , way(its_way)
  {
    if (history.is_finite())
      return;
    const Link<dim>& straight = history.network().links()[link];
    by_grains = link_motion(straight, way.of_grains);
    by_strain = link_motion(straight, way.of_strain);
  }

  Stop<dim> at(const double share, LinkResponse<dim> response) const
  {
    Stop<dim> stop{share, std::move(response), 0.0, 0.0};
    Motion<dim> of_grains = by_grains, of_strain = by_strain;
    if (history.is_finite())
      {
        const Link<dim>& turning = history.network().links()[link];
        const TurnedGradient<dim> gradient = TurnedLink<dim>(turning, way.position(share)).gradient();
        of_grains = link_motion(turning, gradient, way.of_grains);
        of_strain = link_motion(turning, gradient, way.of_strain);
      }
    stop.boundary = stop.response.forces.dot(of_strain);
    stop.settled = -stop.response.forces.dot(of_grains);
    return stop;
  }
  Stop<dim> at(const double share) const { return at(share, response_at(share)); }

  /// Work between two stops by the trapezoidal rule.
  Stretch between(const Stop<dim>& from, const Stop<dim>& to) const
  {
    const double half = 0.5 * (to.share - from.share);
    return {half * (from.boundary + to.boundary), half * (from.settled + to.settled),
            slip_between(from.response, to.response), to.response.stored_energy - from.response.stored_energy};
  }

  /// The same, halved where it is not exact.
  Stretch refined(const Stop<dim>& from, const Stop<dim>& to, const double least) const
  {
    const Stretch whole = between(from, to);
    return refined(from, to, whole, std::max(least, work_tolerance * whole.moved()), most_halvings);
  }

private:
  LinkResponse<dim> response_at(const double share) const
  {
    const Motion<dim> motion = history.is_finite() || !at_event ? history.motion(link, way.position(share))
                                                                : at_event->motion + share * (by_grains + by_strain);
    if (at_event)
      return response(history.network(), *at_event, motion);
    LinkResponse<dim> bonded;
    bonded.forces = history.network().bonded_stiffness(link) * motion;
    bonded.stored_energy = 0.5 * motion.dot(bonded.forces);
    return bonded;
  }

  /// Dissipated by friction.
  double slip_between(const LinkResponse<dim>& from, const LinkResponse<dim>& to) const
  {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < to.segments.size(); ++i)
      {
        const auto& before = from.segments[i];
        const auto& after = to.segments[i];
        double over_area = 0.0;
        for (int c = 0; c < dim - 1; ++c)
          over_area += 0.5 * (before.shear_stress[c] + after.shear_stress[c]) * (after.slip[c] - before.slip[c]);
        sum += over_area * history.network().segment_area(history.network().links()[link], i);
      }
    return sum;
  }

  /// Returns whether the link has the same states at both ends and nothing slid between them.
  bool stays_linear(const LinkResponse<dim>& from, const LinkResponse<dim>& to) const
  {
    constexpr auto slip = &SegmentResponse<dim>::slip;
    return from.tangent == to.tangent && std::ranges::equal(from.segments, to.segments, {}, slip, slip);
  }

  /// Halves the way until its work makes no difference. The balance alone does not see slip that is counted wrong: as
  /// much is missing of the work. A link that slides is therefore halved once at least.
  Stretch refined(const Stop<dim>& from, const Stop<dim>& to, const Stretch& whole, const double tolerance,
                  const unsigned int halvings_left) const
  {
    if (stays_linear(from.response, to.response) && whole.imbalance() <= tolerance)
      return whole;
    const Stop<dim> middle = at(0.5 * (from.share + to.share));
    const Stretch first = between(from, middle);
    const Stretch second = between(middle, to);
    Stretch halved = first;
    halved += second;
    if (halvings_left == 1 || std::max(halved.difference(whole), halved.imbalance()) <= tolerance)
      return halved;
    Stretch result = refined(from, middle, first, tolerance, halvings_left - 1);
    result += refined(middle, to, second, tolerance, halvings_left - 1);
    return result;
  }

  const NetworkHistory<dim>& history;
  std::uint32_t link;
  const ActiveLink<dim>* at_event;
  Way& way;
  Motion<dim> by_grains = Motion<dim>::Zero(), by_strain = Motion<dim>::Zero(); ///< in small strains
};
} // namespace

template <int dim>
NetworkWork work_on_the_way(const NetworkHistory<dim>& history, const Balance<dim>& at_event,
                            const Configuration<dim>& present)
{
  const Network<dim>& network = history.network();
  const Eigen::Index n_own = network.n_unknowns() - n_voigt<dim>;
  Unknowns of_grains = present.position - history.position(), of_strain = Unknowns::Zero(network.n_unknowns());
  of_strain.template tail<n_voigt<dim>>() = of_grains.template tail<n_voigt<dim>>();
  of_grains.template tail<n_voigt<dim>>().setZero();
  history.conditions()->project(of_grains); // what the boundary carries does no work
  Way way{history.position(), present.position, std::move(of_grains), std::move(of_strain)};

  // All links by one trapezoid, then what is missing of those that it does not have exactly.
  NetworkWork work;
  const Voigt<dim> mean_stress = 0.5 * (at_event.stress + present.balance.stress);
  work.boundary = network.volume() * mean_stress.dot(way.of_strain.template tail<n_voigt<dim>>());
  work.settled =
    0.5 * (at_event.forces.head(n_own) + present.balance.forces.head(n_own)).dot(way.of_grains.head(n_own));
  const double least =
    least_work * present.balance.stored_energy / double(std::max<std::size_t>(1, network.n_joints()));
  const auto correct = [&](const LinkOnTheWay<dim>& link, const Stop<dim>& from, const Stop<dim>& to) {
    const Stretch coarse = link.between(from, to);
    const Stretch fine = link.refined(from, to, least);
    work.boundary += fine.boundary - coarse.boundary;
    work.settled += fine.settled - coarse.settled;
    work.slip += fine.slip;
  };
  for (std::size_t a = 0; a < history.active().size(); ++a)
    {
      const LinkOnTheWay<dim> link(history, history.active()[a].link, &history.active()[a], way);
      correct(link, link.at(0.0, at_event.active[a]), link.at(1.0, present.balance.active[a]));
    }
  for (const auto& [number, touch] : present.balance.touches)
    {
      const ActiveLink<dim> open = history.as_at_event(number);
      const LinkOnTheWay<dim> link(history, number, &open, way);
      correct(link, link.at(0.0), link.at(1.0, touch));
    }
  const auto presses_on = [&](const std::uint32_t pair) {
    return std::ranges::any_of(present.balance.touches, [pair](const auto& touch) { return touch.first == pair; });
  };
  for (const auto& [number, touch] : at_event.touches)
    if (!history.is_active(number) && !presses_on(number))
      {
        const ActiveLink<dim> pressed = history.as_at_event(number);
        const LinkOnTheWay<dim> link(history, number, &pressed, way);
        correct(link, link.at(0.0, touch), link.at(1.0));
      }
  if (history.is_finite())
    for (std::uint32_t number = 0; number < network.n_joints(); ++number)
      if (!history.is_active(number))
        {
          const LinkOnTheWay<dim> link(history, number, nullptr, way);
          correct(link, link.at(0.0), link.at(1.0));
        }
  return work;
}

template NetworkWork work_on_the_way(const NetworkHistory<2>&, const Balance<2>&, const Configuration<2>&);
template NetworkWork work_on_the_way(const NetworkHistory<3>&, const Balance<3>&, const Configuration<3>&);
} // namespace feldspar
