#pragma once

/// Prefixes of units: 22 MPa is 22.0 * mega, in SI.
namespace feldspar
{
inline constexpr double giga = 1e9;
inline constexpr double mega = 1e6;
inline constexpr double milli = 1e-3;
} // namespace feldspar
