#pragma once

#include "dem/dynamics.h"
#include "dem/lab_tests.h"

#include <functional>

namespace feldspar
{
/// What tells one laboratory test from another once its platens or grips are in place.
template <int dim>
struct Loading
{
  TestKind kind;
  double strain_rate;     ///< along the last axis, tension positive [1/s]
  double sampling_strain; ///< between two rows of the curve
  std::function<std::array<double, 2>(const Dynamics<dim>&)>
    end_forces; ///< of the lower and upper end, tension positive [N]
};

/// Gives the grains the velocities of a steady, uniform stretch [1/s] about the middle: set off from
/// rest, the ends would send waves through the specimen that spoil the first tenth of the curve.
template <int dim>
void start_steadily(Dynamics<dim>& dynamics, double strain_rate);

/// Drives a specimen until the stop rule and records curve and cracks.
template <int dim>
TestRecord load_until_stop(Dynamics<dim>& dynamics, const Loading<dim>& loading, const TestParameters& wanted,
                           const TestMonitor& monitor);
} // namespace feldspar
