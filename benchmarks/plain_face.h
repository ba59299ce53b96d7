#pragma once

#include <cmath>
#include <cstddef>

/// The equations of a face of plain_laboratory.h: docs/theory.md §1.1 to §1.4, one number at a time.
namespace feldspar::plain
{
constexpr std::size_t n_segments = 4; // of a face

struct Segment
{
  double tau, tensile_strength, cohesion;
  bool bonded;
};

/// Forces of a face, compression positive, and its moment about the contact point.
struct Resultants
{
  double normal, shear, moment;
};

/// Normal force and moment of a segment, and the energy that it stores.
struct NormalResponse
{
  double force, moment, energy;
};

/// Exact integrals of the stress k_n g over a segment of length l: everywhere if it is bonded, else where it is closed.
inline NormalResponse normal_response(const double k_n, const double l, const double t, const double gap,
                                      const double theta, const bool bonded)
{
  const double rise = std::abs(theta) * l, low = gap - 0.5 * rise, high = gap + 0.5 * rise;
  if (bonded || high <= 0.0)
    return {-k_n * l * t * gap, -k_n * t * theta * l * l * l / 12.0,
            0.5 * k_n * t * (l * gap * gap + theta * theta * l * l * l / 12.0)};
  if (low >= 0.0)
    return {0.0, 0.0, 0.0};
  const double h = l * -low / rise, force = -0.5 * k_n * t * h * low;
  return {force, (theta < 0.0 ? 1.0 : -1.0) * force * (0.5 * l - h / 3.0), k_n * t * h * low * low / 6.0};
}

/// Centroid of a segment, over the half length of the face.
inline double centroid(const std::size_t segment)
{
  return (double(n_segments) - 1.0 - 2.0 * double(segment)) / double(n_segments);
}

/// The share of a step in which a gap that moves linearly is negative.
inline double closed_share(const double before, const double now)
{
  if ((before < 0.0) == (now < 0.0))
    return now < 0.0 ? 1.0 : 0.0;
  return (now < 0.0 ? now : -before) / (now - before);
}

/// The exact angle from one unit vector to another.
inline double angle(const double sine, const double cosine)
{
  if (const double s2 = sine * sine; s2 < 1e-6 && cosine > 0.0)
    return sine * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0)));
  return std::atan2(sine, cosine);
}
} // namespace feldspar::plain
