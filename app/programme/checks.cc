#include "app/programme/checks.h"

#include "app/input/parameter_table.h"
#include "app/input/strain_path.h"
#include "app/programme/reference_body.h"
#include "base/input_error.h"
#include "coupling/rve/rve_file.h"
#include "coupling/sample/continua/continua.h"
#include "coupling/sample/ranks.h"
#include "coupling/sample/sample_parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/laws/joint_laws.h"
#include "results/folder/reference.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <utility>

namespace feldspar
{
namespace
{
[[noreturn]] void refuse(const std::string& what) { throw InputError(what); }

Body body_of(const SpecimenParameters& specimen)
{
  if (specimen.dimension == 2)
    return Body::plane_box;
  return specimen.shape == "cylinder" ? Body::cylinder : Body::box;
}

/// A reference file that does not serve is told by its own name.
void check_reference(const Input& input)
{
  if (!input.reference_file.empty())
    read_reference(input.reference_file, test_kinds());
}

/// Representative volumes find equilibria event by event, which not every joint law allows.
void check_equilibria(const SpecimenParameters& specimen, const std::string_view remedy)
{
  if (!JointLaws::has_equilibria(specimen.joint_law))
    refuse(fmt::format("Specimen/Joint law = {}: its faces have no response yet from one equilibrium to the next; {}",
                       specimen.joint_law, remedy));
}

/// Of representative volumes.
void check_boundary(const Input& input)
{
  if (input.specimen.dimension == 2 && input.boundary.free_axis == 2)
    refuse("Representative volume/Free axis = z: in two dimensions it is x or y");
}

/// A cell has no such groups; to be told before its shape, which is another for them.
void check_no_groups(const Input& input)
{
  for (const auto& [section, entry] : {std::pair("Clumps", "Diameter"), std::pair("Mineral grains", "Mean size")})
    if (const std::string value = find_parameter(section, entry)->write(input); value != none)
      refuse(
        fmt::format("{}/{} = {}: a representative volume takes none; set {} = none", section, entry, value, entry));
}

/// All of a sample but its mesh.
void check_sample(const Input& input)
{
  const bool has_grains = input.sample.has_grains();
  const SampleGeometry geometry = input.sample.geometry;
  if (const unsigned int needed = dimension_of_rves(geometry); has_grains && input.specimen.dimension != needed)
    refuse(fmt::format("Specimen/Dimension = {}: {}; set Dimension = {}", input.specimen.dimension,
                       needed == 2 ? "the RVEs of a plane sample are of discs (those of plane strain of spheres)"
                                   : "the RVEs of such a Sample/Geometry are of spheres",
                       needed));
  if (has_grains)
    {
      check_no_groups(input);
      check_equilibria(input.specimen, "take another law");
    }
  check_boundary(input);
  if (has_grains && input.specimen.specimen_file.empty() && input.specimen.shape != "periodic")
    refuse(fmt::format("Specimen/Shape = {}: the RVE at a point needs Shape = periodic", input.specimen.shape));
  if (has_grains && !input.specimen.specimen_file.empty() && input.sample.n_realisations > 1)
    refuse("Sample/Realisations: a Specimen file is one realisation; set Realisations = 1");
  if (!input.variants.entries.empty())
    refuse("Variants/Entry: a multiscale run has no variants; write an input for each");
  for (const TestKind& kind : input.test_list)
    if (const std::string objection = objection_to_finite_elements(kind); !objection.empty())
      refuse(objection);
  reference_body(input);
  check_body(input, Body::sample);
  if (!has_grains && input.sample.weak_seed != WeakSeed::none)
    refuse("Sample/Weak seed: weakens the bonds between grains; it needs Material = grains");
  const bool any_ends_by_its_peak = std::any_of(input.test_list.begin(), input.test_list.end(),
                                                [](const TestKind& kind) { return !kind.follows_stages; });
  if (!has_grains && !continuum_of(input.sample.material).softens && !input.tests.stop_strain && any_ends_by_its_peak)
    refuse(
      fmt::format("Tests/Stop strain = none: {} does not soften, so a test would not end; give the strain at which "
                  "it is to stop",
                  input.sample.material));
  if (input.sample.widened_past_peak && !input.tests.stop_strain && !input.tests.stop_stress_over_peak)
    refuse(
      "Sample/Control past the peak = lateral strain: the axial strain may go back, so that no multiple of that at "
      "the peak ends the test; give Tests/Stop stress over peak, or Stop strain");
  if (input.continuum.dilation_angle > input.continuum.friction_angle)
    refuse("Continuum/Dilation angle: must be at most Continuum/Friction angle");
  if (!has_grains && geometry != SampleGeometry::plane && input.continuum.poissons_ratio >= 0.5)
    refuse("Continuum/Poisson ratio: must be below 0.5 in space");
  if (input.sample.reduced_quadrature && input.sample.order != 2)
    refuse("Sample/Quadrature = reduced: needs Order = 2; elements of order 1 would deform without strain");
  // Before the mesh is made, which would take all memory.
  constexpr double most_cells = 1e6;
  const double n_across = input.sample.elements_across;
  if (const double n =
        (geometry == SampleGeometry::cylinder ? n_across * n_across : n_across) * input.sample.elements_along;
      input.sample.mesh_file.empty() && n > most_cells)
    refuse(fmt::format("Sample/Elements across = {}, Elements along = {}: some {:.0e} cells; more than {:.0e} are not "
                       "meshed",
                       input.sample.elements_across, input.sample.elements_along, n, most_cells));
}

/// The size of a sample that can be run by so many processes.
SampleSize checked_size(const Input& input)
{
  const SampleSize size = measure(input.sample);
  if (const std::uint64_t most = size.n_cells; ranks::number() > most)
    refuse(fmt::format("{} processes for a sample of {} cells: each needs one; start at most {}, and give them more "
                       "threads",
                       ranks::number(), most, most));
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

void with_name_of(const std::filesystem::path& input_file, const std::function<void()>& check)
{
  try
    {
      check();
    }
  catch (const InputError& error)
    {
      throw InputError(fmt::format("{}: {}", input_file.string(), error.what()));
    }
}

void check_on_body(const Input& input, const Body body)
{
  for (const TestKind& kind : input.test_list)
    if (const std::string objection = objection_to_grains(kind, body); !objection.empty())
      refuse(objection);
  check_body(input, body);
}

void check_specimen_and_tests(const Input& input)
{
  const SpecimenParameters& specimen = input.specimen;
  if (specimen.shape == "periodic")
    refuse("Specimen/Shape = periodic: a laboratory test needs a specimen between walls; set Shape = box, or use "
           "feldspar rve");
  if (specimen.specimen_file.empty()) // else it brings its own shape
    check_on_body(input, body_of(specimen));
  const auto& intermediate_stress = input.tests.intermediate_stress;
  for (const double confinement : input.confinements)
    if (any_takes_confining_pressure(input.test_list) && intermediate_stress && *intermediate_stress < confinement)
      refuse(fmt::format("Tests/Intermediate stress = {:g} MPa: must be at least the least stress, and Confinements "
                         "has {:g} MPa",
                         *intermediate_stress / 1e6, confinement / 1e6));
}

template <int dim>
void check_specimen_of_file(const Input& input, const Specimen<dim>& specimen)
{
  if (specimen.periodic)
    refuse("Specimen/Specimen file: is a periodic cell; a laboratory test needs a specimen between walls (feldspar rve "
           "takes a cell)");
  check_on_body(input, dim == 2 ? Body::plane_box : specimen.round ? Body::cylinder : Body::box);
}

template <int dim>
void check_cell(const Specimen<dim>& specimen, const std::string_view needed_by)
{
  if (!specimen.periodic)
    refuse(fmt::format("Specimen/Specimen file: is a specimen between walls; {} needs a periodic cell (feldspar lab "
                       "takes walls)",
                       needed_by));
}

template <int dim>
void check_intact(const Input& input, const Network<dim>& network)
{
  const std::string& file = input.specimen.specimen_file;
  if (!file.empty() && read_rve_state(file, network))
    refuse(
      fmt::format("Specimen/Specimen file = {}: is an RVE in the state it had in a sample, and a sample begins with "
                  "intact ones; feldspar rve goes on from that state",
                  file));
}

void check_rve_out_of_sample(const Input& input)
{
  const std::string& file = input.specimen.specimen_file;
  if (input.strain_path.cell_angle != 0.0)
    refuse(
      fmt::format("Strain path/Cell angle: {} is an RVE in the state it has in its sample, which is in the axes of "
                  "its cell; set Cell angle = 0 deg",
                  file));
  if (!input.flaws.all().empty())
    refuse(
      fmt::format("Flaws: {} is an RVE in the state it has in its sample, and takes none; put them into the RVE of "
                  "the sample",
                  file));
  if (input.strain_path.solver == PathSolver::explicit_dynamics)
    refuse(fmt::format("Strain path/Solver = explicit: {} is an RVE in the state it has in its sample, and explicit "
                       "dynamics begin at rest; set Solver = event by event",
                       file));
}

void check_laboratory_input(const Input& input, const std::filesystem::path& input_file)
{
  with_name_of(input_file, [&] {
    for (const Variant& variant : variants(input))
      check_specimen_and_tests(variant.input);
  });
  check_reference(input);
  with_name_of(input_file, [&] { reference_body(input); });
}

void check_rve_input(const Input& input, const std::filesystem::path& input_file)
{
  const std::vector<Variant> all_variants = variants(input);
  with_name_of(input_file, [&] {
    for (const Variant& variant : all_variants)
      {
        check_no_groups(variant.input);
        if (variant.input.specimen.shape != "periodic" && variant.input.specimen.specimen_file.empty())
          refuse(fmt::format("Specimen/Shape = {}: a representative volume needs Shape = periodic",
                             variant.input.specimen.shape));
        if (variant.input.strain_path.solver == PathSolver::event_by_event)
          check_equilibria(variant.input.specimen, "set Strain path/Solver = explicit or take another law");
        check_boundary(variant.input);
        if (variant.input.strain_path.solver == PathSolver::explicit_dynamics &&
            variant.input.boundary.kind != BoundaryKind::periodic)
          refuse(
            fmt::format("Representative volume/Boundary = {}: explicit dynamics have periodic cells only; set Strain "
                        "path/Solver = event by event",
                        name(variant.input.boundary)));
        check(variant.input.strain_path);
      }
    reference_body(input);
  });
  // A file of a path is told by its own name.
  for (const Variant& variant : all_variants)
    if (variant.input.specimen.dimension == 2)
      path_legs<2>(variant.input.strain_path);
    else
      path_legs<3>(variant.input.strain_path);
}

void check_sample_entries(const Input& input, const std::filesystem::path& input_file)
{
  check_reference(input);
  with_name_of(input_file, [&] { check_sample(input); });
}

std::vector<std::string> check_sample_input(const Input& input, const std::filesystem::path& input_file)
{
  check_sample_entries(input, input_file);
  SampleSize size{};
  with_name_of(input_file, [&] { size = checked_size(input); });
  std::vector<std::string> remarks = remarks_on_elements(input, size);
  for (std::string& remark : remarks_on_flaws(input))
    remarks.push_back(std::move(remark));
  return remarks;
}

template void check_specimen_of_file<2>(const Input&, const Specimen<2>&);
template void check_specimen_of_file<3>(const Input&, const Specimen<3>&);
template void check_intact<2>(const Input&, const Network<2>&);
template void check_intact<3>(const Input&, const Network<3>&);
template void check_cell<2>(const Specimen<2>&, std::string_view);
template void check_cell<3>(const Specimen<3>&, std::string_view);
} // namespace feldspar
