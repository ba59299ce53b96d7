#include "dem/lab/surroundings.h"

#include "dem/lab/membrane.h"
#include "dem/lab/seating.h"

#include <numbers>

namespace feldspar
{
std::vector<Entry<TestParameters>> confinement_entries()
{
  using P = ConfinementParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::choice("Lateral boundary", &P::lateral_boundary,
                   {{"wall", LateralBoundary::wall}, {"membrane", LateralBoundary::membrane}},
                   "in triaxial compression: rigid walls held at the pressure, or the pressure itself on the outer "
                   "grains, so that the sides may bend",
                   of_grains),
     entry::optional_quantity(
       "Intermediate stress", &P::intermediate_stress, Measure::stress, "MPa", ranges::above_zero,
       "on the second pair of sides of a box in three dimensions (true triaxial compression); none: "
       "the confinement",
       of_box)});
}

template <int dim>
Surroundings<dim> surround(SetUpTest<dim>& test, const WallPair& ends, const double confining_pressure,
                           const TestParameters& wanted)
{
  using State = const Dynamics<dim>&;
  const auto& confinement = wanted.of<ConfinementParameters>();
  const Specimen<dim>& specimen = test.dynamics.specimen();
  const Vector<dim> size = specimen.size;
  const double thickness = specimen.thickness;
  Surroundings<dim> around;
  const auto other_stress = confinement.intermediate_stress.value_or(confining_pressure);
  if (other_stress != confining_pressure)
    around.intermediate_stress = other_stress;
  if (confinement.lateral_boundary == LateralBoundary::membrane)
    {
      const auto surface = [=, counts = grains_of_body(specimen)](State state) {
        return lateral_surface(state.specimen(), counts, state.walls()[ends.low].position,
                               state.walls()[ends.high].position);
      };
      around.end_area = [=](State state) { return surface(state).cross_section; };
      around.press_membrane = [=](Dynamics<dim>& state, const double share) {
        state.know_all_motions();
        auto forces = surface(state).inward_area;
        for (int axis = 0; axis < dim - 1; ++axis)
          for (double& force : forces[axis])
            force *= share * (axis == 0 ? confining_pressure : other_stress);
        state.apply_forces(forces);
      };
      return around;
    }
  if constexpr (dim == 3)
    if (specimen.is_round())
      {
        const std::size_t wall = stand_wall(test, round_wall(specimen), "side wall");
        const auto radius = [=](State state) { return state.walls()[wall].position; };
        around.sides = {{{wall},
                         [=](State state) { return 2.0 * std::numbers::pi * radius(state) * distance(state, ends); },
                         confining_pressure}};
        around.end_area = [=](State state) { return std::numbers::pi * radius(state) * radius(state); };
        return around;
      }

  std::vector<WallPair> pairs; // across every axis but the last
  for (int axis = 0; axis < dim - 1; ++axis)
    {
      const std::size_t low = stand_wall<dim>(test, {axis, 1.0, 0.0}, "side wall");
      pairs.push_back({low, stand_wall<dim>(test, {axis, -1.0, size[axis]}, "side wall")});
    }
  for (int axis = 0; axis < dim - 1; ++axis)
    {
      const WallPair pair = pairs[std::size_t(axis)];
      const auto area = [=](State state) {
        return distance(state, ends) * (dim == 2 ? thickness : distance(state, pairs[std::size_t(dim - 2 - axis)]));
      };
      around.sides.push_back({{pair.low, pair.high}, area, axis == 0 ? confining_pressure : other_stress});
    }
  around.end_area = [=](State state) {
    return distance(state, pairs[0]) * (dim == 2 ? thickness : distance(state, pairs.back()));
  };
  return around;
}

template Surroundings<2> surround<2>(SetUpTest<2>&, const WallPair&, double, const TestParameters&);
template Surroundings<3> surround<3>(SetUpTest<3>&, const WallPair&, double, const TestParameters&);
} // namespace feldspar
