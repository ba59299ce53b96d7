#pragma once

#include "results/fits/hoek_brown.h"

#include <functional>
#include <string>
#include <vector>

namespace feldspar
{
/// A fit in the key of a picture: H–B intact, with σ_t.
std::string label_of(const HoekBrownFit& fit);

/// Abscissas of an envelope, closer where it bends, near its beginning.
std::vector<double> abscissas(double begin, double end);

/// Normal and shear stress on the plane that fails, compression positive [Pa].
struct PlaneStress
{
  double normal;
  double shear;
};

/// Point at which the Mohr circle of an envelope's state at sigma_3 touches the envelope of all circles (Balmer 1952):
/// sigma_n = sigma_3 + (sigma_1 - sigma_3)/(N + 1), tau = (sigma_n - sigma_3) sqrt(N), N = d sigma_1/d sigma_3.
PlaneStress touching_point(const std::function<double(double)>& sigma_1, double sigma_3);
} // namespace feldspar
