#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <experimental/simd>

/// One spelling for a number and for a pack of numbers, so that a law written once serves the single contact and the
/// vectorised sweep. Every operation here is elementwise IEEE arithmetic: a pack gives the same bits as its members.
namespace feldspar::simd
{
using Pack = std::experimental::native_simd<double>;
using PackMask = Pack::mask_type;

template <typename Real>
inline constexpr std::size_t width = 1;
template <>
inline constexpr std::size_t width<Pack> = Pack::size();

inline double select(const bool condition, const double yes, const double no) { return condition ? yes : no; }
inline Pack select(const PackMask& condition, const Pack& yes, const Pack& no)
{
#ifdef __clang__
  // libstdc++'s where() chooses wrongly when clang compiles it for AVX-512.
  return Pack([&](const auto i) { return condition[i] ? double(yes[i]) : double(no[i]); });
#else
  Pack result = no;
  std::experimental::where(condition, result) = yes;
  return result;
#endif
}

inline bool any(const bool condition) { return condition; }
inline bool any(const PackMask& condition) { return std::experimental::any_of(condition); }

inline bool all(const bool condition) { return condition; }
inline bool all(const PackMask& condition) { return std::experimental::all_of(condition); }

inline bool lane(const bool condition, std::size_t) { return condition; }
inline bool lane(const PackMask& condition, const std::size_t i) { return condition[i]; }
inline double lane(const double value, std::size_t) { return value; }
inline double lane(const Pack& value, const std::size_t i) { return value[i]; }

inline double absolute(const double value) { return std::abs(value); }
inline Pack absolute(const Pack& value) { return std::experimental::abs(value); }

inline double square_root(const double value) { return std::sqrt(value); }
inline Pack square_root(const Pack& value) { return std::experimental::sqrt(value); }

/// Length of a vector in the plane of a face: one number in two dimensions, two in three.
template <typename Real>
Real magnitude(const std::array<Real, 1>& v)
{
  return absolute(v[0]);
}
template <typename Real>
Real magnitude(const std::array<Real, 2>& v)
{
  return square_root(v[0] * v[0] + v[1] * v[1]);
}

inline double larger(const double a, const double b) { return a < b ? b : a; }
inline Pack larger(const Pack& a, const Pack& b) { return select(a < b, b, a); }

inline double largest_lane(const Pack& value) { return std::experimental::hmax(value); }

inline double smaller(const double a, const double b) { return b < a ? b : a; }
inline Pack smaller(const Pack& a, const Pack& b) { return select(b < a, b, a); }

/// 1, 0 or -1.
template <typename Real>
Real sign(const Real& value)
{
  return select(value > 0.0, Real(1.0), select(value < 0.0, Real(-1.0), Real(0.0)));
}

template <typename Real>
Real load(const double* from);
template <>
inline double load<double>(const double* from)
{
  return *from;
}
template <>
inline Pack load<Pack>(const double* from)
{
  return Pack(from, std::experimental::element_aligned);
}

inline void store(const double value, double* to) { *to = value; }
inline void store(const Pack& value, double* to) { value.copy_to(to, std::experimental::element_aligned); }
} // namespace feldspar::simd
