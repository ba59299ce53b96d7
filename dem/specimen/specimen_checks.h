#pragma once

#include "dem/specimen/specimen.h"

namespace feldspar
{
/// Checks a specimen beyond types, for a file whose bytes may come from anywhere. Throws InputError, which says what is wrong.
template <int dim>
void check_specimen(const Specimen<dim>& specimen);
} // namespace feldspar
