#pragma once

#include "dem/lab/laboratory_run.h"

#include <string_view>
#include <vector>

/// Walls that hold a specimen from the first step of its test on; docs/theory.md §4.
namespace feldspar
{
/// Returns whether each grain is a part of the body: it has a joint, or, in a rigid group, a member of the group has
/// one. In a body without joints all grains are parts of it. [n_grains]
template <int dim>
std::vector<bool> grains_of_body(const Specimen<dim>& specimen);

/// Throws InputError for a body that ends farther inside of its box than half of a mean radius: stresses and strains refer to
/// the box. The message names the gap at each side.
template <int dim>
void check_fills_its_box(const Specimen<dim>& specimen);

/// Throws InputError where no grains that are joined, or in contact, lead from one end of the last axis to the other.
template <int dim>
void check_leads_from_end_to_end(const Specimen<dim>& specimen);

/// Stands a wall at rest in the test; where no grain of the body is in contact with it, as much nearer as it takes.
/// Throws InputError where that is more than half of a mean radius. `name`: of the wall in this message. Returns its
/// number.
template <int dim>
std::size_t stand_wall(SetUpTest<dim>& test, Wall wall, std::string_view name);
} // namespace feldspar
