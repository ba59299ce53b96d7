#pragma once

#include "report/pictures/curves/same_tests.h"
#include "report/pictures/gnuplot.h"

#include <optional>
#include <string>

namespace feldspar
{
/// The course of a test beside its stress: numbers of cracks, energies of one of the series, and the rate of cracks with the
/// energy they released, as acoustic emission is shown. Arguments as of stress_picture().
std::optional<Picture> crack_count_picture(const SameTests& same, const std::string& name, const std::string& of_tests);
std::optional<Picture> energy_picture(const SameTests& same, const std::string& name, const std::string& of_tests);
std::optional<Picture> crack_rate_picture(const SameTests& same, const std::string& name, const std::string& of_tests);
} // namespace feldspar
