#include "coupling/rve/breaking.h"

#include <algorithm>
#include <limits>

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
  const auto check = [&](const std::uint32_t segment, const double normal, const double shear) {
    const Strength& bond = network.strength(segment);
    const double shear_strength = std::max(0.0, bond.cohesion - network.friction_slope() * normal); // (15)
    const double in_tension = normal / bond.tensile;
    const double in_shear = shear_strength > 0.0 ? shear / shear_strength : std::numeric_limits<double>::infinity();
    if (normal > bond.tensile || shear > shear_strength)
      result.push_back({std::max(in_tension, in_shear), segment, normal > bond.tensile});
  };
  for (std::uint32_t k = 0; k < network.n_joints(); ++k)
    {
      const Link<dim>& link = network.links()[k];
      const bool is_active = history.is_active(k);
      const Motion<dim> motion = is_active ? Motion<dim>::Zero() : link_motion(link, present.position);
      for (std::uint32_t i = 0; i < link.n_segments; ++i)
        {
          if (is_active)
            {
              if (!history.active()[history.active_number(k)].segments[i].bonded)
                continue;
              const auto& segment = present.balance.active[history.active_number(k)].segments[i];
              check(link.first_segment + i, segment.normal_stress, flat_joint::magnitude(segment.shear_stress));
            }
          else
            {
              const Vector<dim> strain = element_rows(network.elements()[i], link.half_length) * motion;
              check(link.first_segment + i, link.normal_stiffness * strain[0],
                    link.shear_stiffness * strain.template tail<dim - 1>().norm());
            }
        }
    }
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
      const Vector<dim> before = rows * link_motion(link, history.position());
      const Vector<dim> now = rows * link_motion(link, position);
      const Strength& bond = network.strength(overload.segment);
      const auto holds = [&](const double share) {
        const Vector<dim> strain = before + share * (now - before);
        const double normal = link.normal_stiffness * strain[0];
        const double shear = link.shear_stiffness * strain.template tail<dim - 1>().norm();
        return normal <= bond.tensile && shear <= std::max(0.0, bond.cohesion - network.friction_slope() * normal);
      };
      double low = 0.0;
      double high = first;
      if (holds(high))
        continue;
      while (high - low > 1e-3 * high)
        (holds(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
      first = high;
    }
  return first;
}

template std::vector<Overload> overloads(const NetworkHistory<2>&, const Configuration<2>&, BreakRule);
template std::vector<Overload> overloads(const NetworkHistory<3>&, const Configuration<3>&, BreakRule);
template double share_until(const std::vector<Overload>&, const NetworkHistory<2>&, const Unknowns&);
template double share_until(const std::vector<Overload>&, const NetworkHistory<3>&, const Unknowns&);
} // namespace feldspar
