#include "dem/lab/protocols/notch.h"

#include "base/input_error.h"
#include "dem/flaws/apply.h"

#include <fmt/format.h>

namespace feldspar
{
template <int dim>
void cut_notch(Specimen<dim>& body, const Vector<2>& from, const Vector<2>& to, const TestParameters& wanted)
{
  try
    {
      put_in_flaws<dim>(body, {Slot{from, to, 0.0}});
    }
  catch (const InputError& error)
    {
      throw InputError(
        fmt::format("Tests/Notch ratio = {}: the notch cannot be cut: {}", wanted.notch_ratio, error.what()));
    }
}

template void cut_notch<2>(Specimen<2>&, const Vector<2>&, const Vector<2>&, const TestParameters&);
template void cut_notch<3>(Specimen<3>&, const Vector<2>&, const Vector<2>&, const TestParameters&);
} // namespace feldspar
