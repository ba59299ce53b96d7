#include "app/input/input.h"

#include "app/input/given_entries.h"
#include "app/input/joint_sections.h"
#include "app/input/parameter_table.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/table/quantity.h"
#include "dem/flaws/apply.h"
#include "dem/flaws/smooth_planes.h"
#include "dem/genesis/grain_sizes.h"
#include "dem/lab/surroundings.h"
#include "dem/minerals/mineral_map.h"
#include "laboratory/loading_stages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <set>
#include <system_error>

namespace feldspar
{
namespace
{
/// The defaults of space, where nothing else is given.
void settle_dimension(Input& input, const GivenEntries& values)
{
  if (input.specimen.dimension == 3)
    for (const Parameter& parameter : parameter_table())
      if (!parameter.flags.in_space.empty() && !values.has(parameter.name()))
        parameter.read(input, parameter.flags.in_space);
}

void check_demands(const Input& input, const GivenEntries& values)
{
  for (const Parameter& parameter : parameter_table())
    if (const Demand* const unmet = unmet_demand(input, parameter))
      throw values.error(parameter.name(), unmet->otherwise);
}

/// One of two entries says which pairs get a joint; a coordination number takes the place of the default gap.
void settle_installation(Input& input, const GivenEntries& values)
{
  JointLaws::for_each(input.joints, [&](const std::string_view law, auto& joint) {
    const std::string entry = section_of(law) + "/Installation gap ratio";
    if (joint.coordination_number && !values.has(entry))
      joint.installation_gap_ratio.reset();
    if (joint.installation_gap_ratio && joint.coordination_number)
      throw values.error(entry, "excludes Coordination number, which is given too; keep one of them");
    if (!joint.installation_gap_ratio && !joint.coordination_number)
      throw values.error(entry, "leaves the joints undetermined; give a gap, or Coordination number");
  });
}

void check_bonds(const Input& input, const GivenEntries& values)
{
  JointLaws::for_each(input.joints, [&](const std::string_view law, const auto& joint) {
    if (joint.gapped_fraction + joint.slit_fraction > 1.0)
      throw values.error(section_of(law) + "/Slit fraction", "must be at most 1 together with Gapped fraction = {}",
                         values.value(section_of(law) + "/Gapped fraction"));
    constexpr double largest_variation = 3.0; // a modulus of 0.4: half of the bonds have a tenth of the mean or less
    if (joint.strength_distribution == StrengthDistribution::weibull &&
        (joint.bond_tensile_strength_deviation > largest_variation * joint.bond_tensile_strength ||
         joint.bond_cohesion_deviation > largest_variation * joint.bond_cohesion))
      throw values.error(section_of(law) + "/Strength distribution",
                         "a standard deviation must be at most {:g} times its mean", largest_variation);
  });
}

/// Reason why an entry of a section that is not of use is refused.
std::string refusal_of(const std::string_view section, const std::set<std::string>& laws)
{
  if (section == "Smooth joint")
    return "has no effect: Mineral grains/Mean size is none, Minerals/Grains has no smooth boundaries and no flaw has the "
           "word smooth";
  if (section == "Clumps")
    return "has no effect: Clumps/Diameter is none";
  if (section == "Minerals")
    return "has no effect: Minerals/Table is none, or it is of a picture and Minerals/Map is none (slices: of space alone)";
  return fmt::format("is of another joint law; Specimen/Joint law is {}", fmt::join(laws, " or "));
}

/// A variant that sets an entry which has no use for it would be another one's double, or promise what it does not have.
/// It may keep the value that the input has without variants, as a row of a table has a value for each entry.
void check_uses(const Input& input, const std::vector<Variant>& all, const GivenEntries& values)
{
  for (const Variant& variant : all)
    for (const VariantSetting& setting : variant.settings)
      {
        const Parameter& parameter = *find_parameter(setting.entry);
        const std::string kept = parameter.write(input);
        if (has_use_for(variant.input, parameter) || parameter.write(variant.input) == kept)
          continue;
        const VariantParameters& wanted = input.variants;
        const std::string remedy =
          wanted.in_step ? fmt::format("give it {} in such a variant", kept)
                         : fmt::format("set Combine = in step, or give a Table, with {} in such a variant", kept);
        throw values.error(wanted.table.empty() ? "Variants/Values" : "Variants/Table", "{} = {}: {}; {}",
                           setting.entry, excerpt(setting.value),
                           refusal_of(parameter.section, {variant.input.specimen.joint_law}), remedy);
      }
}

/// An entry of a joint law that no variant has would be without effect.
void check_joint_law(const Input& input, const GivenEntries& values)
{
  const std::vector<Variant> all = variants(input);
  std::set<std::string> laws;
  for (const Variant& variant : all)
    laws.insert(variant.input.specimen.joint_law);
  const auto has_use = [&](const Parameter& parameter) {
    return std::ranges::any_of(all, [&](const Variant& variant) { return has_use_for(variant.input, parameter); });
  };
  for (const GivenEntry& given : values.all())
    if (const Parameter& parameter = *find_parameter(given.name); !has_use(parameter))
      throw values.error(given.name, refusal_of(parameter.section, laws));
  for (const std::string& entry : input.variants.entries)
    if (const Parameter& varied = *find_parameter(entry); !has_use(varied))
      throw values.error(input.variants.table.empty() ? "Variants/Entry" : "Variants/Table",
                         refusal_of(varied.section, laws));
  check_uses(input, all, values);
}

/// The entry that makes a grain-based model of the rock; empty of another rock.
std::string_view grain_based_entry(const Input& input)
{
  if (input.mineral_grains.mean_size)
    return "Mineral grains/Mean size";
  return input.minerals.form_of_rock() == MineralGrainForm::smooth_boundaries ? "Minerals/Grains" : "";
}

void check_smooth_joints(const Input& input, const GivenEntries& values)
{
  if (!has_smooth_joints(input))
    return;
  if (const std::string_view entry = grain_based_entry(input); input.specimen.shape == BodyShape::periodic)
    throw values.error(
      entry.empty() ? "Flaws/Shapes" : entry,
      "puts in smooth joints, which need Specimen/Shape = box or cylinder; it is periodic, and a representative "
      "volume takes none");
  const auto check = [&](const SmoothJointParameters& wanted, const char* entry) {
    if (const std::string what = objection(wanted); !what.empty())
      throw values.error(entry, what);
  };
  check(input.smooth_joint, "Smooth joint/Dilation angle");
  for (const Shape& shape : input.flaws.shapes)
    if (const SmoothSides* sides = smooth_sides(shape))
      check(sides->among(input.smooth_joint), "Flaws/Shapes");
}

/// Boundaries without a bond must be given by the user: the defaults of section Smooth joint are those of open flaws,
/// and a rock of such boundaries falls apart. For a bond both strengths must be given, because the other one would be
/// zero.
void check_mineral_grains(const Input& input, const GivenEntries& values)
{
  const auto is_said = [&](const std::string_view entry) {
    return values.has(entry) || contains(input.variants.entries, entry);
  };
  const std::string_view entry = grain_based_entry(input);
  if (entry.empty())
    return;
  const bool has_tensile_strength = is_said("Smooth joint/Tensile strength");
  const bool has_cohesion = is_said("Smooth joint/Cohesion");
  if (!has_tensile_strength && !has_cohesion)
    throw values.error(entry,
                       "says nothing of the bonds at the boundaries: give Smooth joint/Tensile strength and Cohesion, "
                       "or 0 MPa for open boundaries");
  if (has_tensile_strength != has_cohesion &&
      (input.smooth_joint.tensile_strength > 0.0 || input.smooth_joint.cohesion > 0.0))
    throw values.error(entry,
                       "has boundaries bonded by Smooth joint/{}, and Smooth joint/{} is missing: give it too, 0 MPa "
                       "for none",
                       has_cohesion ? "Cohesion" : "Tensile strength", has_cohesion ? "Tensile strength" : "Cohesion");
}

void check_minerals(const Input& input, const GivenEntries& values)
{
  const MineralParameters& wanted = input.minerals;
  if (wanted.minerals.empty() && input.calibration.boundary_strength)
    throw values.error("Calibration/Boundary strength", "needs minerals; set Minerals/Table");
  if (wanted.minerals.empty())
    return;
  const auto refuse = [&](const char* entry, const std::string& why) { throw values.error(entry, why); };
  for (const MineralBoundary& boundary : wanted.boundaries)
    for (const std::string& name : {boundary.one, boundary.two})
      if (!contains(wanted.minerals, name, &Mineral::name))
        refuse("Minerals/Boundaries", fmt::format("{} is not in the table of minerals", in_quotes(name)));
  if (wanted.map)
    {
      if (wanted.form == MineralGrainForm::smooth_boundaries)
        refuse(
          "Minerals/Grains",
          "smooth boundaries are planes between Voronoi cells, and the mineral grains of a Map have any shape; set "
          "Grains = breakable");
      if (std::ranges::any_of(wanted.minerals, [](const Mineral& one) { return one.share || one.size > 0.0; }))
        refuse("Minerals/Table", "has shares or sizes, which the map gives; leave these columns out, or the map");
      const double width = input.specimen.width;
      // A body out of a file has a size of its own, which is checked when the minerals are put in.
      const bool is_of_file = !input.specimen.specimen_file.empty() || !input.specimen.packing_file.empty();
      minerals_of_map(
        wanted, is_of_file ? std::array{0.0, 0.0, 0.0}
                           : std::array{width, input.specimen.dimension == 3 ? width : 0.0, input.specimen.height});
      return;
    }
  double sum = 0.0;
  for (const Mineral& one : wanted.minerals)
    {
      if (!one.share || !(*one.share > 0.0) || !(one.size > 0.0))
        refuse("Minerals/Table",
               fmt::format("{} needs a share above 0 and a size above 0, for there is no Map", one.name));
      sum += *one.share;
    }
  constexpr double round_off = 1e-6;
  if (std::abs(sum - 1.0) > round_off)
    refuse("Minerals/Table", fmt::format("the shares add up to {:.4g} %; they must be 100 % together", 100.0 * sum));
}

void check_clumps(const Input& input, const GivenEntries& values)
{
  const bool has_rigid_minerals = input.minerals.form_of_rock() == MineralGrainForm::rigid;
  if (!input.clumps.diameter && !has_rigid_minerals)
    return;
  if (has_rigid_minerals && (input.specimen.dimension != 2 || input.specimen.shape != BodyShape::box ||
                             !input.flaws.shapes.empty() || !input.flaws.traces.empty()))
    throw values.error(
      "Minerals/Grains",
      "rigid mineral grains are in the plane, in a box and without flaws: set Specimen/Dimension = 2 and "
      "Specimen/Shape = box, and leave section Flaws out");
  for (const TestKind& kind : input.test_list)
    if (const std::string objection = objection_to_clumps(kind); !objection.empty())
      throw values.error("Tests/List", objection);
}

/// Reads the table, where there is one.
void complete_variants(Input& input, const GivenEntries& values)
{
  VariantParameters& wanted = input.variants;
  const bool has_table = !wanted.table.empty();
  rephrased(
    [&] {
      if (has_table)
        read_variant_table(wanted);
      variants(input);
    },
    [&](const std::string& what) {
      if (has_table)
        return values.error("Variants/Table", what);
      const bool has_commas =
        wanted.values.size() == 1 && wanted.values[0].size() == 1 && wanted.values[0][0].find(',') != std::string::npos;
      return values.error(wanted.values.empty() ? "Variants/Entry" : "Variants/Values", "{}{}", what,
                          has_commas ? "; values are separated by semicolons" : "");
    });
}

/// Reads the table of the rocks of groups of cells, where there is one.
void complete_rocks(Input& input, const GivenEntries& values)
{
  if (input.sample.rocks_file.empty())
    return;
  rephrased(
    [&] {
      input.rocks.table = input.sample.rocks_file;
      read_variant_table(input.rocks, "group");
      rocks_of_sample(input);
      input.sample.groups = input.rocks.labels;
    },
    [&](const std::string& what) { return values.error("Sample/Rocks", what); });
}

void check_specimen(const Input& input, const GivenEntries& values)
{
  const SpecimenParameters& specimen = input.specimen;
  if (!specimen.packing_file.empty() || !specimen.specimen_file.empty())
    {
      if (!specimen.specimen_file.empty() && (input.seeds.size() > 1 || !input.variants.entries.empty()))
        throw values.error("Specimen/Specimen file", "is one specimen; it goes with one seed and no variants");
      return; // files bring their own radii
    }
  if (specimen.packing_unit != SpecimenParameters().packing_unit || !specimen.packing_shift.empty())
    throw values.error(specimen.packing_shift.empty() ? "Specimen/Packing unit" : "Specimen/Packing shift",
                       "needs a Packing file, whose grains it brings to their place");
  // This check also catches a slip of the unit before it fills the memory.
  constexpr double most_grains = 1e7;
  if (const double n_grains = expected_grains(specimen); n_grains > most_grains)
    throw values.error("Specimen/Minimum radius", "gives some {:.0e} grains; more than {:.0e} are not packed", n_grains,
                       most_grains);
  const double least = 4.0 * specimen.largest_radius();
  const std::string demand =
    fmt::format("must be at least {}, or there is no room for two grains of the largest radius",
                format_quantity(least, "mm", length));
  if (specimen.width / specimen.cells_across < least)
    throw values.error("Specimen/Width", demand);
  if (specimen.height / specimen.cells_along < least)
    throw values.error("Specimen/Height", demand);
}

/// Says how much of a joint map lies out of the specimen.
void remark_on_map(Input& input)
{
  const Vector<2> size(input.specimen.width, input.specimen.height);
  std::size_t n_outside = 0;
  std::size_t n_cut = 0;
  for (const Shape& trace : input.flaws.placed_traces())
    {
      const auto& flaw = std::get<ClosedFlaw>(trace);
      const auto parts = parts_inside(flaw, size);
      n_outside += parts.empty();
      n_cut += !parts.empty() && (parts.size() > 1 || parts.front().points != flaw.points);
    }
  if (input.specimen.specimen_file.empty() && n_outside + n_cut > 0)
    input.flaws.left_out +=
      fmt::format("{}Flaws/Traces file: of {} traces {} lie outside of the specimen, {} are cut at its sides",
                  input.flaws.left_out.empty() ? "" : "; ", input.flaws.traces.size(), n_outside, n_cut);
}

/// Checks the flaws. The size of a specimen out of a file is not known yet; putting the flaws in checks them again.
void check_flaws(const Input& input, const GivenEntries& values)
{
  for (const char* const entry :
       {"Flaws/Traces origin", "Flaws/Traces angle", "Flaws/Traces scale", "Flaws/Smooth layers"})
    if (input.flaws.traces.empty() && values.has(entry))
      throw values.error(entry, "is of a joint map; give Traces file too");
  const auto layer_of = [](const Shape& trace) { return std::get<ClosedFlaw>(trace).map_layer; };
  for (const auto& [layer, sides] : input.flaws.map.smooth_layers)
    if (!contains(input.flaws.traces, layer, layer_of))
      throw values.error("Flaws/Smooth layers", "no trace of the map is on a layer {}", in_quotes(layer));
  if (!input.specimen.specimen_file.empty())
    return;
  const auto check = [&](const std::vector<Shape>& shapes, const char* entry) {
    const double width = input.specimen.width, height = input.specimen.height;
    const std::string what = input.specimen.dimension == 2 ? objection<2>(shapes, Vector<2>(width, height))
                                                           : objection<3>(shapes, Vector<3>(width, width, height));
    if (!what.empty())
      throw values.error(entry, what);
  };
  check(input.flaws.shapes, "Flaws/Shapes");
  check(input.flaws.placed_traces(), "Flaws/Traces file");
}

/// The entries of grains, joints and contacts that are given though the specimen file has them already.
std::vector<std::string> settled_by_file(const Input& input, const GivenEntries& values)
{
  std::vector<std::string> entries;
  if (input.specimen.specimen_file.empty())
    return entries;
  // These are checked against the file, or name it.
  constexpr std::array read{"Specimen/Dimension", "Specimen/Joint law", "Specimen/Specimen file",
                            "Specimen/Packing file"};
  const std::array of_body{std::string("Specimen"), std::string("Particle contact"),
                           section_of(input.specimen.joint_law)};
  for (const GivenEntry& given : values.all())
    if (contains(of_body, find_parameter(given.name)->section) && !contains(read, given.name))
      entries.push_back(given.name);
  return entries;
}

/// Reads the loading table, where a test follows it.
void complete_loading(Input& input, const GivenEntries& values)
{
  const auto follower = std::ranges::find_if(input.test_list, &TestKind::follows_stages);
  if (follower == input.test_list.end())
    return;
  const auto refuse = [&](const char* entry, const std::string& why) {
    throw values.error(values.has(entry) ? entry : "Tests/List", "{} {}", follower->name, why);
  };
  if (input.tests.of<LoadingTable>().file.empty())
    refuse("Tests/Loading table", "follows a table; name its CSV file by Tests/Loading table");
  if (input.tests.of<ConfinementParameters>().lateral_boundary != LateralBoundary::wall)
    refuse("Tests/Lateral boundary", "presses by walls; set Lateral boundary = wall");
  if (input.tests.of<ConfinementParameters>().intermediate_stress)
    refuse("Tests/Intermediate stress", "has one confinement on all sides; set Intermediate stress = none");
  input.tests.of<LoadingTable>().stages = read_loading_stages(input.tests.of<LoadingTable>().file);
}

void check_strain_path(const Input& input, const GivenEntries& values)
{
  const std::size_t n = input.strain_path.direction.size();
  if (n != 0 && n != (input.specimen.dimension == 2 ? 3u : 6u))
    throw values.error("Strain path/Direction", "has {} components; in {} dimensions there must be {}", n,
                       input.specimen.dimension,
                       input.specimen.dimension == 2 ? "3: xx, yy, xy" : "6: xx, yy, zz, yz, xz, xy");
}
} // namespace

double expected_grains(const SpecimenParameters& specimen)
{
  const double area = (1.0 - specimen.porosity) * specimen.width * specimen.height;
  if (specimen.dimension == 2)
    return expected_number(specimen, area);
  const double cylinder_over_box = specimen.shape_when_packed() == BodyShape::cylinder ? 0.25 * std::numbers::pi : 1.0;
  return expected_number(specimen, cylinder_over_box * area * specimen.width);
}

std::filesystem::path Input::file_named(const std::string_view name) const
{
  const std::filesystem::path path = folder / name;
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) ? path : path.lexically_normal();
}

