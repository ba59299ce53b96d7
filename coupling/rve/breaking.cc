#include "coupling/rve/breaking.h"

#include <algorithm>
#include <variant>

namespace feldspar
{
namespace
{
constexpr double near_worst_share = 0.98;
constexpr double tie = 1e-9; // overloads so near each other are the same; the segment's number decides
} // namespace

template <int dim>
std::vector<Overload> overloads(const NetworkHistory<dim>& history, const Configuration<dim>& present,
                                const BreakRule rule)
{
  const Network<dim>& network = history.network();
  std::vector<Overload> result;
  const auto check = [&](const std::uint32_t segment, const BondStress& stress) {
    if (const Bond<double>& bond = network.bond(segment); is_overloaded(bond, stress))
      result.push_back({overload_ratio(bond, stress), segment, breaks_in_tension(bond, stress)});
  };
  const auto check_all = [&](const auto& law) {
    for (std::uint32_t k = 0; k < network.n_joints(); ++k)
      {
        const Link<dim>& link = network.links()[k];
        const bool is_active = history.is_active(k);
        const Motion<dim> motion = is_active ? Motion<dim>::Zero() : history.motion(k, present.position);
        for (std::uint32_t i = 0; i < link.n_segments; ++i)
          {
            if (is_active)
              {
                if (!history.active()[history.active_number(k)].segments[i].bonded)
                  continue;
                check(link.first_segment + i, present.balance.active[history.active_number(k)].segments[i].bond_stress);
              }
            else
              {
                const auto strain = law.strain(element_rows(network.elements()[i], link.half_length), motion);
                check(link.first_segment + i, law.bond_stress(link.face(network.thickness()), strain));
              }
          }
      }
  };
  std::visit(check_all, network.law());
  double worst = 0.0;
  for (const Overload& overload : result)
    worst = std::max(worst, overload.ratio);
  if (rule == BreakRule::only_worst)
    {
      // The first by number among equals.
      const auto first = std::find_if(result.begin(), result.end(),
                                      [&](const Overload& overload) { return overload.ratio >= worst * (1.0 - tie); });
      return first == result.end() ? std::vector<Overload>() : std::vector<Overload>{*first};
    }
  std::erase_if(result,
                [&](const Overload& overload) { return overload.ratio < near_worst_share * worst * (1.0 - tie); });
  return result;
}

template <int dim>
double share_until(const std::vector<Overload>& overloads, const NetworkHistory<dim>& history, const Unknowns& position)
{
  const Network<dim>& network = history.network();
  double first = 1.0;
  for (const Overload& overload : overloads)
    {
      const std::uint32_t number = network.link_of_segment(overload.segment);
      const Link<dim>& link = network.links()[number];
      const auto rows = element_rows(network.elements()[overload.segment - link.first_segment], link.half_length);
      const Bond<double>& bond = network.bond(overload.segment);
      const auto shorten = [&](const auto& law) {
        const auto before = law.strain(rows, history.motion(number, history.position()));
        const auto now = law.strain(rows, history.motion(number, position));
        const auto holds = [&](const double share) {
          const std::remove_const_t<decltype(now)> strain = before + share * (now - before);
          return !is_overloaded(bond, law.bond_stress(link.face(network.thickness()), strain));
        };
        double low = 0.0;
        double high = first;
        if (holds(high))
          return;
        while (high - low > 1e-3 * high)
          (holds(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
        first = high;
      };
      std::visit(shorten, network.law());
    }
  return first;
}

template std::vector<Overload> overloads(const NetworkHistory<2>&, const Configuration<2>&, BreakRule);
template std::vector<Overload> overloads(const NetworkHistory<3>&, const Configuration<3>&, BreakRule);
template double share_until(const std::vector<Overload>&, const NetworkHistory<2>&, const Unknowns&);
template double share_until(const std::vector<Overload>&, const NetworkHistory<3>&, const Unknowns&);
} // namespace feldspar
