#include "dem/genesis/genesis.h"

#include "base/parameter_id.h"
#include "base/random.h"
#include "dem/dynamics/dynamics.h"
#include "dem/genesis/coring.h"
#include "dem/genesis/grain_sizes.h"
#include "dem/genesis/joint_installation.h"
#include "dem/genesis/packing_file.h"
#include "dem/genesis/static_packing.h"
#include "dem/specimen/neighbours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <variant>

namespace feldspar
{
namespace
{
constexpr double stress_tolerance = 0.01;      // of the packing stress
constexpr double equilibrium_tolerance = 1e-3; // mean unbalanced over mean contact force

/// Runs until the forces balance; the share of the mean contact force that does not.
template <int dim>
double relax(Dynamics<dim>& dynamics, const double tolerance, const unsigned int most_steps,
             const std::function<void()>& check)
{
  constexpr unsigned int steps_between_checks = 50;
  double ratio = 1.0;
  for (unsigned int n = 0; n < most_steps && ratio > tolerance; n += steps_between_checks)
    {
      for (unsigned int k = 0; k < steps_between_checks; ++k)
        {
          check();
          dynamics.step();
        }
      ratio = dynamics.unbalanced_force_ratio();
    }
  return ratio;
}

/// The grains of a packing; those that have left a periodic cell come in again from the other side.
template <int dim>
void place_in_box(Specimen<dim>& specimen, Grains<dim> grains)
{
  for (int c = 0; c < dim; ++c)
    for (double& x : grains.position[c])
      x -= specimen.repeats(c) ? specimen.size[c] * std::floor(x / specimen.size[c]) : 0.0;
  specimen.grains = std::move(grains);
}

/// Grains thrown in at random, let calm down without friction, then scaled until the mean stress is reached.
template <int dim>
void pack(Specimen<dim>& specimen, const SpecimenParameters& wanted, const std::function<void()>& check,
          const std::function<void()>& check_within)
{
  const auto radii =
    draw_radii<dim>(wanted, (1.0 - wanted.porosity) * specimen.volume(), specimen.thickness, specimen.seed);
  if (radii.size() < 2)
    throw ParameterError(parameters_id<SpecimenParameters>(),
                         fmt::format("{} grain(s) fill a {} of {} m × {} m; make it larger or the grains smaller",
                                     radii.size(), specimen.is_round() ? "cylinder" : "box", wanted.width,
                                     wanted.height));
  Random random(specimen.seed, RandomStream::positions);
  Components<dim> positions;
  for (const double radius : radii)
    {
      Vector<dim> position;
      do
        for (int c = 0; c < dim; ++c)
          {
            const double margin = specimen.repeats(c) ? 0.0 : radius;
            position[c] = random.uniform(margin, specimen.size[c] - margin);
          }
      while (specimen.is_round() && specimen.distance_from_axis(position) > 0.5 * specimen.size[0] - radius);
      for (int c = 0; c < dim; ++c)
        positions[c].push_back(position[c]);
    }

  Specimen<dim> loose = specimen;
  loose.particle_contact.friction = 0.0;
  loose.grains.place(radii, positions);
  loose.grains.set_density(wanted.bulk_density / (1.0 - wanted.porosity), loose.thickness);
  if (wanted.packed_by_descent)
    {
      pack_by_descent(loose, wanted.packing_stress_ratio * specimen.particle_contact.modulus, check, check_within);
      specimen.report = loose.report;
      place_in_box(specimen, std::move(loose.grains));
      return;
    }
  Dynamics<dim> dynamics(std::move(loose), DynamicsParameters{}, ZeroForce::at_touch);
  dynamics.set_check(check_within);
  for (int axis = specimen.is_round() ? dim - 1 : 0; axis < dim; ++axis)
    if (!specimen.repeats(axis))
      {
        dynamics.add_wall({axis, 1.0, 0.0, 0.0});
        dynamics.add_wall({axis, -1.0, dynamics.specimen().size[axis], 0.0});
      }
  if (specimen.is_round())
    dynamics.add_wall(round_wall(specimen));

  // The first overlaps are as large as grains; released, they would throw grains about: follow the forces step by step
  // without gathering speed.
  constexpr unsigned int n_creeps = 300;
  for (unsigned int k = 0; k < n_creeps; ++k)
    {
      check();
      dynamics.step();
      dynamics.specimen().grains.stop();
      dynamics.restart();
    }

  const double modulus = specimen.particle_contact.modulus;
  const double target = wanted.packing_stress_ratio * modulus;
  constexpr unsigned int most_scalings = 300;
  double multiplier = 1.0;
  for (unsigned int k = 0;; ++k)
    {
      const double ratio = relax(dynamics, equilibrium_tolerance, 4000, check);
      const double stress = -dynamics.mean_stress().trace() / dim;
      const double error = stress / target - 1.0;
      if (std::abs(error) <= stress_tolerance && ratio <= equilibrium_tolerance)
        {
          specimen.report.packing_stress = stress;
          break;
        }
      if (k == most_scalings)
        throw ParameterError(parameters_id<SpecimenParameters>(),
                             fmt::format("no packing at a mean stress of {:.3g} Pa within {} scalings (reached "
                                         "{:.3g} Pa); {} = static, another {}, {} or seed may do",
                                         target, most_scalings, stress,
                                         entry_in_words(parameter_id<&SpecimenParameters::packed_by_descent>()),
                                         entry_in_words(parameter_id<&SpecimenParameters::porosity>()),
                                         entry_in_words(parameter_id<&SpecimenParameters::packing_stress_ratio>())));
      if (std::abs(error) <= stress_tolerance)
        continue; // only time is missing
      // Near jamming the stress of a packing rises by about its contact modulus per unit of relative radius; one that
      // is not in contact yet grows faster.
      const double growth = stress < 0.05 * target ? std::max(5e-4, 2.0 * wanted.packing_stress_ratio)
                                                   : std::clamp((target - stress) / modulus, -5e-3, 5e-3);
      for (double& radius : dynamics.specimen().grains.radius)
        radius *= 1.0 + growth;
      dynamics.restart();
      multiplier *= 1.0 + growth;
    }
  specimen.report.radius_multiplier = multiplier;
  std::vector<std::uint32_t> own(radii.size()); // without their images
  std::iota(own.begin(), own.end(), 0u);
  place_in_box(specimen, dynamics.specimen().grains.chosen(own));
}

/// Puts grains that are near each other in space near each other in memory, and numbers the pairs of them anew.
template <int dim>
void sort_in_space(Grains<dim>& grains, std::vector<GrainPair>& pairs)
{
  const std::vector<std::uint32_t> order = spatial_order(grains);
  grains = grains.chosen(order);
  std::vector<std::uint32_t> new_number(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k)
    new_number[order[k]] = k;
  for (auto& [first, second] : pairs)
    std::tie(first, second) = std::pair(std::minmax(new_number[first], new_number[second]));
}
} // namespace

template <int dim>
void install_joints(Specimen<dim>& specimen, const JointParameters& wanted, const std::vector<GrainPair>& bonds,
                    const std::function<void()>& check)
{
  specimen.joints.law = JointLaws::make<dim>(wanted, specimen.particle_contact);
  std::visit(
    [&]<typename Law, typename Parameters>(const Law& law, const Parameters& parameters) {
      if constexpr (std::same_as<typename Law::Parameters, Parameters>)
        install_joints(specimen, law, parameters, bonds, check);
    },
    specimen.joints.law, wanted);
}

template <int dim>
Specimen<dim> make_specimen(const SpecimenParameters& wanted, const JointParameters& joint,
                            const ParticleContactParameters& particle_contact, const std::uint64_t seed,
                            const std::function<void()>& check, const std::function<void()>& check_within)
{
  Specimen<dim> specimen;
  specimen.size.setConstant(wanted.width);
  specimen.size[dim - 1] = wanted.height;
  if (wanted.is_cored()) // a cell of the body that it is put together from
    {
      specimen.size /= wanted.cells_across;
      specimen.size[dim - 1] = wanted.height / wanted.cells_along;
    }
  specimen.shape = wanted.shape_when_packed();
  specimen.bulk_density = wanted.bulk_density;
  specimen.seed = seed;
  specimen.particle_contact = particle_contact;
  std::vector<GrainPair> bonds;
  if (wanted.packing_file.empty())
    pack(specimen, wanted, check, check_within);
  else
    {
      Packing<dim> packing = read_packing<dim>(wanted, check_within);
      specimen.grains = std::move(packing.grains);
      bonds = std::move(packing.bonds);
    }
  check_within();
  sort_in_space(specimen.grains, bonds);
  const double porosity = 1.0 - specimen.grains.volume(specimen.thickness) / specimen.volume();
  specimen.grains.set_density(wanted.bulk_density / (1.0 - porosity), specimen.thickness);
  install_joints(specimen, joint, bonds, check_within);
  if (!wanted.is_cored())
    return specimen;
  std::array<unsigned int, dim> n_cells;
  n_cells.fill(wanted.cells_across);
  n_cells[dim - 1] = wanted.cells_along;
  return cored<dim>(repeated<dim>(specimen, n_cells), wanted.shape);
}

template decltype(make_specimen<2>) make_specimen<2>;
template decltype(make_specimen<3>) make_specimen<3>;
template decltype(install_joints<2>) install_joints<2>;
template decltype(install_joints<3>) install_joints<3>;
} // namespace feldspar
