#pragma once

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/storage/joints.h"

namespace feldspar
{
/// Puts neighbouring joints that a sweep computes segment by segment together in storage, where this spares more than a
/// thirty-second of all packs: a pack is computed so as soon as one of its joints needs it. The memory is that of the last
/// sweep. Returns whether it did: joints have other places then. The order follows from numbers and states of the joints.
template <int dim>
bool regroup(Joints<dim>& joints, const SweepMemory<dim>& memory);
} // namespace feldspar
