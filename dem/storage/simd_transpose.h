#pragma once

#include "base/simd.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// Conversion between records of four numbers, one for each of many things, and packs of one number of many things.
/// Numbers that a loop over joints gathers from grains, and leaves for them to gather, lie in records: a record comes
/// by one load, where numbers in arrays of their own take one each.
namespace feldspar::simd
{
using Four = double __attribute__((vector_size(4 * sizeof(double))));

using Eight = double __attribute__((vector_size(8 * sizeof(double))));

// Shuffles replace a way by memory, where a load would wait for the two stores that it spans.
inline Eight joined(const Four& low, const Four& high)
{
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline Four low_half(const Eight& eight) { return __builtin_shufflevector(eight, eight, 0, 1, 2, 3); }
inline Four high_half(const Eight& eight) { return __builtin_shufflevector(eight, eight, 4, 5, 6, 7); }

inline Four load_four(const double* const from)
{
  Four four;
  std::memcpy(&four, from, sizeof four);
  return four;
}

inline void store_four(const Four& four, double* const to) { std::memcpy(to, &four, sizeof four); }

/// Rows and columns of 4 × 4 numbers changed over.
inline std::array<Four, 4> transposed(const std::array<Four, 4>& rows)
{
  const Four even_01 = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
  const Four odd_01 = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
  const Four even_23 = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
  const Four odd_23 = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  return {__builtin_shufflevector(even_01, even_23, 0, 1, 4, 5), __builtin_shufflevector(odd_01, odd_23, 0, 1, 4, 5),
          __builtin_shufflevector(even_01, even_23, 2, 3, 6, 7), __builtin_shufflevector(odd_01, odd_23, 2, 3, 6, 7)};
}

/// The four numbers at from + stride index[0], from + stride index[1], …; number by number.
template <typename Real>
std::array<Real, 4> gather_records(const double* const from, const std::size_t stride, const std::uint32_t* const index)
{
  constexpr std::size_t n = width<Real>;
  const auto record = [&](const std::size_t i) { return load_four(from + stride * index[i]); };
  if constexpr (n == 4)
    {
      const auto columns = transposed({record(0), record(1), record(2), record(3)});
      return {std::bit_cast<Real>(columns[0]), std::bit_cast<Real>(columns[1]), std::bit_cast<Real>(columns[2]),
              std::bit_cast<Real>(columns[3])};
    }
  else if constexpr (n == 8)
    {
      const auto low = transposed({record(0), record(1), record(2), record(3)});
      const auto high = transposed({record(4), record(5), record(6), record(7)});
      const auto whole = [&](const std::size_t c) { return std::bit_cast<Real>(joined(low[c], high[c])); };
      return {whole(0), whole(1), whole(2), whole(3)};
    }
  else
    {
      std::array<Real, 4> numbers;
      for (std::size_t c = 0; c < 4; ++c)
        if constexpr (n == 1)
          numbers[c] = from[stride * *index + c];
        else
          numbers[c] = Real([&](const auto i) { return from[stride * index[i] + c]; });
      return numbers;
    }
}

/// The inverse, to to, to + stride, …: a record for each member of the packs.
template <typename Real>
void store_records(const std::array<Real, 4>& numbers, double* const to, const std::size_t stride)
{
  constexpr std::size_t n = width<Real>;
  if constexpr (n == 4)
    {
      const auto records = transposed({std::bit_cast<Four>(numbers[0]), std::bit_cast<Four>(numbers[1]),
                                       std::bit_cast<Four>(numbers[2]), std::bit_cast<Four>(numbers[3])});
      for (std::size_t i = 0; i < 4; ++i)
        store_four(records[i], to + stride * i);
    }
  else if constexpr (n == 8)
    {
      const auto eight = [&](const std::size_t c) { return std::bit_cast<Eight>(numbers[c]); };
      const auto low = transposed({low_half(eight(0)), low_half(eight(1)), low_half(eight(2)), low_half(eight(3))});
      const auto high =
        transposed({high_half(eight(0)), high_half(eight(1)), high_half(eight(2)), high_half(eight(3))});
      for (std::size_t i = 0; i < 4; ++i)
        {
          store_four(low[i], to + stride * i);
          store_four(high[i], to + stride * (i + 4));
        }
    }
  else
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < 4; ++c)
        to[stride * i + c] = lane(numbers[c], i);
}
} // namespace feldspar::simd
