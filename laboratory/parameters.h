#pragma once

#include <algorithm>
#include <any>
#include <cstddef>
#include <map>
#include <optional>
#include <typeindex>
#include <vector>

/// Parameters of the laboratory tests, in SI units and radians, tension positive. Default-constructed values are the
/// defaults of the input.
namespace feldspar
{
/// Nothing that is rock is left at such a strain: every test ends there, whether its curve has peaked or not.
inline constexpr double largest_axial_strain = 0.2;

/// All tests share these members; what a protocol has of its own is declared beside it and found by its type.
struct TestParameters
{
  unsigned int n_snapshots = 32; ///< states of the grains that are kept, at most
  double platen_friction = 0.0;
  std::vector<double> gravity;    ///< acceleration of all grains, [dim]; empty: none [m/s²]
  double seating_transits = 10.0; ///< P-wave transits over which the confinement is raised
  double stop_strain_over_peak_strain = 1.6;
  std::optional<double> stop_strain;           ///< stop at this axial strain instead
  std::optional<double> stop_stress_over_peak; ///< or when the deviator has fallen to this share of its peak
  std::optional<double> least_peak_stress;     ///< of a deviator that is a peak [Pa]; none: that of waves
  double least_transits_to_peak = 4.0;         ///< of a wave along the specimen
  double least_fall_after_peak = 0.05;         ///< of the deviator, over the peak

  /// States that are kept of a body of so many grains, at most. They stay in memory: above 100 000 grains there are fewer, in
  /// inverse proportion, but not below 4.
  unsigned int snapshots_of(const std::size_t n_grains) const
  {
    constexpr std::size_t large = 100'000;
    const std::size_t in_proportion = std::max<std::size_t>(4, n_snapshots * large / std::max(large, n_grains));
    return unsigned(std::min<std::size_t>(n_snapshots, in_proportion));
  }

  /// The parameters `Own` of some protocols; their defaults until they are set.
  template <typename Own>
  const Own& of() const
  {
    static const Own defaults{};
    const auto found = own.find(typeid(Own));
    return found == own.end() ? defaults : *std::any_cast<Own>(&found->second);
  }
  template <typename Own>
  Own& of()
  {
    std::any& part = own[typeid(Own)];
    if (!part.has_value())
      part = Own{};
    return *std::any_cast<Own>(&part);
  }

private:
  std::map<std::type_index, std::any> own;
};
} // namespace feldspar
