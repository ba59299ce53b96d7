#pragma once

#include "base/random.h"
#include "dem/laws/bond_strength.h"
#include "dem/laws/parameters.h"

#include <cmath>

namespace feldspar
{
/// Modulus m (the shape) of the Weibull distribution with this standard deviation over its mean,
/// v² = Γ(1+2/m) / Γ(1+1/m)² - 1.
inline double weibull_modulus(const double variation)
{
  if (variation < 1e-3) // beyond it the difference above is lost in round-off; π / (√6 v), the limit
    return 1.2825498 / variation;
  // The secant rule on ln v² over ln m, which is nearly straight: five steps end in round-off.
  const auto excess = [&](const double log_m) {
    const double mean = std::tgamma(1.0 + std::exp(-log_m));
    return std::log(std::tgamma(1.0 + 2.0 * std::exp(-log_m)) / (mean * mean) - 1.0) - 2.0 * std::log(variation);
  };
  double before = -1.086 * std::log(variation);
  double now = before + 0.05;
  double excess_before = excess(before);
  for (int k = 0; k < 5; ++k)
    {
      const double excess_now = excess(now);
      if (excess_now == excess_before)
        break;
      const double next = now - excess_now * (now - before) / (excess_now - excess_before);
      before = now;
      excess_before = excess_now;
      now = next;
    }
  return std::exp(now);
}

/// A strength [Pa] of its distribution.
inline double draw_strength(const StrengthDistribution distribution, const double mean, const double deviation,
                            Random& random)
{
  if (distribution == StrengthDistribution::normal)
    return random.non_negative_normal(mean, deviation);
  if (!(mean > 0.0 && deviation > 0.0))
    return mean;
  const double modulus = weibull_modulus(deviation / mean);
  return mean / std::tgamma(1.0 + 1.0 / modulus) * std::pow(-std::log(1.0 - random.uniform()), 1.0 / modulus);
}

/// The strengths of one bond from their distributions, tension first.
template <typename Parameters>
Bond<double> draw_bond(const Parameters& wanted, Random& random)
{
  const auto draw = [&](const double mean, const double deviation) {
    return draw_strength(wanted.strength_distribution, mean, deviation, random);
  };
  const double tensile_strength = draw(wanted.bond_tensile_strength, wanted.bond_tensile_strength_deviation);
  const double cohesion = draw(wanted.bond_cohesion, wanted.bond_cohesion_deviation);
  return {tensile_strength, cohesion, std::tan(wanted.bond_friction_angle)};
}
} // namespace feldspar
