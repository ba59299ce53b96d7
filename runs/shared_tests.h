#pragma once

#include "runs/laboratory.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

/// Laboratory tests whose body all processes compute together.
namespace feldspar
{
/// Leads each test, one after another, by all processes together to its end, or to where the observer of one of them wants the
/// end, and leaves its last two checkpoints in `folder`/checkpoints, from which run_tests() takes it up. `specimen` gives the
/// specimen of a number, in one process of a machine at a time; each process keeps its own part of it. A test that cannot be made
/// is left to run_tests(), which tells why. Returns how many were made. Throws Interrupted, and OutputError. Collective.
template <int dim>
std::size_t run_shared_tests(const std::vector<LaboratoryOrder>& orders,
                             const std::function<Specimen<dim>(std::size_t)>& specimen,
                             const std::filesystem::path& folder, RunObserver& observer);
} // namespace feldspar
