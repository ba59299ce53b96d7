#pragma once

#include "app/input/input.h"
#include "results/runs/bodies.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// The body of Report/Reference results; none where there is no such entry. Throws InputError where the folder has no
/// results of grains.
std::optional<BodyFigures> reference_body(const Input& input);

/// The bodies of a run beside that of its Report/Reference results, a line each, and a line more where they are different
/// rocks. Nothing without such an entry, or without grains.
std::vector<std::string> beside_reference_body(const Input& input, const std::vector<SpecimenReport>& bodies);
} // namespace feldspar
