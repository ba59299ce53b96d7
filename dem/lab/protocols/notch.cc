#include "dem/lab/protocols/notch.h"

#include "base/input_error.h"
#include "base/parameter_id.h"
#include "dem/flaws/apply.h"

#include <fmt/format.h>

namespace feldspar
{
std::vector<Entry<TestParameters>> notch_entries()
{
  using P = NotchParameters;
  using namespace tests_flags;
  return within_tests<P>({entry::number(
    "Notch ratio", &P::ratio, {'[', 0.05, 0.8, ']'},
    "depth of the notch of a bent body over that of the body (over the radius of a half disc, "
    "which has a toughness from 0.4 to 0.6 only); of a centre-cracked plate the whole length of its crack over its width",
    of_grains)});
}

template <int dim>
void cut_notch(Specimen<dim>& body, const Vector<2>& from, const Vector<2>& to, const TestParameters& wanted)
{
  rephrased(
    [&] {
      put_in_flaws<dim>(body, {Slot{from, to, 0.0}});
    },
    [&](const std::string& what) {
      return ParameterError(parameter_id<&NotchParameters::ratio>(),
                            fmt::format("{}", wanted.of<NotchParameters>().ratio), "the notch cannot be cut: " + what);
    });
}

template void cut_notch<2>(Specimen<2>&, const Vector<2>&, const Vector<2>&, const TestParameters&);
template void cut_notch<3>(Specimen<3>&, const Vector<2>&, const Vector<2>&, const TestParameters&);
} // namespace feldspar
