#pragma once

#include "results/runs/series.h"

#include <string>

/// Remarks on tests, each in a sentence or two: a result that is missing, or a condition of a strength.
namespace feldspar
{
/// Why a test has no result, or not all of it; empty if it has.
std::string shortcoming(const FinishedTest& test);

/// Why a splitting test is not valid; empty if it is, or is none.
std::string remark_on_splitting(const FinishedTest& test);

/// A warning that rigid side plates make the body too strong, where it slides on a plane through it (docs/theory.md
/// §3.1); empty where they do not. Bodies of one rock have the same flaws.
std::string remark_on_side_plates(const TestsOfRock& tests);

/// A remark that the strengths of a body with flaws are nominal stresses; empty for a body without flaws.
std::string remark_on_flaws(const TestsOfRock& tests);

/// A remark on where the strain ran away under load control; empty where no test was under it.
std::string remark_on_load_control(const TestsOfRock& tests);

/// A remark that the tests ran faster than in the laboratory; empty where none did.
std::string remark_on_rate(const TestsOfRock& tests);
} // namespace feldspar
