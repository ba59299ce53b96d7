#include "base/parameter_id.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/platens.h"
#include "dem/lab/protocols/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/fragments.h"
#include "dem/specimen/specimen_part.h"
#include "laboratory/own_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
/// Half of the angle over which each end is loaded: discs loaded over 20° in all break from the middle, while a platen on
/// the few grains that stand out crushes those and nothing else.
constexpr double loaded_half_angle = 10.0 * std::numbers::pi / 180.0;

/// Size of the disc: as wide as the specimen, or as a core that lies on its side; in space of the length that is
/// wanted.
template <int dim>
Vector<dim> disc_size(const Specimen<dim>& specimen, const TestParameters& wanted)
{
  if constexpr (dim == 2)
    return Vector<2>::Constant(specimen.size.minCoeff());
  else
    {
      const double diameter = specimen.size[0];
      return {diameter, std::min(wanted.of<BrazilianParameters>().length_ratio * diameter, specimen.size[2]), diameter};
    }
}

/// The grains that lie within a circle as wide as the specimen about its middle (wholly, unless the circle is the
/// specimen's own side), in space from the middle of its length, with the joints between them; in the box of the disc.
template <int dim>
Specimen<dim> cut_disc(const Specimen<dim>& specimen, const Vector<dim>& size)
{
  const double diameter = size[0];
  const double length = dim == 2 ? specimen.thickness : size[1];
  const Vector<dim> corner = 0.5 * (specimen.size - size);
  std::vector<bool> kept(specimen.grains.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    {
      Vector<dim> from_middle = at<dim>(specimen.grains.position, i) - 0.5 * specimen.size;
      bool within = true;
      if constexpr (dim == 3)
        {
          within = std::abs(from_middle[1]) <= 0.5 * length;
          from_middle[1] = 0.0;
        }
      kept[i] = within && (specimen.is_round() || from_middle.norm() + specimen.grains.radius[i] <= 0.5 * diameter);
    }
  if (std::ranges::count(kept, true) < 2)
    throw ParameterError(parameter_id<&SpecimenParameters::width>(),
                         fmt::format("a Brazilian disc of {:.3g} mm holds fewer than two grains; make the "
                                     "specimen wider or the grains smaller ({})",
                                     1e3 * diameter, in_words(parameter_id<&SpecimenParameters::minimum_radius>())));

  // Porosity of the disc stays that of the specimen: the gaps at its ragged rim are none of the rock.
  return shifted<dim>(part_of(specimen, kept), -corner, size);
}

/// Specimen as it lies between the platens: a core on its side, a plane box with its longer side upright. Where a wall
/// touches the rim of the disc few grains lie wholly within it, and there the disc is to be loaded.
template <int dim>
Specimen<dim> placed(const Specimen<dim>& specimen)
{
  return dim == 2 && specimen.size[0] > specimen.size[1] ? quarter_turned(specimen) : laid_on_side(specimen);
}

/// The grains by which one end is held, one grain deep within the angle that is loaded: from the rim, or from the outermost
/// grain where none comes so near to the rim. Loose grains, which would be driven through the disc, are no part of it. `outwards`: 1 of the upper end, -1 of the lower.
template <int dim>
std::vector<std::uint32_t> pad(const Specimen<dim>& disc, const double mean_radius, const double outwards)
{
  constexpr int axis = dim - 1;
  const double radius = 0.5 * disc.size[0];
  const std::vector<bool> is_loose = loose_grains(disc);
  std::vector<std::pair<double, std::uint32_t>> within; // heights above the middle
  double outermost = 0.0;
  for (std::uint32_t i = 0; i < disc.grains.size(); ++i)
    {
      const Vector<dim> from_middle = at<dim>(disc.grains.position, i) - 0.5 * disc.size;
      const double height = outwards * from_middle[axis];
      if (is_loose[i] || std::abs(from_middle[0]) >= radius * std::sin(loaded_half_angle) || height <= 0.0)
        continue;
      within.emplace_back(height, i);
      outermost = std::max(outermost, height);
    }
  double inner_face = radius * std::cos(loaded_half_angle) - 2.0 * mean_radius;
  if (outermost <= inner_face)
    inner_face = outermost - mean_radius;
  std::vector<std::uint32_t> grains;
  for (const auto& [height, i] : within)
    if (height > inner_face)
      grains.push_back(i);
  if (grains.empty())
    throw ParameterError(parameter_id<&SpecimenParameters::width>(),
                         fmt::format("the Brazilian disc of {:.3g} mm, {:.0f} mean grain diameters, has no "
                                     "grain where it is loaded; make the specimen wider or the grains smaller "
                                     "({})",
                                     1e3 * disc.size[0], disc.report.resolution,
                                     in_words(parameter_id<&SpecimenParameters::minimum_radius>())));
  return grains;
}

template <int dim>
SetUpTest<dim> set_up_brazilian(Specimen<dim> specimen, double /*confining_pressure*/, const TestParameters& wanted,
                                const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  const auto& own = wanted.of<BrazilianParameters>();
  const double mean_radius = specimen.report.mean_radius;
  const Vector<dim> size = disc_size(specimen, wanted);
  Specimen<dim> disc = cut_disc<dim>(placed(std::exchange(specimen, {})), size);
  const double diameter = disc.size[0];
  const double length = dim == 2 ? disc.thickness : disc.size[1];
  // A pad of grains at either end is held as by a stiff cushion and moved as one.
  std::vector<std::uint32_t> lower_pad = pad(disc, mean_radius, -1.0);
  std::vector<std::uint32_t> upper_pad = pad(disc, mean_radius, 1.0);

  SetUpTest<dim> test{Dynamics<dim>(std::move(disc), dynamics, ZeroForce::as_placed), {}};
  start_steadily(test.dynamics, -own.strain_rate);
  const Vector<dim> upwards = 0.5 * own.strain_rate * diameter * Vector<dim>::Unit(axis);
  const auto lower = test.dynamics.add_grip(std::move(lower_pad), upwards);
  const auto upper = test.dynamics.add_grip(std::move(upper_pad), -upwards);

  test.loading.strain_rate = -own.strain_rate;
  test.loading.sampling_strain = own.sampling_strain;
  // σ_t = 2P/(πDt), the tension across the loaded diameter of an elastic disc.
  const double load_to_stress = 2.0 / (std::numbers::pi * diameter * length);
  test.loading.end_stress = [=](const Dynamics<dim>& state) {
    return EndStress{load_to_stress * state.grip_force(lower)[axis], -load_to_stress * state.grip_force(upper)[axis]};
  };
  return test;
}
std::vector<Entry<TestParameters>> brazilian_entries()
{
  using P = BrazilianParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::quantity("Brazilian strain rate", &P::strain_rate, Measure::rate, "1/s", ranges::above_zero,
                     "of the loaded diameter; magnitude", as_basic(of_grains)),
     entry::number("Brazilian sampling strain", &P::sampling_strain, range_of_sampling_strain,
                   "strain of the diameter between two rows of the curve", of_grains),
     entry::number(
       "Brazilian length ratio", &P::length_ratio, ranges::above_zero,
       "length of the disc, or half disc, that is cut from a cylinder over its diameter, in three dimensions",
       tests_flags::in_space)});
}

} // namespace

constinit const LaboratoryProtocol brazilian = complete({
  .kind = {.name = "brazilian",
           .title = "Brazilian test",
           .strength = "Brazilian tensile strength",
           .sign = -1.0,
           .channel = {&CurveSample::axial_stress, "splitting stress 2P/(πDt)", "shortening over diameter"},
           .peak_rule = PeakRule::first_before_a_fall,
           .envelope_role = EnvelopeRole::indirect_tension,
           .strength_decimals = 2},
  .strain_rate = rate_of<BrazilianParameters>,
  .own_entries = {brazilian_entries},
  .forecast = {PeakForecast::With::tension, 4.0},
  .takes_cylinders = true,
  .set_ups = {set_up_brazilian<2>, set_up_brazilian<3>},
  .body_sizes = {disc_size<2>, disc_size<3>},
});
} // namespace feldspar
