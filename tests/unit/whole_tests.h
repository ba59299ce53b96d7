#pragma once

#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

/// Laboratory tests from their first row to their end.
namespace feldspar::tests
{
template <int dim>
TestOutcome outcome_of(const LaboratoryCase& test_case, const Specimen<dim>& specimen, const TestParameters& wanted)
{
  LabTest<dim> test(test_case, specimen, wanted, {});
  while (test.advance())
    ;
  return test.finish(false);
}

/// The same where the energies balance all the way. A force that jumps within a step and a contact that closes in it leave
/// errors of the order of the step.
template <int dim>
TestOutcome balanced_outcome_of(const LaboratoryCase& test_case, const Specimen<dim>& specimen,
                                const TestParameters& wanted)
{
  LabTest<dim> test(test_case, specimen, wanted, {});
  double largest_work = 0.0;
  while (test.advance())
    {
      const Energies& energies = test.curve().back().energies;
      largest_work = std::max(largest_work, energies.boundary_work);
      EXPECT_LT(std::abs(energies.unaccounted()), 0.005 * largest_work) << test.curve().back().axial_strain;
    }
  return test.finish(false);
}

/// The largest stress of a test, in the sign of its kind.
inline double highest_stress(const TestRecord& record)
{
  double highest = 0.0;
  for (const CurveSample& row : record.curve)
    highest = std::max(highest, record.kind.stress(row));
  return highest;
}
} // namespace feldspar::tests
