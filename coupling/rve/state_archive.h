#pragma once

#include "base/byte_archive.h"
#include "base/voigt.h"
#include "coupling/network/network_state.h"

/// The state of an RVE, described once for all archives: HDF5 files (base/system/hdf5_archive.h) and plain bytes
/// (base/byte_archive.h).
namespace feldspar
{
template <int dim, typename Archive>
void transfer(Archive& archive, NetworkState<dim>& state)
{
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      archive.value("strain_" + voigt_name<dim>(k), state.strain[k]);
      archive.value("stress_" + voigt_name<dim>(k), state.stress[k]);
    }
  transfer_flag(archive, "intact", state.intact);
  archive.array("motions", state.motions);
  archive.array("unbonded", state.unbonded);
  // Files of version 0.2.0 know flat joints alone, and for a while bonds did not soften from event to event. Plain bytes are
  // always of this version.
  const auto transfer_if_there = [&](const char* name, auto& values) {
    if constexpr (requires { archive.has(""); })
      if (!archive.has(name))
        return;
    archive.array(name, values);
  };
  transfer_if_there("contact_shear", state.contact_shear);
  transfer_if_there("softened", state.softened);
  archive.value("n_tension_breaks", state.n_tension_breaks);
  archive.value("n_shear_breaks", state.n_shear_breaks);
  archive.value("boundary_work", state.work.boundary);
  archive.value("slip_work", state.work.slip);
  archive.value("released_work", state.work.released);
  archive.value("settled_work", state.work.settled);
}
} // namespace feldspar
