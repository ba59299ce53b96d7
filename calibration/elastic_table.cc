#include "calibration/elastic_table.h"

#include <algorithm>
#include <cmath>

namespace feldspar::calibration
{
namespace
{
/// The entry below x and the share of the way to the next.
std::pair<std::size_t, double> place(const std::vector<double>& entries, const double x)
{
  if (entries.size() == 1 || x <= entries.front())
    return {0, 0.0};
  if (x >= entries.back())
    return {entries.size() - 2, 1.0};
  const auto above = std::ranges::upper_bound(entries, x);
  const auto k = std::size_t(above - entries.begin()) - 1;
  return {k, (x - entries[k]) / (entries[k + 1] - entries[k])};
}

std::vector<double> logarithms(std::vector<double> values)
{
  for (double& value : values)
    value = std::log(value);
  return values;
}
} // namespace

ElasticTable::ElasticTable(std::vector<double> stiffness_ratios, std::vector<double> gaps,
                           std::vector<std::vector<Constants>> constants)
  : of_ratio(logarithms(std::move(stiffness_ratios)))
  , of_gap(logarithms(std::move(gaps)))
  , entries(std::move(constants))
{
}

ElasticTable::Constants ElasticTable::at(const double stiffness_ratio, const double gap) const
{
  const auto [r, share_r] = place(of_ratio, std::log(stiffness_ratio));
  const auto [g, share_g] = of_gap.size() > 1 ? place(of_gap, std::log(gap)) : std::pair(std::size_t(0), 0.0);
  Constants sum{0.0, 0.0};
  const auto add = [&](const std::size_t i, const std::size_t k, const double weight) {
    if (weight == 0.0)
      return;
    sum.modulus_ratio += weight * entries[i][k].modulus_ratio;
    sum.poissons_ratio += weight * entries[i][k].poissons_ratio;
  };
  add(g, r, (1.0 - share_g) * (1.0 - share_r));
  add(g, r + 1, (1.0 - share_g) * share_r);
  add(g + 1, r, share_g * (1.0 - share_r));
  add(g + 1, r + 1, share_g * share_r);
  return sum;
}

std::pair<ElasticTable::Constants, ElasticTable::Constants> ElasticTable::range() const
{
  Constants least = entries.front().front();
  Constants most = least;
  for (const auto& row : entries)
    for (const Constants& one : row)
      {
        least = {std::min(least.modulus_ratio, one.modulus_ratio), std::min(least.poissons_ratio, one.poissons_ratio)};
        most = {std::max(most.modulus_ratio, one.modulus_ratio), std::max(most.poissons_ratio, one.poissons_ratio)};
      }
  return {least, most};
}
} // namespace feldspar::calibration
