#include "app/programme/checks.h"

#include "app/input/parameter_table.h"
#include "app/input/strain_path.h"
#include "app/programme/reference_body.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/surroundings.h"
#include "dem/laws/joint_laws.h"
#include "laboratory/compression.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace feldspar
{
namespace
{
bool lists(const Input& input, const TestKind& kind) { return contains(input.test_list, kind); }

/// Refuses loads that do not fit the body, the tests or each other.
void check_loads(const Input& input, const Body body)
{
  const TestParameters& tests = input.tests;
  const std::size_t dimension = body == Body::plane_box ? 2 : 3;
  if (!tests.gravity.empty() && tests.gravity.size() != dimension)
    throw InputError("Tests/Gravity = {}: must have {} components, one for each axis of the body",
                     find_parameter("Tests/Gravity")->write(input), dimension);
  const auto& own = tests.of<CompressionParameters>();
  if (lists(input, own_loading.kind) && (own.loading_rate || own.machine_stiffness))
    throw InputError("Tests/{}: own_loading follows its table at the rates there; take it out, or own_loading off "
                     "Tests/List",
                     own.loading_rate ? "Compression loading rate" : "Machine stiffness");
  if (own.machine_stiffness && own.loading_rate && own.loading_rate->of != LoadingRate::Of::travel)
    throw InputError("Tests/Compression loading rate = {}: a machine that raises its force has no stiffness; give the "
                     "rate in mm/min, or set Machine stiffness = none",
                     own.loading_rate->text);
}

/// A sentence on an entry of section Tests that is set and is of none of the tests; empty for any other.
std::string entry_without_effect(const Input& input, const Parameter& parameter)
{
  if (parameter.section != "Tests" || parameter.write(input) == parameter.default_text())
    return "";
  std::vector<TestKind> takers = kinds_that_take(parameter.entry);
  if (parameter.entry == "Confinements")
    std::ranges::copy_if(test_kinds(), std::back_inserter(takers), &TestKind::takes_confining_pressure);
  if (takers.empty() || std::ranges::any_of(takers, [&](const TestKind& kind) { return lists(input, kind); }))
    return "";
  return fmt::format("{} has no effect: it is of {}, and Tests/List has {}", parameter.name(), names(takers),
                     names(input.test_list));
}
} // namespace

void with_name_of(const std::filesystem::path& input_file, const std::function<void()>& check)
{
  rephrased(check, [&](const std::string& what) { return InputError("{}: {}", input_file.string(), what); });
}

std::string refusal_of(const std::function<void()>& work)
{
  try
    {
      work();
      return "";
    }
  catch (const InputError& error)
    {
      return error.what();
    }
}

std::optional<Reference> reference_of(const Input& input)
{
  return input.reference_file.empty() ? std::nullopt
                                      : std::optional(read_reference(input.reference_file, test_kinds()));
}

void check_equilibria(const SpecimenParameters& specimen, const std::string_view remedy)
{
  if (!JointLaws::has_equilibria(specimen.joint_law))
    throw InputError("Specimen/Joint law = {}: its faces have no response yet from one equilibrium to the next; {}",
                     specimen.joint_law, remedy);
}

void check_boundary(const Input& input)
{
  if (input.specimen.dimension == 2 && input.boundary.free_axis == 2)
    throw InputError("Representative volume/Free axis = z: in two dimensions it is x or y");
}

void check_no_groups(const Input& input)
{
  for (const char* const name : {"Clumps/Diameter", "Mineral grains/Mean size"})
    if (const Parameter& group = *find_parameter(name); group.write(input) != none)
      throw InputError("{} = {}: a representative volume takes none; set {} = none", name, group.write(input),
                       group.entry);
  if (input.minerals.form_of_rock() != MineralGrainForm::breakable)
    throw InputError("Minerals/Grains = {}: a representative volume takes breakable ones; set Grains = breakable",
                     find_parameter("Minerals/Grains")->write(input));
}

std::vector<std::string> entries_without_effect(const std::vector<Variant>& variants)
{
  return sentences_on(variants, entry_without_effect);
}

void check_on_body(const Input& input, const Body body)
{
  for (const TestKind& kind : input.test_list)
    if (const std::string objection = objection_to_grains(kind, body); !objection.empty())
      throw InputError(objection);
  check_body(input, body);
  check_loads(input, body);
}

void check_specimen_and_tests(const Input& input)
{
  const SpecimenParameters& specimen = input.specimen;
  if (specimen.shape == BodyShape::periodic)
    throw InputError(
      "Specimen/Shape = periodic: a laboratory test needs a specimen between walls; set Shape = box, or use "
      "feldspar rve");
  if (specimen.specimen_file.empty()) // else it brings its own shape
    {
      check_on_body(input, body_of(specimen.dimension, specimen.shape));
      if (lists(input, tilt.kind))
        check_tilt(input.tests, specimen.width, specimen.height);
    }
  const auto& intermediate_stress = input.tests.of<ConfinementParameters>().intermediate_stress;
  for (const double confinement : input.confinements)
    if (any_takes_confining_pressure(input.test_list) && intermediate_stress && *intermediate_stress < confinement)
      throw InputError("Tests/Intermediate stress = {:g} MPa: must be at least the least stress, and Confinements "
                       "has {:g} MPa",
                       *intermediate_stress / 1e6, confinement / 1e6);
}

void check_specimen_of_file(const Input& input, const BodyShape shape)
{
  if (is_periodic(shape))
    throw InputError(
      "Specimen/Specimen file: is a periodic cell; a laboratory test needs a specimen between walls (feldspar rve "
      "takes a cell)");
  check_on_body(input, body_of(input.specimen.dimension, shape));
}

void check_cell(const BodyShape shape, const std::string_view needed_by)
{
  if (!is_periodic(shape))
    throw InputError("Specimen/Specimen file: is a specimen between walls; {} needs a periodic cell (feldspar lab "
                     "takes walls)",
                     needed_by);
}

void check_rve_out_of_sample(const Input& input)
{
  const std::string& file = input.specimen.specimen_file;
  if (input.strain_path.cell_angle != 0.0)
    throw InputError("Strain path/Cell angle: {} is an RVE in the state it has in its sample, which is in the axes of "
                     "its cell; set Cell angle = 0 deg",
                     file);
  if (!input.flaws.all().empty())
    throw InputError("Flaws: {} is an RVE in the state it has in its sample, and takes none; put them into the RVE of "
                     "the sample",
                     file);
  if (input.strain_path.solver == PathSolver::explicit_dynamics)
    throw InputError("Strain path/Solver = explicit: {} is an RVE in the state it has in its sample, and explicit "
                     "dynamics begin at rest; set Solver = event by event",
                     file);
}

void check_laboratory_input(const Input& input, const std::filesystem::path& input_file)
{
  with_name_of(input_file, [&] {
    for (const Variant& variant : variants(input))
      check_specimen_and_tests(variant.input);
  });
  reference_of(input);
  with_name_of(input_file, [&] { reference_body(input); });
}

void check_rve_input(const Input& input, const std::filesystem::path& input_file)
{
  const std::vector<Variant> all_variants = variants(input);
  with_name_of(input_file, [&] {
    for (const Variant& variant : all_variants)
      {
        check_no_groups(variant.input);
        if (variant.input.specimen.shape != BodyShape::periodic && variant.input.specimen.specimen_file.empty())
          throw InputError("Specimen/Shape = {}: a representative volume needs Shape = periodic",
                           find_parameter("Specimen/Shape")->write(variant.input));
        if (variant.input.strain_path.solver == PathSolver::event_by_event)
          check_equilibria(variant.input.specimen, "set Strain path/Solver = explicit or take another law");
        check_boundary(variant.input);
        if (variant.input.strain_path.solver == PathSolver::explicit_dynamics &&
            variant.input.boundary.kind != BoundaryKind::periodic)
          throw InputError(
            "Representative volume/Boundary = {}: explicit dynamics have periodic cells only; set Strain "
            "path/Solver = event by event",
            name(variant.input.boundary));
        check(variant.input.strain_path);
      }
    reference_body(input);
  });
  // A file of a path is reported by its own name.
  for (const Variant& variant : all_variants)
    if (variant.input.specimen.dimension == 2)
      path_legs<2>(variant.input.strain_path);
    else
      path_legs<3>(variant.input.strain_path);
}
} // namespace feldspar
