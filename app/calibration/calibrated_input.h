#pragma once

#include "app/input/input.h"
#include "calibration/unknowns.h"

#include <string>

namespace feldspar::calibration
{
/// The micro-parameters of the input's flat joint.
MicroParameters micro_parameters(const Input& input);

/// The input with other micro-parameters. Values that belong to them follow: the coefficients of variation of both
/// strengths are kept, and so are the ratios of the particle contact's modulus, stiffness ratio and friction to the
/// joint's.
Input with_parameters(const Input& input, const MicroParameters& parameters);

/// An input of `feldspar lab` in words: every section that a laboratory test reads. `comment`: what stands above it, lines
/// of any text.
std::string as_prm(const Input& input, const std::string& comment);

/// Rounds to four figures in the units of as_prm(), so that a reader sees all of them and the file gives the same rock.
MicroParameters rounded(const MicroParameters& parameters);
} // namespace feldspar::calibration
