#pragma once

#include "app/input/input.h"
#include "app/programme/specimen_source.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Free memory of the machine, or what is left of the limit of the control group [bytes]; none where that is not told.
std::optional<double> free_memory();

/// The number of threads of this run that the processors serve at a time. The threads share the processors evenly with
/// the programs that ran on the machine at the beginning of the run, when this is first called.
double n_threads_served();

/// A clause on the load of the machine, where a forecast depends on it: the free memory, if the run needs more than
/// half of it, and the processors, if other programs use more than half of them. It begins with a semicolon; else it is
/// empty.
std::string load_in_words(double bytes);

/// The memory that a grain of a specimen takes.
double bytes_of_grain(int dimension);

/// The expected cost of the genesis of one specimen. All values are 0 for one that is read from a specimen file.
struct GenesisEffort
{
  double n_grains = 0.0;
  double n_steps = 0.0; ///< of the packing
  double bytes = 0.0;   ///< of memory
  double seconds = 0.0; ///< of one core
};

GenesisEffort expected_effort(const SpecimenParameters& specimen);

/// The effort of all of them in a sentence; empty where nothing is made.
std::string describe_effort(const RunPlan& plan, const std::vector<SpecimenOrder>& orders);

/// Refuses specimens that would not fit into the memory that is free now: throws InputError, before any work.
void check_memory(const RunPlan& plan, const std::vector<SpecimenOrder>& orders);
} // namespace feldspar
