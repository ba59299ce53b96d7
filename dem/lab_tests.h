#pragma once

#include "dem/lab_results.h"
#include "dem/parameters.h"
#include "dem/specimen.h"

#include <functional>

namespace feldspar
{
/// Shown each row of the curve as it is taken; false ends the test there.
using TestMonitor = std::function<bool(const CurveSample&)>;

/// Two frictionless platens, each at half the strain rate times the height; no side walls. docs/theory.md §4.1.
template <int dim>
TestRecord uniaxial_compression(const Specimen<dim>& specimen, const TestParameters& wanted,
                                const DynamicsParameters& dynamics, const TestMonitor& monitor);

/// Two rigid grips, each at half the strain rate times the free length between them. docs/theory.md §4.2.
template <int dim>
TestRecord direct_tension(const Specimen<dim>& specimen, const TestParameters& wanted,
                          const DynamicsParameters& dynamics, const TestMonitor& monitor);

/// The protocol that goes by this name.
template <int dim>
TestRecord run_test(TestKind kind, const Specimen<dim>& specimen, const TestParameters& wanted,
                    const DynamicsParameters& dynamics, const TestMonitor& monitor);
} // namespace feldspar
