#include "laboratory/compression.h"

namespace feldspar
{
std::vector<Entry<TestParameters>> compression_entries()
{
  using P = CompressionParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::quantity("Compression strain rate", &P::strain_rate, Measure::rate, "1/s", ranges::above_zero, "magnitude",
                     as_basic(of_grains)),
     entry::number("Compression sampling strain", &P::sampling_strain, range_of_sampling_strain,
                   "axial strain between two rows of the curve", of_grains),
     entry::optional_quantity(
       "Machine stiffness", &P::machine_stiffness, Measure::spring, "kN/mm", ranges::above_zero,
       "of the loading frame of uniaxial and triaxial compression: a spring between the crosshead, "
       "which moves at the strain rate, and the platens; in the plane, of a specimen 1 m thick; "
       "none: rigid",
       of_grains)});
}
} // namespace feldspar
