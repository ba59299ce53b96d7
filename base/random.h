#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace feldspar
{
/// The purpose of a stream of random numbers; each has its own, so that changing one leaves the others as they were.
enum class RandomStream : std::uint32_t
{
  radii = 1,
  positions = 2,
  bonds = 3,
  strengths = 4,
  dealing = 5,    ///< of RVEs to the points of a sample
  joint_sets = 6, ///< where their traces begin
  mineral_grains = 7,
  clumps = 8,
  kinds_of_cells = 9, ///< and how they lie
  shares = 10         ///< of minerals: the order in which grains change over
};

/// The same numbers from the same seed with every compiler and library: the engine and its seeding are fixed by the
/// C++ standard, the distributions of the standard library are not and stay out.
class Random
{
public:
  Random(const std::uint64_t seed, const RandomStream stream)
  {
    std::seed_seq sequence{std::uint32_t(seed), std::uint32_t(seed >> 32), std::uint32_t(stream)};
    engine.seed(sequence);
  }

  /// Random number in [0, 1).
  double uniform() { return double(engine() >> 11) * 0x1p-53; }

  double uniform(const double low, const double high) { return low + (high - low) * uniform(); }

  /// Marsaglia's polar method.
  double normal(const double mean, const double deviation)
  {
    for (;;)
      {
        const double u = uniform(-1.0, 1.0);
        const double v = uniform(-1.0, 1.0);
        const double s = u * u + v * v;
        if (s > 0.0 && s < 1.0)
          return mean + deviation * u * std::sqrt(-2.0 * std::log(s) / s);
      }
  }

  /// Normal, drawn again while negative. mean >= 0.
  double non_negative_normal(const double mean, const double deviation)
  {
    for (;;)
      if (const double value = normal(mean, deviation); value >= 0.0)
        return value;
  }

  /// Fisher and Yates.
  template <typename T>
  void shuffle(std::vector<T>& values)
  {
    for (std::size_t n = values.size(); n > 1; --n)
      std::swap(values[n - 1], values[std::size_t(uniform() * double(n))]);
  }

private:
  std::mt19937_64 engine;
};
} // namespace feldspar
