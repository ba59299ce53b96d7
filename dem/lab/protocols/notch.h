#pragma once

#include "dem/specimen/specimen.h"
#include "laboratory/own_entries.h"

#include <vector>

namespace feldspar
{
/// The notch of a body whose toughness is measured.
struct NotchParameters
{
  double ratio = 0.4; ///< depth of the notch over that of the body; 2 a / W of a cracked plate
};

/// The entries of NotchParameters.
std::vector<Entry<TestParameters>> notch_entries();

/// Saws the notch of a test, of no width, into its body. Throws InputError, which names the entry, where it cannot be cut.
template <int dim>
void cut_notch(Specimen<dim>& body, const Vector<2>& from, const Vector<2>& to, const TestParameters& wanted);
} // namespace feldspar
