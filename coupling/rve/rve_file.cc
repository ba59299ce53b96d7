#include "coupling/rve/rve_file.h"

#include "base/parameter_id.h"
#include "base/quoted.h"
#include "base/system/hdf5_archive.h"
#include "coupling/rve/parameters.h"
#include "coupling/rve/state_archive.h"
#include "dem/specimen/specimen_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
constexpr const char* group_of_state = "state";
constexpr const char* key_of_boundary = "boundary"; // in words
} // namespace

template <int dim>
bool fits(const NetworkState<dim>& state, const Network<dim>& network)
{
  std::size_t n_segments = network.n_segments();
  for (const Link<dim>& link : network.links())
    n_segments = std::max(n_segments, std::size_t(link.first_segment) + link.n_segments);
  const auto is_finite = [](const auto& values) {
    return std::ranges::all_of(values, [](const double value) { return std::isfinite(value); });
  };
  const auto is_of_network = [&](const UnbondedSegment<dim>& unbonded) {
    return unbonded.segment < n_segments && is_finite(unbonded.shear_stress);
  };
  const auto is_unbonded = [&](const std::uint32_t segment) {
    return std::ranges::any_of(state.unbonded, [&](const auto& unbonded) { return unbonded.segment == segment; });
  };
  const auto is_softened = [&](const SoftenedSegment<dim>& softened) {
    const auto& [damage, by_shear, dissipated] = softened.more;
    return network.softening_opening() && softened.segment < network.n_segments() && is_finite(softened.shear_stress) &&
           is_finite(softened.more) && damage > 0.0 && damage < 1.0 && by_shear >= 0.0 && by_shear <= 1.0 &&
           dissipated >= 0.0 && !is_unbonded(softened.segment);
  };
  return (state.motions.empty() || state.motions.size() == n_motions<dim> * network.n_grains()) &&
         (state.intact || !state.motions.empty()) && state.stress.allFinite() && state.strain.allFinite() &&
         state.strain.cwiseAbs().maxCoeff() <= largest_strain && std::ranges::all_of(state.unbonded, is_of_network) &&
         std::ranges::all_of(state.softened, is_softened) &&
         std::ranges::adjacent_find(state.softened, std::greater_equal<>(), &SoftenedSegment<dim>::segment) ==
           state.softened.end() &&
         (state.contact_shear.empty() || state.contact_shear.size() == network.n_segments()) &&
         std::ranges::all_of(state.contact_shear, is_finite) &&
         std::ranges::is_sorted(state.unbonded, {}, &UnbondedSegment<dim>::segment);
}

template <int dim>
void write_rve(const Specimen<dim>& specimen, const Boundary& boundary, const NetworkState<dim>& state,
               const std::filesystem::path& file)
{
  write_specimen<dim>(specimen, file, {}, [&](Hdf5Writer& root) {
    auto group = root.subgroup(group_of_state);
    NetworkState<dim> copy = state; // one description serves writing and reading, and reading changes
    transfer(group, copy);
    std::string words = name(boundary);
    group.text(key_of_boundary, words);
  });
}

template <int dim>
std::optional<NetworkState<dim>> read_rve_state(const std::filesystem::path& file, const Network<dim>& network)
{
  std::optional<NetworkState<dim>> state;
  const std::string expected = fmt::format("an RVE of {}, or a specimen.h5", in_words(Work::rve_out_of_sample));
  read_foreign_hdf5(file, expected, [&](Hdf5Reader& root) {
    if (!root.has(group_of_state))
      return;
    auto group = root.subgroup(group_of_state);
    std::string boundary = name(Boundary{}); // the only one of earlier versions
    if (group.has_attribute(key_of_boundary))
      group.text(key_of_boundary, boundary);
    if (boundary != name(network.boundary()))
      throw InputError("its state is that of an RVE whose boundary is {}, and {} is {}", in_quotes(boundary),
                       in_words(parameter_id<&Boundary::kind>()), name(network.boundary()));
    transfer(group, state.emplace());
    if (!fits(*state, network))
      throw InputError("its state is not that of its specimen");
  });
  return state;
}

template bool fits<2>(const NetworkState<2>&, const Network<2>&);
template bool fits<3>(const NetworkState<3>&, const Network<3>&);
template void write_rve<2>(const Specimen<2>&, const Boundary&, const NetworkState<2>&, const std::filesystem::path&);
template void write_rve<3>(const Specimen<3>&, const Boundary&, const NetworkState<3>&, const std::filesystem::path&);
template std::optional<NetworkState<2>> read_rve_state<2>(const std::filesystem::path&, const Network<2>&);
template std::optional<NetworkState<3>> read_rve_state<3>(const std::filesystem::path&, const Network<3>&);
} // namespace feldspar
