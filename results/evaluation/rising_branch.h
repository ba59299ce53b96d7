#pragma once

#include "laboratory/paired_moments.h"
#include "results/quantities.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
/// A figure of its value, which a gauge with too few grains does not have.
inline Figure known(const double value)
{
  if (std::isfinite(value))
    return {value, ""};
  return {std::nullopt, "too few grains lie in the strain gauge"};
}

inline Figure unknown(std::string reason) { return {std::nullopt, std::move(reason)}; }

/// Two shares of the peak deviator.
struct Shares
{
  double low;
  double high;
};

/// The rising branch of a test up to its peak, positive in the sense of the test. Of a test without a peak it may be the
/// part before the first crack; its highest deviator then stands for that of the peak.
class RisingBranch
{
public:
  RisingBranch(const TestRecord& of_test, const std::size_t last_row, const Shares& shares = {0.05, 0.20})
    : record(of_test)
    , kind(of_test.kind)
    , rows(of_test.curve.data(), last_row + 1)
    , peak_deviator(deviator(rows.back()))
    , of_initial_slope(shares)
  {
  }

  double stress(const CurveSample& row) const { return kind.stress(row); }
  double strain(const CurveSample& row) const { return kind.strain(row); }
  double deviator(const CurveSample& row) const { return kind.deviator(row, record.confining_pressure); }
  const CurveSample& at_peak() const { return rows.back(); }

  /// First row whose deviator reaches this share of the peak's.
  std::size_t row_at(const double share) const
  {
    std::size_t k = 0;
    while (deviator(rows[k]) < share * peak_deviator)
      ++k;
    return k;
  }

  /// Slope of y over x between two shares of the peak.
  template <typename X, typename Y>
  Figure slope_between(const Shares& shares, X&& x_of, Y&& y_of) const
  {
    const std::size_t begin = row_at(shares.low);
    const std::size_t end = row_at(shares.high);
    if (end < begin + 2)
      return unknown("fewer than three rows of the curve between these stresses: choose a smaller sampling strain");
    std::vector<double> x, y;
    for (std::size_t k = begin; k <= end; ++k)
      {
        x.push_back(x_of(rows[k]));
        y.push_back(y_of(rows[k]));
      }
    return known(paired_moments(x, y).slope());
  }

  /// A value at a share of the peak, linear between the rows.
  template <typename Value>
  double at_share(const double share, Value&& value_of) const
  {
    const std::size_t k = row_at(share);
    if (k == 0)
      return value_of(rows[0]);
    const double s0 = deviator(rows[k - 1]);
    const double s1 = deviator(rows[k]);
    const double weight = (share * peak_deviator - s0) / (s1 - s0);
    return (1.0 - weight) * value_of(rows[k - 1]) + weight * value_of(rows[k]);
  }

  /// Calls visit(row) from 5 % of the peak to the peak, where shares of the stress mean something.
  template <typename Visitor>
  void loaded_rows(Visitor&& visit) const
  {
    for (std::size_t k = row_at(0.05); k < rows.size(); ++k)
      if (!kind.follows_stages || deviator(rows[k]) >= 0.05 * peak_deviator) // it may unload in between
        visit(rows[k]);
  }

  const TestRecord& record;
  const TestKind& kind;
  std::span<const CurveSample> rows;
  double peak_deviator;
  Shares of_initial_slope; ///< between which the initial elastic constants are measured
};
} // namespace feldspar
