#pragma once

#include "coupling/network/network_state.h"
#include "dem/specimen/specimen.h"

#include <filesystem>
#include <optional>

/// A representative volume as a file: its specimen at rest, as write_specimen() has it, and the state it is in.
namespace feldspar
{
/// Returns whether this may be a state of the network.
template <int dim>
bool fits(const NetworkState<dim>& state, const Network<dim>& network);

/// `boundary`: of the network whose state it is.
template <int dim>
void write_rve(const Specimen<dim>& specimen, const Boundary& boundary, const NetworkState<dim>& state,
               const std::filesystem::path& file);

/// The state in a file that read_specimen() takes; none where it holds a specimen only. Throws InputError where it is not
/// a state of this network, or of one with another boundary.
template <int dim>
std::optional<NetworkState<dim>> read_rve_state(const std::filesystem::path& file, const Network<dim>& network);
} // namespace feldspar
