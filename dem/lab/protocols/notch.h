#pragma once

#include "dem/lab/parameters.h"
#include "dem/specimen/specimen.h"

namespace feldspar
{
/// Saws the notch of a test, of no width, into its body. Throws InputError, which names the entry, where it cannot be cut.
template <int dim>
void cut_notch(Specimen<dim>& body, const Vector<2>& from, const Vector<2>& to, const TestParameters& wanted);
} // namespace feldspar
