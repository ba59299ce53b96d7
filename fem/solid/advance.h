#pragma once

#include "fem/solid/solid.h"
#include "fem/solid/step_control.h"

#include <functional>
#include <stdexcept>
#include <string>

namespace feldspar::fem
{
/// A load that cannot be reached: the accepted state is the last that could.
struct StepFailure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Brings a solid to a load in as many steps as it takes, and tells of each that is accepted. Throws StepFailure.
template <int dim, int material_dim>
void advance(
  Solid<dim, material_dim>& solid, const Load<dim>& load, StepControl steps,
  const std::function<void(const NewtonReport&)>& accepted = [](const NewtonReport&) {})
{
  while (!steps.finished())
    {
      const NewtonReport report = solid.solve(load, (steps.next() - steps.done()) / (1.0 - steps.done()));
      if (report.converged)
        {
          solid.accept();
          steps.succeeded();
          accepted(report);
        }
      else
        {
          solid.reject();
          if (!steps.cut())
            throw StepFailure("no further than " + std::to_string(100.0 * steps.done()) +
                              " % of the way to the load: " + report.failure);
        }
    }
}
} // namespace feldspar::fem
