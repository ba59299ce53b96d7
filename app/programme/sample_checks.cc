#include "app/programme/sample_checks.h"

#include "app/input/parameter_table.h"
#include "app/programme/checks.h"
#include "app/programme/reference_body.h"
#include "base/append.h"
#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "coupling/rve/rve_file.h"
#include "coupling/sample/continua/continua.h"
#include "coupling/sample/sample_body.h"
#include "dem/lab/protocols/protocols.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace feldspar
{
namespace
{
/// All of a sample but its mesh.
void check_sample(const Input& input)
{
  const bool has_grains = input.sample.has_grains();
  const SampleGeometry geometry = input.sample.geometry;
  if (const unsigned int needed = dimension_of_rves(geometry); has_grains && input.specimen.dimension != needed)
    throw InputError("Specimen/Dimension = {}: {}; set Dimension = {}", input.specimen.dimension,
                     needed == 2 ? "the RVEs of a plane sample are of discs (those of plane strain of spheres)"
                                 : "the RVEs of such a Sample/Geometry are of spheres",
                     needed);
  if (has_grains)
    for (const Variant& rock : rocks_of_sample(input))
      {
        check_no_groups(rock.input);
        check_equilibria(rock.input.specimen, "take another law");
      }
  check_boundary(input);
  if (has_grains && input.specimen.specimen_file.empty() && input.specimen.shape != BodyShape::periodic)
    throw InputError("Specimen/Shape = {}: the RVE at a point needs Shape = periodic",
                     find_parameter("Specimen/Shape")->write(input));
  if (has_grains && !input.specimen.specimen_file.empty() && !input.sample.groups.empty())
    throw InputError("Sample/Rocks: a Specimen file is of one rock");
  if (has_grains && !input.specimen.specimen_file.empty() && input.sample.n_realisations > 1)
    throw InputError("Sample/Realisations: a Specimen file is one realisation; set Realisations = 1");
  if (!input.variants.entries.empty())
    throw InputError("Variants/Entry: a multiscale run has no variants; write an input for each");
  for (const TestKind& kind : input.test_list)
    if (const std::string objection = objection_to_finite_elements(kind); !objection.empty())
      throw InputError(objection);
  reference_body(input);
  check_body(input, Body::sample);
  if (!has_grains && input.sample.weak_seed != WeakSeed::none)
    throw InputError("Sample/Weak seed: weakens the bonds between grains; it needs Material = grains");
  const bool any_ends_by_its_peak =
    std::ranges::any_of(input.test_list, [](const TestKind& kind) { return !kind.follows_stages; });
  if (!has_grains && !continuum_of(input.sample.material).softens && !input.tests.stop_strain && any_ends_by_its_peak)
    throw InputError("Tests/Stop strain = none: {} does not soften, so a test would not end; give the strain at which "
                     "it is to stop",
                     input.sample.material);
  if (input.sample.widened_past_peak && !input.tests.stop_strain && !input.tests.stop_stress_over_peak)
    throw InputError(
      "Sample/Control past the peak = lateral strain: the axial strain may go back, so that no multiple of that at "
      "the peak ends the test; give Tests/Stop stress over peak, or Stop strain");
  if (input.continuum.dilation_angle > input.continuum.friction_angle)
    throw InputError("Continuum/Dilation angle: must be at most Continuum/Friction angle");
  if (!has_grains && geometry != SampleGeometry::plane && input.continuum.poissons_ratio >= 0.5)
    throw InputError("Continuum/Poisson ratio: must be below 0.5 in space");
  if (input.sample.mesh_file.empty() && !(input.sample.mesh_names.empty() && input.sample.groups.empty()))
    throw InputError("Sample/{} of the groups of a mesh file; give Mesh file too",
                     input.sample.groups.empty() ? "Mesh names: are" : "Rocks: is");
  if (input.sample.reduced_quadrature && input.sample.order != 2)
    throw InputError("Sample/Quadrature = reduced: needs Order = 2; elements of order 1 would deform without strain");
  // Before the mesh is made, which would take all memory.
  constexpr double most_cells = 1e6;
  const double n_across = input.sample.elements_across;
  if (const double n =
        (geometry == SampleGeometry::cylinder ? n_across * n_across : n_across) * input.sample.elements_along;
      input.sample.mesh_file.empty() && n > most_cells)
    throw InputError("Sample/Elements across = {}, Elements along = {}: some {:.0e} cells; more than {:.0e} are not "
                     "meshed",
                     input.sample.elements_across, input.sample.elements_along, n, most_cells);
}

/// The size of a sample that can be run by so many processes.
SampleSize checked_size(const Input& input)
{
  const SampleSize size = measure(input.sample);
  if (const std::uint64_t most = size.n_cells; ranks::number() > most)
    throw InputError("{} processes for a sample of {} cells: each needs one; start at most {}, and give them more "
                     "threads",
                     ranks::number(), most, most);
  return size;
}

/// Elements larger than the RVE would have to dissipate more than it holds; docs/theory.md §10.
std::vector<std::string> remarks_on_elements(const Input& input, const SampleSize& size)
{
  if (!input.sample.has_grains() || !input.specimen.specimen_file.empty())
    return {};
  const SampleParameters& sample = input.sample;
  const double width = input.specimen.width;
  const double rve_size = dimension_of_rves(sample.geometry) == 2 ? std::sqrt(width * input.specimen.height)
                                                                  : std::cbrt(width * width * input.specimen.height);
  if (size.largest_element <= rve_size * (1.0 + 1e-9))
    return {};
  const std::string larger = fmt::format("elements of {:.1f} mm are larger than the RVE of {:.1f} mm that softens for "
                                         "them",
                                         1e3 * size.largest_element, 1e3 * rve_size);
  if (!sample.mesh_file.empty())
    return {fmt::format("{}; mesh with elements of at most {:.1f} mm", larger, 1e3 * rve_size * sample.order)};
  const double across = sample.geometry == SampleGeometry::axisymmetric ? 0.5 * size.width : size.width;
  return {fmt::format("{}; take at least Elements across = {}, Elements along = {}", larger,
                      unsigned(std::ceil(across / (rve_size * sample.order))),
                      unsigned(std::ceil(size.height / (rve_size * sample.order))))};
}

std::vector<std::string> remarks_on_flaws(const Input& input)
{
  if (!input.sample.has_grains() || !input.sample.random_orientation || input.flaws.all().empty())
    return {};
  return {"Flaws: each point turns its representative volume by an angle of its own, and the flaws with it; they keep "
          "their directions by Sample/Orientation = fixed"};
}
} // namespace

template <int dim>
void check_intact(const Input& input, const Network<dim>& network)
{
  const std::string& file = input.specimen.specimen_file;
  if (!file.empty() && read_rve_state(file, network))
    throw InputError("Specimen/Specimen file = {}: is an RVE in the state it had in a sample, and a sample begins with "
                     "intact ones; feldspar rve goes on from that state",
                     file);
}

void check_sample_entries(const Input& input, const std::filesystem::path& input_file)
{
  reference_of(input);
  with_name_of(input_file, [&] { check_sample(input); });
}

std::vector<std::string> check_sample_input(const Input& input, const std::filesystem::path& input_file)
{
  check_sample_entries(input, input_file);
  SampleSize size{};
  with_name_of(input_file, [&] { size = checked_size(input); });
  std::vector<std::string> remarks = remarks_on_elements(input, size);
  append(remarks, remarks_on_flaws(input));
  append(remarks, entries_without_effect(variants(input)));
  return remarks;
}

template void check_intact<2>(const Input&, const Network<2>&);
template void check_intact<3>(const Input&, const Network<3>&);
} // namespace feldspar
