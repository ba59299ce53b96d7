#pragma once

#include "dem/dynamics/incidence.h"
#include "dem/dynamics/touches.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
/// The way of a sum over the joints of each grain: grains one after the other, of each the joints in which it is grain 2,
/// then those in which it is grain 1, each kind by the joint's number. Neighbouring grains with as many joints follow
/// each other, so that a processor foresees how long the loops are.
struct SumOrder
{
  SumOrder() = default;
  explicit SumOrder(const Incidence& joints_of);

  std::vector<std::uint32_t> grain;
  std::vector<std::uint32_t> first_as_two; ///< of each grain among the joints; [n_grains + 1]
  std::vector<std::uint32_t> first_as_one; ///< [n_grains]
  std::vector<std::uint32_t> joint;
};

/// Sets force and couple of all grains of the order to the sums over their joints and touches: in the order of the contacts
/// whatever the number of threads.
template <int dim>
void sum_forces(Specimen<dim>& body, const SumOrder& order, const Touches<dim>& touches);
} // namespace feldspar
