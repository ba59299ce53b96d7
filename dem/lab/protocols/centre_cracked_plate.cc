#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/notch.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_part.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace feldspar
{
namespace
{
/// Length between the grips over the width. The grips hold the width of the plate, which changes K by 1.5 % at most
/// from this length on, in the solid of tests/verification/cracked_plate_test.cc.
constexpr double least_length_over_width = 1.2;

/// K_I / (σ √(πa)) of a crack of the length 2 a in the middle of a plate of the width W, by 2 a / W: Feddersen's root of the
/// secant as Tada (1973) corrected it, within 0.1 % for every length (Tada, Paris, Irwin).
double shape_factor_of_plate(const double ratio)
{
  const double square = ratio * ratio;
  return (1.0 - 0.025 * square + 0.06 * square * square) / std::sqrt(std::cos(0.5 * std::numbers::pi * ratio));
}

template <int dim>
SetUpTest<dim> set_up_centre_cracked_plate(Specimen<dim> specimen, const double confining_pressure,
                                           const TestParameters& wanted, const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  // Length of the plate is the longer side of the specimen.
  Specimen<dim> plate = specimen.size[0] > specimen.size[axis] ? quarter_turned(specimen) : std::move(specimen);
  const double width = plate.size[0];
  const double ratio = wanted.of<NotchParameters>().ratio;
  const double a = 0.5 * ratio * width;
  const Vector<2> middle(0.5 * width, 0.5 * plate.size[axis]);
  cut_notch(plate, {middle[0] - a, middle[1]}, {middle[0] + a, middle[1]}, wanted);

  const double area = plate.volume() / plate.size[axis];
  const double length = free_length(plate, wanted);
  SetUpTest<dim> test = pull(std::move(plate), confining_pressure, wanted, dynamics);
  test.loading.notch = {.intensity_over_stress = shape_factor_of_plate(ratio) * std::sqrt(std::numbers::pi * a),
                        .work_over_stress = area * length,
                        .ligament_area = area * (1.0 - ratio),
                        .ligament_length = 0.5 * width * (1.0 - ratio),
                        .is_valid = length >= least_length_over_width * width};
  return test;
}
} // namespace

constinit const LaboratoryProtocol centre_cracked_plate = complete({
  .kind = {.name = "centre_cracked_plate",
           .title = "Tension of a centre-cracked plate",
           .strength = "tensile strength, cracked",
           .sign = 1.0,
           .has_notch = true,
           .strength_decimals = 2},
  .strain_rate = rate_of<TensionParameters>,
  .own_entries = {tension_entries, notch_entries},
  .forecast = {PeakForecast::With::tension, 0.6},
  .set_ups = {set_up_centre_cracked_plate<2>, set_up_centre_cracked_plate<3>},
});
} // namespace feldspar
