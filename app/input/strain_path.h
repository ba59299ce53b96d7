#pragma once

#include "app/input/input.h"
#include "coupling/rve/path_run.h"

#include <vector>

namespace feldspar
{
/// Checks whether the entries go together. Throws InputError.
void check(const StrainPathParameters& path);

/// The legs of the path of `feldspar rve`, from its direction or its file. Throws InputError with file and line.
template <int dim>
std::vector<PathLeg<dim>> path_legs(const StrainPathParameters& path);
} // namespace feldspar
