#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace feldspar
{
/// A sum of numbers without rounding, so that it depends neither on their order nor on who adds which: a number of fixed
/// point that reaches from the smallest to the largest double, in words of 32 bits that carry late (Kulisch and Miranker
/// 1986). Takes up to 2²⁹ numbers.
class ExactSum
{
public:
  static constexpr std::size_t n_words = 68;

  void add(const double value)
  {
    if (value == 0.0)
      return;
    if (!std::isfinite(value))
      {
        not_finite += value;
        return;
      }
    constexpr int n_fraction_bits = 52, word_bits = 32;
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto exponent = int(bits >> n_fraction_bits & 0x7ff);
    const std::uint64_t fraction = (bits & 0xfffffffffffffull) | (exponent > 0 ? 1ull << n_fraction_bits : 0);
    const int place = exponent > 0 ? exponent - 1 : 0; // of the last bit, in units of the smallest double
    const std::size_t word = std::size_t(place / word_bits);
    const int shift = place % word_bits;
    constexpr std::uint64_t low_word = 0xffffffff;
    const std::uint64_t low = (fraction & low_word) << shift, high = (fraction >> word_bits) << shift;
    const std::uint64_t sign = value < 0.0 ? ~0ull : 1ull; // as two's complement
    words[word] += sign * (low & low_word);
    words[word + 1] += sign * ((low >> word_bits) + (high & low_word));
    words[word + 2] += sign * (high >> word_bits);
  }

  void add(const ExactSum& other)
  {
    not_finite += other.not_finite;
    for (std::size_t k = 0; k < n_words; ++k)
      words[k] += other.words[k];
    carry();
  }

  /// The sum, rounded to within a unit in the last place; the same for the same sum.
  double value() const
  {
    ExactSum magnitude = *this;
    magnitude.carry();
    const bool is_negative = std::int64_t(magnitude.words.back()) < 0;
    if (is_negative)
      {
        for (std::uint64_t& word : magnitude.words)
          word = 0 - word;
        magnitude.carry();
      }
    double sum = 0.0;
    for (std::size_t k = n_words; k-- > 0;)
      sum += std::ldexp(double(magnitude.words[k]), int(32 * k) - 1074);
    return not_finite + (is_negative ? -sum : sum);
  }

private:
  /// All words but the last non-negative and below 2³².
  void carry()
  {
    for (std::size_t k = 0; k + 1 < n_words; ++k)
      {
        const auto over = std::uint64_t(std::int64_t(words[k]) >> 32);
        words[k] -= over << 32;
        words[k + 1] += over;
      }
  }

  std::array<std::uint64_t, n_words> words{}; ///< signed, as two's complement
  double not_finite = 0.0;
};
} // namespace feldspar
