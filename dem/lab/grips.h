#pragma once

#include "dem/lab/laboratory_run.h"

namespace feldspar
{
/// Between the grips [m].
template <int dim>
double free_length(const Specimen<dim>& specimen, const TestParameters& wanted)
{
  const double height = specimen.size[dim - 1];
  return height - 2.0 * (wanted.grip_ratio * height);
}

/// Pulls a body along the last axis: its ends are held as rigid grips, each of which moves outwards at half the strain rate
/// of tension times the free length; docs/theory.md §4.2. Throws InputError where no grain lies in a grip.
template <int dim>
SetUpTest<dim> pull(const Specimen<dim>& body, const TestParameters& wanted, const DynamicsParameters& dynamics);
} // namespace feldspar
