#pragma once

#include "report/pictures/gnuplot.h"
#include "results/fits/strength_envelopes.h"
#include "results/runs/series.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace feldspar
{
/// Normal and shear stress on the plane that fails, compression positive [Pa].
struct PlaneStress
{
  double normal;
  double shear;
};

/// Where the Mohr circle of an envelope's state at sigma_3 touches the envelope of all circles (Balmer 1952):
/// sigma_n = sigma_3 + (sigma_1 - sigma_3)/(N + 1), tau = (sigma_n - sigma_3) sqrt(N), N = d sigma_1/d sigma_3.
PlaneStress touching_point(const std::function<double(double)>& sigma_1, double sigma_3);

/// Mohr circles of the mean strengths of a series, which is this one of all, with its envelopes and its direct shear
/// tests. Nothing of a series with fewer than two circles.
std::vector<Picture> mohr_picture(const Series& series, std::size_t which, const StrengthEnvelopes& envelopes);

/// Strengths of all series over the mean stress p = (σ₁ + σ₂ + σ₃)/3, as q = σ₁ − σ₃. Nothing without compression tests.
std::vector<Picture> p_q_picture(const std::vector<Series>& all, const std::vector<StrengthEnvelopes>& envelopes);
} // namespace feldspar
