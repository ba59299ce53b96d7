#pragma once

#include "app/input/input.h"
#include "app/programme/specimen_source.h"
#include "dem/specimen/specimen.h"
#include "runs/laboratory.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace feldspar
{
/// The expected cost of tests of specimens, besides the specimens. Times are right within a factor of two or three,
/// memory within a third.
struct TestEffort
{
  std::size_t n_tests = 0;
  double n_steps = 0.0; ///< of the longest
  double n_steps_of_all = 0.0;
  double bytes = 0.0; ///< of memory: of those that run at the same time, and of the records of all
  double processor_seconds = 0.0;
};

/// `tests`: of these variants on these specimens, by their numbers.
template <int dim>
TestEffort expected_effort(const std::vector<LaboratoryOrder>& tests, const std::vector<Variant>& variants,
                           std::span<const Specimen<dim>> specimens);

/// Describes the effort in a sentence, with the pictures, the memory of the specimens and of the program itself.
template <int dim>
std::string describe_effort(const std::vector<LaboratoryOrder>& tests, const std::vector<Variant>& variants,
                            std::span<const Specimen<dim>> specimens);

/// Describes the effort of tests that all processes make together.
template <int dim>
std::string describe_shared_effort(const std::vector<LaboratoryOrder>& tests, const std::vector<Variant>& variants,
                                   std::span<const Specimen<dim>> specimens);

/// Refuses tests that would not fit into the memory that is free before their specimens are made: throws InputError, before any
/// work.
void check_memory_of_tests(const RunPlan& plan);
} // namespace feldspar
