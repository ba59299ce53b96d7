#include "dem/lab/protocols/bending.h"
#include "dem/lab/protocols/notch.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_part.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
constexpr double span_over_depth = 4.0;   // for which the formula holds
constexpr double length_over_depth = 4.4; // a tenth of the depth or more beyond each roller

/// K_I √W / (P S / (B W)) of a single edge notch in three-point bending, S = 4 W, within 0.5 % for every depth of the
/// notch (Srawley 1976, in ASTM E399).
double intensity(const double a)
{
  return 3.0 * std::sqrt(a) * (1.99 - a * (1.0 - a) * (2.15 - 3.93 * a + 2.7 * a * a)) /
         (2.0 * (1.0 + 2.0 * a) * std::pow(1.0 - a, 1.5));
}

/// Size of the beam, which is as long as the longer side of the specimen.
template <int dim>
Vector<dim> beam_size(const Specimen<dim>& specimen, const TestParameters& /*wanted*/)
{
  constexpr int axis = dim - 1;
  Vector<dim> size = specimen.size;
  size[0] = std::max(specimen.size[0], specimen.size[axis]);
  size[axis] = std::min({specimen.size[0], specimen.size[axis], size[0] / length_over_depth});
  return size;
}

template <int dim>
SetUpTest<dim> set_up_three_point_bending(Specimen<dim> specimen, double /*confining_pressure*/,
                                          const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  const Vector<dim> size = beam_size(specimen, wanted);
  Specimen<dim> beam = specimen.size[0] >= specimen.size[axis] ? std::move(specimen) : quarter_turned(specimen);
  const double depth = size[axis];
  const double base = 0.5 * (beam.size[axis] - depth);
  std::vector<bool> kept(beam.grains.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    kept[i] = beam.grains.position[axis][i] >= base && beam.grains.position[axis][i] <= base + depth;
  beam = part_of(std::move(beam), kept);
  beam = shifted<dim>(std::move(beam), -base * Vector<dim>::Unit(axis), size);

  const double breadth = dim == 2 ? beam.thickness : beam.size[1];
  const double span = span_over_depth * depth;
  const double a = wanted.of<NotchParameters>().ratio;
  // σ = 3 P S / (2 B W²), at the lower side of a beam without a notch.
  const Bending bending{.depth = depth,
                        .span = span,
                        .breadth = breadth,
                        .stress_over_force = 3.0 * span / (2.0 * breadth * depth * depth),
                        .intensity_over_stress = 2.0 / 3.0 * std::sqrt(depth) * intensity(a)};
  return bend(std::move(beam), bending, wanted, dynamics);
}
} // namespace

constinit const LaboratoryProtocol three_point_bending = complete({
  .kind = {.name = "three_point_bending",
           .title = "Three-point bending of a notched beam",
           .strength = "bending strength, notched",
           .sign = -1.0,
           .channel = {&CurveSample::axial_stress, "bending stress", "deflection over depth"},
           .has_notch = true,
           .strength_decimals = 2},
  .strain_rate = rate_of<BendingParameters>,
  .own_entries = {bending_entries, notch_entries},
  .forecast = {PeakForecast::With::tension, 4.0},
  .set_ups = {set_up_three_point_bending<2>, set_up_three_point_bending<3>},
  .body_sizes = {beam_size<2>, beam_size<3>},
});
} // namespace feldspar
