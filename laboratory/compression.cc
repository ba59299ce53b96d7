#include "laboratory/compression.h"

#include "base/input_error.h"
#include "base/table/quantity.h"

#include <string_view>
#include <utility>

namespace feldspar
{
namespace
{
std::optional<LoadingRate> read_loading_rate(const std::string_view text)
{
  if (text == "none")
    return std::nullopt;
  for (const auto& [of, dimension] :
       {std::pair(LoadingRate::Of::stress, &stress_rate), std::pair(LoadingRate::Of::force, &force_rate),
        std::pair(LoadingRate::Of::travel, &velocity)})
    try
      {
        if (const double value = parse_quantity(text, *dimension); value > 0.0)
          return LoadingRate{of, value, std::string(text)};
      }
    catch (const InputError&)
      {
        // of another dimension
      }
  throw InputError("must be none, or a rate > 0 of stress, force or travel, e.g. \"{}\", \"{}\" or \"{}\"",
                   stress_rate.example, force_rate.example, velocity.example);
}
} // namespace

std::vector<Entry<TestParameters>> compression_entries()
{
  using P = CompressionParameters;
  using namespace tests_flags;
  return within_tests<P>({entry::quantity("Compression strain rate", &P::strain_rate, Measure::rate, "1/s",
                                          ranges::above_zero, "magnitude", as_basic(of_grains)),
                          entry::number("Compression sampling strain", &P::sampling_strain, range_of_sampling_strain,
                                        "axial strain between two rows of the curve", of_grains)});
}

std::vector<Entry<TestParameters>> machine_entries()
{
  using P = CompressionParameters;
  using namespace tests_flags;
  return within_tests<P>(
    {entry::optional_quantity(
       "Machine stiffness", &P::machine_stiffness, Measure::spring, "kN/mm", ranges::above_zero,
       "of the loading frame of uniaxial and triaxial compression: a spring between the crosshead, "
       "which moves at the strain rate, and the platens; in the plane, of a specimen 1 m thick; "
       "none: rigid",
       of_grains),
     entry::text(
       "Compression loading rate", &P::loading_rate, "MPa/s, kN/s or mm/min", "none, or > 0", read_loading_rate,
       [](const std::optional<LoadingRate>& rate) { return rate ? rate->text : std::string("none"); },
       "of a laboratory, in uniaxial and triaxial compression: a stress or a force (in the plane, of a specimen 1 m "
       "thick) that the machine raises, or the travel of the platens; where it is slower than Compression strain rate "
       "(for a stress: times the modulus of the particle contacts), the test runs at that, and both are told",
       of_grains)});
}
} // namespace feldspar
