#pragma once

#include "laboratory/loading_stages.h"
#include "tests/unit/whole_tests.h"

#include <vector>

namespace feldspar::tests
{
inline TestParameters following(const std::vector<LoadingStage>& stages)
{
  TestParameters wanted;
  wanted.of<LoadingTable>().stages = stages;
  return wanted;
}

template <int dim>
TestRecord run_stages(const Specimen<dim>& specimen, const TestParameters& wanted)
{
  return outcome_of<dim>({own_loading}, specimen, wanted).record;
}

/// The first two thousandths axially, then by the gauge.
inline TestParameters led_by_lateral_strain(const double to, const double confinement)
{
  return following({{.axial_strain = 2e-3, .confining_pressure = confinement},
                    {.lateral_strain = -to, .confining_pressure = confinement, .strain_rate = 0.25}});
}
} // namespace feldspar::tests
