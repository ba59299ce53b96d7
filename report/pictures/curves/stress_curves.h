#pragma once

#include "report/pictures/curves/same_tests.h"
#include "report/pictures/gnuplot.h"

#include <optional>
#include <string>

namespace feldspar
{
/// Stress against axial, lateral and volumetric strain. `name` begins that of the picture, `of_tests` says in words of
/// which tests.
std::optional<Picture> stress_picture(const SameTests& same, const std::string& name, const std::string& of_tests);
} // namespace feldspar
