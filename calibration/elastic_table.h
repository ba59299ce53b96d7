#pragma once

#include <utility>
#include <vector>

namespace feldspar::calibration
{
/// Elastic constants of the intact rock, from representative volumes: Young's modulus over that of the joints, and
/// Poisson's ratio, over stiffness ratio and installation gap. Between its entries they are interpolated linearly over
/// the logarithms of both; with the entries that a calibration makes, Poisson's ratio is then off by 0.0003 at most
/// (tests/unit/calibration_test.cc).
class ElasticTable
{
public:
  struct Constants
  {
    double modulus_ratio;
    double poissons_ratio;
  };

  /// Ascending; one entry or more each. constants: [gap][stiffness ratio].
  ElasticTable(std::vector<double> stiffness_ratios, std::vector<double> gaps,
               std::vector<std::vector<Constants>> constants);

  /// Beyond the table's ends, those at its ends.
  Constants at(double stiffness_ratio, double gap) const;

  /// The least and the largest constants of all entries.
  std::pair<Constants, Constants> range() const;

private:
  std::vector<double> of_ratio; ///< logarithms
  std::vector<double> of_gap;
  std::vector<std::vector<Constants>> entries;
};
} // namespace feldspar::calibration
