#include "base/input_error.h"
#include "dem/lab/laboratory_test.h"
#include "dem/lab/platens.h"
#include "dem/lab/protocols/protocols.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace feldspar
{
namespace
{
/// Half of the angle over which each end is loaded: discs loaded over 20° in all break from the middle, while a platen on
/// the few grains that stand out crushes those and nothing else.
constexpr double loaded_half_angle = 10.0 * std::numbers::pi / 180.0;

/// In space a disc lies across the axis of the specimen it comes from: turns the specimen, so that the last axis runs
/// across it and the second along it.
template <int dim>
Specimen<dim> laid_down(Specimen<dim> specimen)
{
  if constexpr (dim == 3)
    {
      // (x, y, z) -> (x, z, W - y), a quarter turn about x.
      const double width = specimen.size[1];
      const auto turn = [](auto& components) {
        for (std::size_t i = 0; i < components[1].size(); ++i)
          components[2][i] = -std::exchange(components[1][i], components[2][i]);
      };
      turn(specimen.grains.position);
      for (double& z : specimen.grains.position[2])
        z += width;
      turn(specimen.joints.normal);
      turn(specimen.joints.tangent);
      std::swap(specimen.size[1], specimen.size[2]);
    }
  return specimen;
}

/// The grains that lie within a circle as wide as the specimen about its middle (wholly, unless the circle is the
/// specimen's own side), in space from the middle of its length, with the joints between them; in the box of the disc.
template <int dim>
Specimen<dim> cut_disc(const Specimen<dim>& specimen, const double diameter, const double length)
{
  Vector<dim> size = Vector<dim>::Constant(diameter);
  if constexpr (dim == 3)
    size[1] = length;
  const Vector<dim> corner = 0.5 * (specimen.size - size);
  const auto& grains = specimen.grains;
  constexpr auto outside = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> new_number(grains.size(), outside);
  std::vector<double> radii;
  Components<dim> positions;
  std::vector<double> masses, inertias;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      Vector<dim> from_middle = at<dim>(grains.position, i) - 0.5 * specimen.size;
      if constexpr (dim == 3)
        {
          if (std::abs(from_middle[1]) > 0.5 * length)
            continue;
          from_middle[1] = 0.0;
        }
      if (!specimen.round && from_middle.norm() + grains.radius[i] > 0.5 * diameter)
        continue;
      new_number[i] = std::uint32_t(radii.size());
      radii.push_back(grains.radius[i]);
      masses.push_back(grains.mass[i]);
      inertias.push_back(grains.moment_of_inertia[i]);
      for (int c = 0; c < dim; ++c)
        positions[c].push_back(grains.position[c][i] - corner[c]);
    }
  if (radii.size() < 2)
    throw InputError(fmt::format("Specimen/Width: a Brazilian disc of {:.3g} mm holds fewer than two grains; make the "
                                 "specimen wider or the grains smaller (Specimen/Minimum radius)",
                                 1e3 * diameter));

  Specimen<dim> disc = specimen;
  disc.size = size;
  disc.grains.place(radii, positions);
  disc.grains.mass = masses;
  disc.grains.moment_of_inertia = inertias;
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    if (new_number[specimen.joints.grain_1[j]] != outside && new_number[specimen.joints.grain_2[j]] != outside)
      kept.push_back(j);
  disc.joints.keep(kept);
  for (auto* ends : {&disc.joints.grain_1, &disc.joints.grain_2})
    for (auto& grain : *ends)
      grain = new_number[grain];
  disc.report.n_grains = disc.grains.size();
  disc.report.n_joints = disc.joints.size();
  disc.report.mean_radius = disc.grains.mean_radius();
  disc.report.resolution = diameter / (2.0 * disc.report.mean_radius);
  disc.report.porosity =
    1.0 - disc.grains.volume(disc.thickness) / (0.25 * std::numbers::pi * diameter * diameter * length);
  disc.report.coordination_number = 2.0 * double(disc.joints.size()) / double(disc.grains.size());
  return disc;
}

template <int dim>
SetUpTest<dim> set_up(const Specimen<dim>& specimen, double /*confining_pressure*/, const TestParameters& wanted,
                      const DynamicsParameters& dynamics)
{
  constexpr int axis = dim - 1;
  const Specimen<dim> lying = laid_down(specimen);
  const double diameter = dim == 2 ? lying.size.minCoeff() : lying.size[0];
  const double length = dim == 2 ? lying.thickness : std::min(wanted.brazilian_length_ratio * diameter, lying.size[1]);
  const Specimen<dim> disc = cut_disc(lying, diameter, length);
  // A pad of grains at either end, one grain deep, is held as by a stiff cushion and moved as one.
  const double half_width = 0.5 * diameter * std::sin(loaded_half_angle);
  const double inner_face = 0.5 * diameter * std::cos(loaded_half_angle) - 2.0 * specimen.report.mean_radius;
  std::vector<std::uint32_t> lower_pad, upper_pad;
  for (std::uint32_t i = 0; i < disc.grains.size(); ++i)
    {
      const Vector<dim> from_middle = at<dim>(disc.grains.position, i) - 0.5 * disc.size;
      if (std::abs(from_middle[0]) < half_width && std::abs(from_middle[axis]) > inner_face)
        (from_middle[axis] < 0.0 ? lower_pad : upper_pad).push_back(i);
    }
  if (lower_pad.empty() || upper_pad.empty())
    throw InputError(fmt::format(
      "Specimen/Width: the Brazilian disc of {:.3g} mm, {:.0f} mean grain diameters, has no grain where it is "
      "loaded; make the specimen wider, the grains smaller (Specimen/Minimum radius), or take another seed",
      1e3 * diameter, disc.report.resolution));

  SetUpTest<dim> test{Dynamics<dim>(disc, dynamics, ZeroForce::as_placed), {}};
  start_steadily(test.dynamics, -wanted.brazilian_strain_rate);
  const Vector<dim> upwards = 0.5 * wanted.brazilian_strain_rate * diameter * Vector<dim>::Unit(axis);
  const auto lower = test.dynamics.add_grip(std::move(lower_pad), upwards);
  const auto upper = test.dynamics.add_grip(std::move(upper_pad), -upwards);

  test.loading.strain_rate = -wanted.brazilian_strain_rate;
  test.loading.sampling_strain = wanted.brazilian_sampling_strain;
  // σ_t = 2P/(πDt), the tension across the loaded diameter of an elastic disc.
  const double load_to_stress = 2.0 / (std::numbers::pi * diameter * length);
  test.loading.end_stress = [=](const Dynamics<dim>& state) {
    return EndStress{load_to_stress * state.grip_force(lower)[axis], -load_to_stress * state.grip_force(upper)[axis]};
  };
  return test;
}
} // namespace

constinit const LaboratoryProtocol brazilian = complete({
  .kind = {.name = "brazilian",
           .title = "Brazilian test",
           .strength = "Brazilian tensile strength",
           .sign = -1.0,
           .peak_rule = PeakRule::first_before_a_fall,
           .envelope_role = EnvelopeRole::indirect_tension,
           .strength_decimals = 2},
  .set_up_2d = set_up<2>,
  .set_up_3d = set_up<3>,
});
} // namespace feldspar
