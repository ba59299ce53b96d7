#include "dem/lab/protocols/bending.h"
#include "dem/lab/protocols/notch.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_part.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
constexpr double span_over_diameter = 0.6; // the suggested method allows 0.5 to 0.8

/// Y' of a half disc: K_I = Y' P √(πa) / (2 R B); notch_ratio: a/R (Kuruppu, Obara, Ayatollahi, Chong, Funatsu 2014, the
/// suggested method of the ISRM; plane strain).
double shape_factor(const double notch_ratio)
{
  const double s = span_over_diameter;
  return -1.297 + 9.516 * s - (0.47 + 16.457 * s) * notch_ratio + (1.071 + 34.401 * s) * notch_ratio * notch_ratio;
}

/// Size of the half disc, as long as wide and half as high; a core lies on its side, so that the half disc is cut
/// across it.
template <int dim>
Vector<dim> half_disc_size(const Specimen<dim>& specimen, const TestParameters& wanted)
{
  constexpr int axis = dim - 1;
  const double radius =
    specimen.is_round() ? 0.5 * specimen.size[0] : std::min(0.5 * specimen.size[0], specimen.size[axis]);
  Vector<dim> size = Vector<dim>::Constant(2.0 * radius);
  size[axis] = radius;
  if constexpr (dim == 3)
    size[1] = specimen.is_round()
                ? std::min(wanted.of<BrazilianParameters>().length_ratio * 2.0 * radius, specimen.size[2])
                : specimen.size[1];
  return size;
}

template <int dim>
SetUpTest<dim> set_up_semicircular_bending(Specimen<dim> specimen, double /*confining_pressure*/,
                                           const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  const Vector<dim> size = half_disc_size(specimen, wanted);
  Specimen<dim> whole = specimen.is_round() ? laid_on_side(specimen) : std::move(specimen);
  const double radius = size[axis];
  const double breadth = dim == 2 ? whole.thickness : size[1];
  Vector<dim> base = 0.5 * whole.size; // the middle of the flat side
  base[axis] -= whole.is_round() ? 0.0 : 0.5 * radius;
  std::vector<bool> kept(whole.grains.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    {
      Vector<dim> from_base = at<dim>(whole.grains.position, i) - base;
      bool within = from_base[axis] >= 0.0;
      if constexpr (dim == 3)
        {
          within = within && std::abs(from_base[1]) <= 0.5 * breadth;
          from_base[1] = 0.0;
        }
      kept[i] = within && from_base.norm() <= radius;
    }
  Vector<dim> corner = base - 0.5 * size;
  corner[axis] = base[axis];
  Specimen<dim> half_disc = shifted<dim>(part_of(std::move(whole), kept), -corner, size);
  half_disc.shape = BodyShape::box;

  const double a = wanted.of<NotchParameters>().ratio;
  const Bending bending{.depth = radius,
                        .span = 2.0 * radius * span_over_diameter,
                        .breadth = breadth,
                        .stress_over_force = 1.0 / (2.0 * radius * breadth),
                        .intensity_over_stress = shape_factor(a) * std::sqrt(std::numbers::pi * a * radius),
                        .is_valid = a >= 0.4 && a <= 0.6};
  return bend(std::move(half_disc), bending, wanted, dynamics);
}
} // namespace

constinit const LaboratoryProtocol semicircular_bending = complete({
  .kind = {.name = "semicircular_bending",
           .title = "Bending of a notched half disc",
           .strength = "load over section, notched",
           .sign = -1.0,
           .channel = {&CurveSample::axial_stress, "load over section", "deflection over radius"},
           .has_notch = true,
           .strength_decimals = 2},
  .strain_rate = rate_of<BendingParameters>,
  .own_entries = {bending_entries, notch_entries},
  .forecast = {PeakForecast::With::tension, 1.3},
  .takes_cylinders = true,
  .set_ups = {set_up_semicircular_bending<2>, set_up_semicircular_bending<3>},
  .body_sizes = {half_disc_size<2>, half_disc_size<3>},
});
} // namespace feldspar
