// Rules by which segments break; docs/theory.md §9.3.

#include "coupling/rve/equilibrium.h"

#include <algorithm>
#include <variant>

namespace feldspar
{
namespace
{
constexpr double near_worst_share = 0.98;
constexpr double tie = 1e-9; // overloads so near each other are the same; the segment's number decides

/// Opening of a segment since rest [m].
template <int dim>
double opening_at(const Network<dim>& network, const NetworkHistory<dim>& history, const std::uint32_t link,
                  const std::uint32_t i, const Unknowns& position)
{
  return element_rows(network.elements()[i], network.links()[link].half_length).row(0) * history.motion(link, position);
}
} // namespace

template <int dim>
std::vector<Overload> Equilibrium<dim>::overloads() const
{
  here();
  std::vector<Overload> result;
  const auto check_softened = [&](const std::uint32_t k, const std::uint32_t i, const SegmentHistory<dim>& old) {
    const double opening = opening_at(network, history, k, i, present.position);
    const auto& shear_stress = present.balance.active[history.active_number(k)].segments[i].shear_stress;
    const auto demand =
      softening_demand(network, network.links()[k], i, old, opening, shear_stress, 1.0 / parameters.softening_steps);
    if (demand.exceeded)
      result.push_back({demand.ratio, network.links()[k].first_segment + i, opening > 0.0});
  };
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
                const SegmentHistory<dim>& old = history.active()[history.active_number(k)].segments[i];
                if (!old.bonded)
                  continue;
                if (old.has_softened())
                  check_softened(k, i, old);
                else
                  check(link.first_segment + i,
                        present.balance.active[history.active_number(k)].segments[i].bond_stress);
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
  if (parameters.break_rule == BreakRule::only_worst)
    {
      // The first by number among equals.
      const auto first =
        std::ranges::find_if(result, [&](const Overload& overload) { return overload.ratio >= worst * (1.0 - tie); });
      return first == result.end() ? std::vector<Overload>() : std::vector<Overload>{*first};
    }
  std::erase_if(result,
                [&](const Overload& overload) { return overload.ratio < near_worst_share * worst * (1.0 - tie); });
  return result;
}

template <int dim>
double Equilibrium<dim>::share_until(const std::vector<Overload>& overloads) const
{
  here();
  double first = 1.0;
  for (const Overload& overload : overloads)
    {
      const std::uint32_t number = network.link_of_segment(overload.segment);
      const Link<dim>& link = network.links()[number];
      const std::uint32_t i = overload.segment - link.first_segment;
      const auto rows = element_rows(network.elements()[i], link.half_length);
      const Bond<double>& bond = network.bond(overload.segment);
      const auto shorten = [&](const auto& law) {
        const auto before = law.strain(rows, history.motion(number, history.position()));
        const auto now = law.strain(rows, history.motion(number, present.position));
        const SegmentHistory<dim>* const old =
          history.is_active(number) ? &history.active()[history.active_number(number)].segments[i] : nullptr;
        const auto holds = [&](const double share) {
          const std::remove_const_t<decltype(now)> strain = before + share * (now - before);
          if (!old || !old->has_softened())
            return !is_overloaded(bond, law.bond_stress(link.face(network.thickness()), strain));
          auto shear_stress = present.balance.active[history.active_number(number)].segments[i].shear_stress;
          for (std::size_t c = 0; c < shear_stress.size(); ++c)
            shear_stress[c] = old->shear_stress[c] + share * (shear_stress[c] - old->shear_stress[c]);
          return !softening_demand(network, link, i, *old, strain[0], shear_stress, 1.0 / parameters.softening_steps)
                    .exceeded;
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

template std::vector<Overload> Equilibrium<2>::overloads() const;
template std::vector<Overload> Equilibrium<3>::overloads() const;
template double Equilibrium<2>::share_until(const std::vector<Overload>&) const;
template double Equilibrium<3>::share_until(const std::vector<Overload>&) const;
} // namespace feldspar