Input read_input(const std::filesystem::path& file, const std::filesystem::path& folder,
                 const std::vector<std::string>& settings)
{
  return read_input(GivenEntries(file, settings), folder.empty() ? file.parent_path() : folder);
}

Input read_input(const GivenEntries& values, const std::filesystem::path& folder)
{
  Input input;
  input.folder = folder;
  for (const GivenEntry& given : values.all())
    rephrased([&] { find_parameter(given.name)->read(input, given.value); },
              [&](const std::string& what) { return values.error(given.name, what); });
  settle_dimension(input, values);
  settle_installation(input, values);
  complete_loading(input, values);
  complete_variants(input, values);
  complete_rocks(input, values);
  input.settled_by_file = settled_by_file(input, values);
  check_joint_law(input, values);
  for (const Variant& variant : variants(input))
    {
      const GivenEntries of_variant =
        values.with(variant.settings, input.variants.table.empty() ? "Variants/Values" : "Variants/Table");
      check_bonds(variant.input, of_variant);
      check_demands(variant.input, of_variant);
      check_specimen(variant.input, of_variant);
      check_strain_path(variant.input, of_variant);
      check_flaws(variant.input, of_variant);
      check_smooth_joints(variant.input, of_variant);
      check_clumps(variant.input, of_variant);
      check_minerals(variant.input, of_variant);
      check_mineral_grains(variant.input, of_variant);
    }
  if (!input.rocks.entries.empty())
    for (const Variant& rock : rocks_of_sample(input))
      check_minerals(rock.input, values.with(rock.settings, "Sample/Rocks"));
  remark_on_map(input);
  return input;
}
} // namespace feldspar
