#pragma once

#include "base/page_allocator.h"
#include "dem/dynamics/incidence.h"
#include "dem/dynamics/touches.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// The way of a sum over the joints of each grain: of each the joints in which it is grain 2, then those in which it is
/// grain 1, each kind by the joint's number. A grain is summed behind the block of joints (base/parallel.h) that ends its
/// own, while the processor has their responses at hand; one whose joints different threads may sweep, after all of them.
/// Neighbouring grains with as many joints follow each other, so that a processor foresees how long the loops are.
struct SumOrder
{
  SumOrder() = default;
  SumOrder(const Incidence& joints_of, std::size_t n_joints, const GrainRange& summed);

  GrainRange summed{0, 0};                 ///< the grains that get sums
  std::size_t blocks_in_a_row = 1;         ///< of joints, that one thread sweeps
  std::vector<std::uint32_t> first_behind; ///< place of the first grain behind each block, and of those after all
  LargeVector<std::uint32_t> grain;
  LargeVector<std::uint32_t> first_as_two; ///< of each grain among the joints; [n + 1]
  LargeVector<std::uint32_t> first_as_one; ///< [n]
  LargeVector<std::uint32_t> joint;
};

/// Sets force and couple of the grains behind a block of joints to the sums over their joints.
template <int dim>
void sum_forces_behind(std::size_t block, Specimen<dim>& body, const SumOrder& order);

/// After sum_forces_behind() of every block: sets force and couple of the other grains to the sums over their joints, and adds
/// the contacts without a face to all, in the order of the contacts whatever the number of threads.
template <int dim>
void sum_remaining_forces(Specimen<dim>& body, const SumOrder& order, const Touches<dim>& touches);
} // namespace feldspar
