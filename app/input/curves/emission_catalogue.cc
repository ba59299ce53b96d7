#include "app/input/curves/laboratory_curve.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "base/table/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>

namespace feldspar
{
EmissionCatalogue read_emission_catalogue(const std::filesystem::path& file)
{
  constexpr double largest = 20.0; // of magnitudes: beyond, a number has another unit than the header says
  constexpr double decibels_a_magnitude = 20.0;
  CsvReader table(file);
  using Column = std::optional<std::size_t>;
  const auto find = [&](const std::initializer_list<std::string_view> names) -> Column {
    for (const std::string_view name : names)
      if (const Column column = table.find_in_si(name))
        return column;
    return std::nullopt;
  };
  const auto refusal = [&](const std::size_t line, const std::string& what) {
    return InputError("{}:{}: {}", file.string(), line, what);
  };
  const Column time = find({"time_s"}), stress = find({"deviator_stress_Pa", "axial_stress_Pa", "stress_Pa"});
  const Column magnitude = find({"magnitude"}), amplitude = find({"amplitude_dB"}), energy = find({"energy_J"});
  if (!magnitude && !amplitude && !energy)
    throw refusal(table.line_of_header(), "there is no column amplitude, energy or magnitude; the header must be as in "
                                          "\"time [s],amplitude [dB]\"");

  EmissionCatalogue catalogue{excerpt(file.filename().string()),
                              magnitude   ? "as the file has them"
                              : amplitude ? "amplitude in dB / 20"
                                          : "⅔ log10 of the energy − 2.9",
                              {}};
  const auto value = [&](const Column column) {
    return column ? table.number(*column) : std::numeric_limits<double>::quiet_NaN();
  };
  double last_time = -std::numeric_limits<double>::infinity();
  while (table.next())
    {
      RecordedEmission event{value(stress), 0.0};
      if (energy && value(energy) < 0.0)
        throw refusal(table.line_of_row(), fmt::format("energy is {}; it must not be negative", table.text(*energy)));
      event.magnitude = magnitude   ? table.number_or_nan(*magnitude)
                        : amplitude ? value(amplitude) / decibels_a_magnitude
                                    : energy_magnitude(value(energy));
      if (std::abs(event.magnitude) > largest)
        throw refusal(table.line_of_row(), fmt::format("the magnitude ({}) is {:g}; it must lie between -{:g} and {:g}",
                                                       catalogue.scale, event.magnitude, largest, largest));
      if (value(time) < last_time)
        throw refusal(table.line_of_row(), fmt::format("time is {:g} s after {:g} s; rows must be in the order of time",
                                                       value(time), last_time));
      last_time = value(time);
      catalogue.events.push_back(event);
    }
  if (catalogue.events.empty())
    throw InputError("{}: there is no row below the header", file.string());
  if (stress && std::ranges::none_of(catalogue.events, [](const RecordedEmission& one) { return one.stress > 0.0; }))
    throw InputError("{}: the stress is never above 0; it must be positive in the sense of the test", file.string());
  return catalogue;
}
} // namespace feldspar
