#pragma once

#include "base/input_error.h"
#include "base/page_allocator.h"
#include "dem/storage/exact_sum.h"

#include <cstddef>
#include <vector>

namespace feldspar
{
/// Energies of a body that are sums over its contacts and grains [J].
struct EnergySums
{
  ExactSum kinetic, strain, slip, released, damping;

  void add(const EnergySums& other)
  {
    kinetic.add(other.kinetic);
    strain.add(other.strain);
    slip.add(other.slip);
    released.add(other.released);
    damping.add(other.damping);
  }
};

/// The energies that only a running sum can give: works, and whatever left the body with a contact that is no more [J].
/// Grains and contacts themselves know their present energy; Dynamics::energies() puts both together.
struct EnergyLedger
{
  explicit EnergyLedger(const std::size_t n_grains)
    : damping_work(n_grains, 0.0)
  {
  }

  double boundary_work = 0.0;       ///< by walls, grips, the cell and forces from outside
  double released = 0.0;            ///< by breaking bonds
  ExactSum slip_of_lost_contacts;   ///< dissipated by contacts that have gone; of a shared body those of this process
  double strain_at_start = 0.0;     ///< stored where the test began
  double kinetic_at_start = 0.0;    ///< of the motion that the grains were set off with
  LargeVector<double> damping_work; ///< dissipated at each grain

  template <typename Archive>
  void transfer(Archive& archive)
  {
    archive.array("damping_work", damping_work);
    archive.value("boundary_work", boundary_work);
    archive.value("released_energy", released);
    archive.value("strain_energy_at_start", strain_at_start);
    archive.value("kinetic_energy_at_start", kinetic_at_start);
    std::vector lost{slip_of_lost_contacts};
    archive.array("slip_energy_of_lost_contacts", lost);
    if (lost.size() != 1)
      throw InputError("the energy of lost contacts has another layout");
    slip_of_lost_contacts = lost.front();
  }
};
} // namespace feldspar
