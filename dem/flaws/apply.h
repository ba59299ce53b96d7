#pragma once

#include "dem/flaws/shapes.h"
#include "dem/specimen/specimen.h"

#include <vector>

namespace feldspar
{
/// Puts shapes into a specimen, one after the other, and notes each among its flaws; docs/theory.md §3.1. Grains and faces
/// that are left stay as they were. Throws InputError, which names the shape by its number and kind, where it lies
/// outside, meets no grain or face, or leaves a piece that hangs on nothing. `smooth`: of smooth joints, where a flaw does
/// not say otherwise.
template <int dim>
void put_in_flaws(Specimen<dim>& specimen, const std::vector<Shape>& shapes, const SmoothJointParameters& smooth = {});

/// The reason for which one of them cannot be put into a body of this size [m], which names it; empty if there is none.
template <int dim>
std::string objection(const std::vector<Shape>& shapes, const Vector<dim>& size);
} // namespace feldspar
