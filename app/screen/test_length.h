#pragma once

#include "app/input/input.h"
#include "results/kinds.h"

#include <optional>

namespace feldspar
{
/// Young's modulus of the specimen, a guess by that of its bonds [Pa].
double expected_modulus(const Input& input);

/// The strain at which a test will probably peak, from the strength and modulus of its bonds: a guess, for the time left
/// before the curve has told more. Positive in the sense of the test; none of a test whose protocol has no forecast.
std::optional<double> expected_strain_at_peak(const TestCase& test, const Input& input);

/// The strain at which a test will probably end, from that at its peak.
double expected_last_strain(double strain_at_peak, const TestParameters& tests);
} // namespace feldspar
