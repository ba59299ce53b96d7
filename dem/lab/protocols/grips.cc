#include "dem/lab/protocols/grips.h"

#include "base/parameter_id.h"
#include "dem/lab/platens.h"
#include "dem/specimen/fragments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace feldspar
{
std::vector<Entry<TestParameters>> tension_entries()
{
  using P = TensionParameters;
  using namespace tests_flags;
  return within_tests<P>({entry::quantity("Tension strain rate", &P::strain_rate, Measure::rate, "1/s",
                                          ranges::above_zero, "magnitude", as_basic(of_grains)),
                          entry::number("Tension sampling strain", &P::sampling_strain, range_of_sampling_strain,
                                        "axial strain between two rows of the curve", of_grains),
                          entry::number("Grip ratio", &P::grip_ratio, {'(', 0.0, 0.4, ']'},
                                        "height of each grip over that of the specimen", of_grains)});
}

template <int dim>
SetUpTest<dim> pull(Specimen<dim> body, double /*confining_pressure*/, const TestParameters& wanted,
                    const DynamicsParameters& dynamics)
{
  const auto& tension = wanted.of<TensionParameters>();
  constexpr int axis = dim - 1;
  const double height = body.size[axis];
  const double area = body.volume() / height;
  const double grip_height = tension.grip_ratio * height;
  const double grip_speed = 0.5 * tension.strain_rate * free_length(body, wanted);

  std::vector<std::uint32_t> lower_grains, upper_grains;
  for (std::uint32_t i = 0; i < body.grains.size(); ++i)
    if (body.grains.position[axis][i] < grip_height)
      lower_grains.push_back(i);
    else if (body.grains.position[axis][i] > height - grip_height)
      upper_grains.push_back(i);
  if (lower_grains.empty() || upper_grains.empty())
    throw ParameterError(parameter_id<&TensionParameters::grip_ratio>(), fmt::format("{}", tension.grip_ratio),
                         fmt::format("no grain lies in a grip of {:.3g} m; make it larger", grip_height));

  const auto piece = fragments(body);
  std::vector<bool> is_held_above(body.grains.size(), false);
  for (const std::uint32_t i : upper_grains)
    is_held_above[piece[i]] = true;
  if (std::ranges::none_of(lower_grains, [&](const std::uint32_t i) { return is_held_above[piece[i]]; }))
    throw ParameterError(parameters_id<TestKind>(),
                         "no bonds lead from one grip to the other, so that nothing is pulled: a flaw without "
                         "strength goes right through the specimen, whose tensile strength is 0; leave the test out");

  SetUpTest<dim> test{Dynamics<dim>(std::move(body), dynamics, ZeroForce::as_placed), {}};
  start_steadily(test.dynamics, tension.strain_rate);
  const Vector<dim> upwards = grip_speed * Vector<dim>::Unit(axis);
  const auto lower = test.dynamics.add_grip(std::move(lower_grains), -upwards);
  const auto upper = test.dynamics.add_grip(std::move(upper_grains), upwards);

  test.loading.strain_rate = tension.strain_rate;
  test.loading.sampling_strain = tension.sampling_strain;
  test.loading.end_stress = [=](const Dynamics<dim>& state) {
    return EndStress{state.grip_force(lower)[axis] / area, -state.grip_force(upper)[axis] / area};
  };
  return test;
}

template decltype(pull<2>) pull<2>;
template decltype(pull<3>) pull<3>;
} // namespace feldspar
