#include "dem/lab_tests.h"

#include <stdexcept>

namespace feldspar
{
template <int dim>
TestRecord run_test(const TestKind kind, const Specimen<dim>& specimen, const TestParameters& wanted,
                    const DynamicsParameters& dynamics, const TestMonitor& monitor)
{
  switch (kind)
    {
    case TestKind::direct_tension:
      return direct_tension(specimen, wanted, dynamics, monitor);
    case TestKind::uniaxial_compression:
      return uniaxial_compression(specimen, wanted, dynamics, monitor);
    }
  throw std::logic_error("a test kind without a protocol");
}

template TestRecord run_test<2>(TestKind, const Specimen<2>&, const TestParameters&, const DynamicsParameters&,
                                const TestMonitor&);
} // namespace feldspar
