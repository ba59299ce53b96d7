#pragma once

#include "results/runs/run.h"

namespace feldspar
{
/// The value of a quantity in a test. A test that could not be made has none but its loading: numbers in a record of it were
/// not measured.
Figure value_of(const TestQuantity& quantity, const FinishedTest& test);

/// Puts back what value_of() gave.
void set_value(const TestQuantity& quantity, FinishedTest& test, const Figure& figure);
} // namespace feldspar
