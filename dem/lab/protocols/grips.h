#pragma once

#include "dem/lab/laboratory_run.h"
#include "laboratory/own_entries.h"

#include <vector>

namespace feldspar
{
/// The pull of two grips.
struct TensionParameters
{
  double strain_rate = 0.164;    ///< [1/s]
  double sampling_strain = 1e-6; ///< between two rows of the curve
  double grip_ratio = 0.1;       ///< height of each grip over the specimen's
};

/// The entries of TensionParameters.
std::vector<Entry<TestParameters>> tension_entries();

/// Length between the grips [m].
template <int dim>
double free_length(const Specimen<dim>& specimen, const TestParameters& wanted)
{
  const double height = specimen.size[dim - 1];
  return height - 2.0 * (wanted.of<TensionParameters>().grip_ratio * height);
}

/// Set-up that pulls a body along the last axis: its ends are held as rigid grips, each of which moves outwards at half the
/// strain rate of tension times the free length; docs/theory.md §4.2. Throws InputError where no grain lies in a grip.
template <int dim>
SetUpTest<dim> pull(Specimen<dim> body, double confining_pressure, const TestParameters& wanted,
                    const DynamicsParameters& dynamics);
} // namespace feldspar
