#pragma once

#include "dem/storage/simd_transpose.h"

#include <array>
#include <cstddef>
#include <type_traits>

#ifdef __FMA__
#include <immintrin.h>
#endif

/// The columns of a block of BlockFactor: one vector of the processor each, of as many numbers as a grain has motions and zeros
/// below them.
namespace feldspar
{
// sum - a b, rounded once where the processor can: the same bits by each that can.
#ifdef __FMA__
inline simd::Four minus_product(const simd::Four& sum, const simd::Four& a, const simd::Four& b)
{
  return _mm256_fnmadd_pd(a, b, sum);
}
#else
inline simd::Four minus_product(const simd::Four& sum, const simd::Four& a, const simd::Four& b) { return sum - a * b; }
#endif
inline simd::Four minus_product(const simd::Four& sum, const simd::Four& a, const double b)
{
  return minus_product(sum, a, simd::Four{b, b, b, b});
}

inline double sum_of(const simd::Four& v) { return (v[0] + v[1]) + (v[2] + v[3]); }

/// Six numbers in single precision.
using SingleColumnOfSix = std::array<float, 6>;

#if defined(__AVX512VL__) && defined(__FMA__)
using ColumnOfSix = simd::Eight;

inline ColumnOfSix widened(const SingleColumnOfSix& column)
{
  return _mm512_cvtps_pd(_mm256_maskz_loadu_ps(0b111111, column.data()));
}

inline ColumnOfSix minus_product(const ColumnOfSix& sum, const ColumnOfSix& a, const ColumnOfSix& b)
{
  return _mm512_fnmadd_pd(a, b, sum);
}
inline ColumnOfSix minus_product(const ColumnOfSix& sum, const ColumnOfSix& a, const double b)
{
  return minus_product(sum, a, _mm512_set1_pd(b));
}

inline double sum_of(const ColumnOfSix& column) { return sum_of(simd::low_half(column) + simd::high_half(column)); }
#else
/// Six numbers and two zeros, on a processor whose vectors have four: GCC moves its vectors of eight there in pieces of eight
/// and sixteen bytes, by which a solution took twice as long.
struct ColumnOfSix
{
  std::array<simd::Four, 2> halves{};

  double& operator[](const int k) { return reinterpret_cast<double*>(halves.data())[k]; }
  double operator[](const int k) const { return reinterpret_cast<const double*>(halves.data())[k]; }

  ColumnOfSix& operator-=(const ColumnOfSix& other)
  {
    halves[0] -= other.halves[0];
    halves[1] -= other.halves[1];
    return *this;
  }

  friend ColumnOfSix operator*(const ColumnOfSix& one, const ColumnOfSix& other)
  {
    return {{one.halves[0] * other.halves[0], one.halves[1] * other.halves[1]}};
  }
  friend ColumnOfSix operator*(const ColumnOfSix& one, const double factor)
  {
    return {{one.halves[0] * factor, one.halves[1] * factor}};
  }
};

inline ColumnOfSix minus_product(const ColumnOfSix& sum, const ColumnOfSix& a, const ColumnOfSix& b)
{
  return {
    {minus_product(sum.halves[0], a.halves[0], b.halves[0]), minus_product(sum.halves[1], a.halves[1], b.halves[1])}};
}
inline ColumnOfSix minus_product(const ColumnOfSix& sum, const ColumnOfSix& a, const double b)
{
  return {{minus_product(sum.halves[0], a.halves[0], b), minus_product(sum.halves[1], a.halves[1], b)}};
}

inline double sum_of(const ColumnOfSix& column) { return sum_of(column.halves[0] + column.halves[1]); }

inline ColumnOfSix widened(const SingleColumnOfSix& column)
{
#ifdef __FMA__
  const __m128 last_two = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&column[4])));
  return {{_mm256_cvtps_pd(_mm_loadu_ps(column.data())), _mm256_cvtps_pd(last_two)}};
#else
  return {{simd::Four{column[0], column[1], column[2], column[3]}, simd::Four{column[4], column[5], 0.0, 0.0}}};
#endif
}
#endif

inline const simd::Four& widened(const simd::Four& column) { return column; }

template <int dim>
using BlockColumn = std::conditional_t<dim == 2, simd::Four, ColumnOfSix>;

/// Block column as a factor keeps it: in space in single precision, because each solution loads it from the memory or a
/// large cache. A factor of the plane lies in a nearer cache, where conversion takes longer than loading.
template <int dim>
using KeptBlockColumn = std::conditional_t<dim == 2, simd::Four, SingleColumnOfSix>;

template <int dim>
KeptBlockColumn<dim> kept(const BlockColumn<dim>& column)
{
  if constexpr (dim == 2)
    return column;
  else
    {
      SingleColumnOfSix single;
      for (int k = 0; k < 6; ++k)
        single[std::size_t(k)] = float(column[k]);
      return single;
    }
}
} // namespace feldspar
