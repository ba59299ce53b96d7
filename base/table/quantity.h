#pragma once

#include "base/text.h"

#include <string>
#include <string_view>
#include <vector>

/// Numbers and quantities as the user writes them: `0.5`, `22 MPa`, `5, 10, 20 MPa`. The decimal sign is a point in
/// every locale. A text that is not of this form throws InputError, whose text says what was found and shows the right
/// form.
namespace feldspar
{
/// The kind of a quantity.
struct Dimension
{
  std::string_view name; ///< with its article, for error texts
  std::string_view si_unit;
  std::string_view example;
};

inline constexpr Dimension stress{"a stress", "Pa", "22 MPa"};
inline constexpr Dimension length{"a length", "m", "0.62 mm"};
inline constexpr Dimension angle{"an angle", "rad", "10 deg"};
inline constexpr Dimension density{"a density", "kg/m^3", "2700 kg/m^3"};
inline constexpr Dimension plane_stiffness{"a stress per displacement", "Pa/m", "50 GPa/mm"};
inline constexpr Dimension rate{"a rate", "1/s", "0.5 1/s"};
inline constexpr Dimension duration{"a time", "s", "2 ms"};
inline constexpr Dimension strain{"a strain", "1", "0.1 %"};
inline constexpr Dimension force{"a force", "N", "200 kN"};
inline constexpr Dimension spring_stiffness{"a force per displacement", "N/m", "500 kN/mm"};
inline constexpr Dimension acceleration{"an acceleration", "m/s^2", "0, -9.81 m/s^2"};
inline constexpr Dimension stress_rate{"a stress rate", "Pa/s", "0.7 MPa/s"};
inline constexpr Dimension force_rate{"a force rate", "N/s", "0.5 kN/s"};
inline constexpr Dimension velocity{"a velocity", "m/s", "0.1 mm/min"};
inline constexpr Dimension energy{"an energy", "J", "2 aJ"};
inline constexpr Dimension amplitude{"an amplitude", "dB", "45 dB"};

/// Returns a number in SI, 0 in place of one below 1e-30. Throws InputError for one above 1e30. No rock, body or test has
/// such sizes, which vanish or overflow in products.
double with_usual_exponent(double value);

/// One number, one space and one unit expression; returned in SI.
double parse_quantity(std::string_view text, const Dimension& dimension);

/// Numbers, and ranges of them such as 10..60 step 10, separated by commas, with one unit at the end; returned in SI.
std::vector<double> parse_quantities(std::string_view text, const Dimension& dimension);

/// The values that a range such as `10..60 MPa step 10` stands for, each with its unit: from the first by whole steps to the
/// last. A text that does not begin with a number and two dots is a value by itself. Throws InputError.
std::vector<std::string> values_of_range(std::string_view text);

/// A unit as it stands in the header of a table, in SI; strains may have none of it ("-"), or µε, mm/mm or 1e-6, energies of
/// acoustic emission "eu", which is taken as it is. Throws InputError.
double unit_in_si(std::string_view unit, const Dimension& dimension);

/// A value given in `unit`, in SI.
double to_si(double value, std::string_view unit, const Dimension& dimension);

/// An SI value as `22 MPa`, such that reading it gives the value again to 15 digits.
std::string format_quantity(double value_in_si, std::string_view unit, const Dimension& dimension);

/// A number as `0.5`, to 15 digits.
std::string format_number(double value);
} // namespace feldspar
