#pragma once

#include "runs/laboratory.h"

#include <filesystem>
#include <vector>

/// Laboratory tests whose body all processes compute together.
namespace feldspar
{
/// Leads each test, one after another, by all processes together to its end, or to where the observer of one of them wants the
/// end, and leaves its last two checkpoints in `folder`/checkpoints, from which run_tests() takes it up. All processes have the
/// specimens; a test that cannot be made or shared is left to run_tests(). Collective.
template <int dim>
void run_shared_tests(const std::vector<LaboratoryOrder>& orders, std::vector<Specimen<dim>>& specimens,
                      const std::filesystem::path& folder, RunObserver& observer);
} // namespace feldspar
