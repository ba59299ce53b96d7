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

/// Pairs of numbers of two vectors, for either half of eight numbers.
inline Four evens(const Four& a, const Four& b) { return __builtin_shufflevector(a, b, 0, 4, 2, 6); }
inline Four odds(const Four& a, const Four& b) { return __builtin_shufflevector(a, b, 1, 5, 3, 7); }
inline Four firsts(const Four& a, const Four& b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5); }
inline Four lasts(const Four& a, const Four& b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7); }
inline Eight evens(const Eight& a, const Eight& b) { return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); }
inline Eight odds(const Eight& a, const Eight& b) { return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15); }
inline Eight firsts(const Eight& a, const Eight& b) { return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13); }
inline Eight lasts(const Eight& a, const Eight& b) { return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15); }

/// Hands the columns of 4 × 4 numbers to put(0, column), …, put(3, column); of 4 × 8, those of both halves. One by one: a
/// list of columns would be written to memory and read again.
template <typename Vector, typename Put>
[[gnu::always_inline]] inline void transpose(const std::array<Vector, 4>& rows, Put&& put)
{
  const Vector even_01 = evens(rows[0], rows[1]), even_23 = evens(rows[2], rows[3]);
  const Vector odd_01 = odds(rows[0], rows[1]), odd_23 = odds(rows[2], rows[3]);
  put(0, firsts(even_01, even_23));
  put(1, firsts(odd_01, odd_23));
  put(2, lasts(even_01, even_23));
  put(3, lasts(odd_01, odd_23));
}

/// The four numbers at from + stride index[0], from + stride index[1], …; number by number.
template <typename Real>
std::array<Real, 4> gather_records(const double* const from, const std::size_t stride, const std::uint32_t* const index)
{
  constexpr std::size_t n = width<Real>;
  const auto record = [&](const std::size_t i) { return load_four(from + stride * index[i]); };
  std::array<Real, 4> numbers;
  const auto put = [&](const std::size_t c, const auto& column) { numbers[c] = std::bit_cast<Real>(column); };
  if constexpr (n == 4)
    transpose<Four>({record(0), record(1), record(2), record(3)}, put);
  else if constexpr (n == 8)
    {
      const auto two = [&](const std::size_t i) { return joined(record(i), record(i + 4)); };
      transpose<Eight>({two(0), two(1), two(2), two(3)}, put);
    }
  else
    for (std::size_t c = 0; c < 4; ++c)
      if constexpr (n == 1)
        numbers[c] = from[stride * *index + c];
      else
        numbers[c] = Real([&](const auto i) { return from[stride * index[i] + c]; });
  return numbers;
}

/// The inverse, to to, to + stride, …: a record for each member of the packs.
template <typename Real>
void store_records(const std::array<Real, 4>& numbers, double* const to, const std::size_t stride)
{
  constexpr std::size_t n = width<Real>;
  const auto rows_of = [&]<typename Vector>(const Vector&) {
    return std::array<Vector, 4>{std::bit_cast<Vector>(numbers[0]), std::bit_cast<Vector>(numbers[1]),
                                 std::bit_cast<Vector>(numbers[2]), std::bit_cast<Vector>(numbers[3])};
  };
  if constexpr (n == 4)
    transpose<Four>(rows_of(Four()),
                    [&](const std::size_t i, const Four& record) { store_four(record, to + stride * i); });
  else if constexpr (n == 8)
    transpose<Eight>(rows_of(Eight()), [&](const std::size_t i, const Eight& two) {
      store_four(low_half(two), to + stride * i);
      store_four(high_half(two), to + stride * (i + 4));
    });
  else
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < 4; ++c)
        to[stride * i + c] = lane(numbers[c], i);
}
} // namespace feldspar::simd
