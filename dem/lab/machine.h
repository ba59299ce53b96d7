#pragma once

#include "dem/lab/platens.h"
#include "laboratory/compression.h"

#include <optional>

namespace feldspar
{
/// The machine that presses a body between two platens: rigid, with a spring behind the platens, or one that raises its
/// force; docs/theory.md §4.13. Both platens move alike.
struct Machine
{
  WallPair platens;
  double height;                     ///< between them when nothing has moved [m]
  double middle;                     ///< the same of the place half-way between them [m]
  double strain_rate;                ///< of the crosshead over the height [1/s]
  double strain_rate_at_start;       ///< with which the specimen is set off [1/s]
  std::optional<double> stiffness;   ///< of the spring [N/m]
  std::optional<double> stress_rate; ///< of load control [Pa/s]

  /// Returns whether the platens go with time, whatever the specimen does.
  bool is_rigid() const { return !stiffness && !stress_rate; }
};

/// The machine between the platens of a test, whose loading it tells of its rates and, if it is not rigid, of its strain.
template <int dim>
Machine machine_of(SetUpTest<dim>& test, const WallPair& platens, const CompressionParameters& wanted);

/// Sets off platens and grains in a steady, uniform shortening.
template <int dim>
void start(Dynamics<dim>& dynamics, const Machine& machine);

/// Moves the platens of a machine that is not rigid, for one step; under the pressure [Pa] that stood at the start, on
/// the present area of the ends [m²].
template <int dim>
void press(Dynamics<dim>& dynamics, const Machine& machine, double pressure, double area, const SinceStart& since);
} // namespace feldspar
