#include "results/emission.h"

#include "base/mapped.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace feldspar
{
namespace
{
/// Eigenvalues, the largest first.
Eigen::Vector3d eigenvalues(const EmissionEvent& event, const int dimension)
{
  const auto& m = event.moment;
  Eigen::Matrix3d tensor;
  tensor << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5];
  if (dimension == 2)
    tensor(2, 2) = 0.5 * (m[0] + m[3]);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues().reverse();
}
} // namespace

SourceMechanism mechanism(const EmissionEvent& event, const int dimension)
{
  const Eigen::Vector3d m = eigenvalues(event, dimension);
  const double counted = m.squaredNorm() - (dimension == 2 ? m[1] * m[1] : 0.0);
  SourceMechanism result{};
  result.scalar_moment = std::sqrt(0.5 * counted);
  result.magnitude = result.scalar_moment > 0.0 ? std::log10(result.scalar_moment) / 1.5 - 6.07
                                                : std::numeric_limits<double>::quiet_NaN();
  const double isotropic = m.mean();
  const double clvd = 2.0 / 3.0 * (m[0] + m[2] - 2.0 * m[1]);
  const double double_couple = 0.5 * (m[0] - m[2] - std::abs(m[0] + m[2] - 2.0 * m[1]));
  const double whole = std::abs(isotropic) + std::abs(clvd) + double_couple;
  if (!(whole > 0.0))
    return result;
  result.isotropic = isotropic / whole;
  result.clvd = clvd / whole;
  result.double_couple = double_couple / whole;

  const double trace = dimension == 2 ? m[0] + m[2] : m.sum();
  const double of_volume = trace / (std::abs(trace) + (m.array() - isotropic).abs().sum());
  result.kind = of_volume > 0.3 ? "tensile" : of_volume < -0.3 ? "implosive" : "shear";
  return result;
}

std::vector<EmissionEvent> events_up_to_peak(const TestRecord& record, const std::optional<double>& strain_at_peak,
                                             const double from, const double to)
{
  std::vector<EmissionEvent> found;
  const auto& curve = record.curve;
  const auto deviator = [&](const CurveSample& row) { return record.kind.deviator(row, record.confining_pressure); };
  const auto peak = std::ranges::find_if(
    curve, [&](const CurveSample& row) { return strain_at_peak && record.kind.strain(row) >= *strain_at_peak; });
  if (peak == curve.end())
    return found;
  auto row = curve.begin();
  double highest = deviator(*row);
  for (const EmissionEvent& event : record.events) // in the order of their steps
    {
      for (; row != peak && row->step < event.step; ++row)
        highest = std::max(highest, deviator(*row));
      const double share = highest / deviator(*peak);
      if (event.step <= peak->step && share >= from && share < to)
        found.push_back(event);
    }
  return found;
}

std::vector<double> magnitudes_of(const std::vector<EmissionEvent>& events, const int dimension)
{
  return mapped<double>(events, [&](const EmissionEvent& event) { return mechanism(event, dimension).magnitude; });
}

HudsonPlace hudson_place(const EmissionEvent& event, const int dimension)
{
  const Eigen::Vector3d m = eigenvalues(event, dimension);
  const double largest = m.cwiseAbs().maxCoeff();
  return {-2.0 / 3.0 * (m[0] + m[2] - 2.0 * m[1]) / largest, m.mean() / largest};
}

double energy_magnitude(const double energy)
{
  return energy > 0.0 ? std::log10(energy) / 1.5 - 2.9 : std::numeric_limits<double>::quiet_NaN();
}

std::optional<MagnitudeFrequency> magnitude_frequency(const std::vector<double>& magnitudes, const double step)
{
  constexpr double bin = 0.1;
  constexpr std::size_t fewest = 30;
  std::map<double, std::size_t> n_of_bin;
  for (const double one : magnitudes)
    if (std::isfinite(one))
      ++n_of_bin[std::floor((one + 0.5 * step) / bin)];
  if (n_of_bin.empty())
    return std::nullopt;
  const auto fullest =
    std::ranges::max_element(n_of_bin, [](const auto& a, const auto& b) { return a.second < b.second; });
  MagnitudeFrequency result{};
  result.completeness = bin * fullest->first - 0.5 * step;
  std::vector<double> counted;
  std::ranges::copy_if(magnitudes, std::back_inserter(counted),
                       [&](const double one) { return one >= result.completeness; });
  result.n = counted.size();
  if (result.n < fewest)
    return std::nullopt;
  const auto n = double(result.n);
  double mean = 0.0, squares = 0.0, rises = 0.0, n_rises = 0.0;
  for (const double one : counted)
    mean += one / n;
  for (const double one : counted)
    squares += (one - mean) * (one - mean);
  double last = std::numeric_limits<double>::quiet_NaN(); // no rise goes across one
  for (const double one : magnitudes)
    {
      if (one > last)
        {
          rises += one - last;
          ++n_rises;
        }
      if (!(one < result.completeness))
        last = one;
    }
  if (!(mean > result.completeness) || n_rises == 0.0)
    return std::nullopt;
  result.b = std::numbers::log10e / (mean - result.completeness);
  result.error = std::numbers::ln10 * result.b * result.b * std::sqrt(squares / (n * (n - 1.0)));
  result.b_positive = std::numbers::log10e * n_rises / (rises - 0.5 * step * n_rises);
  return result;
}

std::vector<double> EmissionCatalogue::magnitudes_to_peak() const
{
  const bool has_stress = !events.empty() && std::isfinite(events.front().stress);
  const auto peak = std::ranges::max_element(events, [](const auto& a, const auto& b) { return a.stress < b.stress; });
  std::vector<double> magnitudes;
  for (auto event = events.begin(); event != events.end() && (!has_stress || event <= peak); ++event)
    magnitudes.push_back(event->magnitude);
  return magnitudes;
}

double EmissionCatalogue::step() const
{
  std::set<double> different;
  for (const RecordedEmission& event : events)
    if (std::isfinite(event.magnitude))
      different.insert(event.magnitude);
  double smallest = std::numeric_limits<double>::infinity();
  for (auto next = different.begin(), last = next; next != different.end() && ++next != different.end(); last = next)
    smallest = std::min(smallest, *next - *last);
  return different.size() > 1 ? smallest : 0.0;
}
} // namespace feldspar
