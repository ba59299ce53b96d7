#pragma once

#include "app/input.h"
#include "app/progress.h"
#include "dem/specimen.h"

#include <exception>
#include <string>
#include <vector>

namespace feldspar
{
/// Ctrl-C where there is nothing yet to be kept.
struct Interrupted : std::exception
{
  const char* what() const noexcept override { return "interrupted"; }
};

/// One specimen a seed, read from the input's specimen file or made, several at a time; the same whatever the number of
/// threads. Throws InputError, and Interrupted.
template <int dim>
std::vector<Specimen<dim>> provide_specimens(const Input& input, Progress& progress);

/// For a terminal: what genesis has to report.
std::string describe(const SpecimenReport& report);
} // namespace feldspar
