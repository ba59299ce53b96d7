#include "dem/specimen/specimen_file.h"

#include "base/byte_archive.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/parameter_id.h"
#include "base/quoted.h"
#include "base/system/hdf5_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace feldspar
{
namespace
{
const std::string format_name = "feldspar specimen";
const std::string name_of_origin = "made_of";
constexpr std::uint32_t schema_version = 3;
constexpr double most_segments = 4096.0; // of a face, far beyond what an input may ask for

/// Numbers that lie otherwise than in a vector; reading them, as many as there are.
template <typename Archive, typename Numbers>
void transfer_numbers(Archive& archive, const std::string& name, Numbers& numbers)
{
  std::vector<double> values(numbers.begin(), numbers.end());
  archive.array(name, values);
  if (values.size() != numbers.size())
    throw InputError("{} holds {} values instead of {}", name, values.size(), numbers.size());
  if constexpr (Archive::reads)
    std::ranges::copy(values, numbers.begin());
}

/// Returns whether a part that a file may lack is transferred: writing, if the specimen has it; reading, if the file does.
template <auto file_has, typename Archive>
bool goes(Archive& archive, const std::string& name, const bool specimen_has)
{
  if constexpr (Archive::reads)
    return (archive.*file_has)(name);
  else
    return specimen_has;
}

/// Name and numbers of the joints' law; a file that tells none is of the time of the flat joint alone.
template <int dim, typename Archive>
void transfer_law(Archive& archive, Joints<dim>& joints)
{
  if (!goes<&Hdf5Reader::has_attribute>(archive, "law", true))
    return;
  std::string name = std::visit([](const auto& law) { return std::string(law.name); }, joints.law);
  archive.text("law", name);
  const auto law = JointLaws::named<dim>(name);
  if (!law)
    throw InputError("joints of the law {}, which this program does not have", in_quotes(name));
  if constexpr (Archive::reads)
    joints.law = *law;
  std::visit(
    [&](auto& with_numbers) {
      if constexpr (requires { with_numbers.transfer(archive); })
        with_numbers.transfer(archive);
    },
    joints.law);
}

/// Name, openness, counts and outline of each; a file that tells none is of intact rock. Rocks without any write none, so
/// that their files stay as they were.
template <int dim, typename Archive>
void transfer_flaws(Archive& root, std::vector<Flaw<dim>>& flaws)
{
  constexpr std::uint32_t most_flaws = 100000;
  std::uint32_t n = std::uint32_t(flaws.size());
  if (!goes<&Hdf5Reader::has>(root, "flaws", n > 0))
    return;
  auto all = root.subgroup("flaws");
  all.value("n", n);
  if (n > most_flaws)
    throw InputError("more flaws than a specimen can have");
  flaws.resize(n);
  for (std::uint32_t k = 0; k < n; ++k)
    {
      Flaw<dim>& flaw = flaws[k];
      auto one = all.subgroup(fmt::format("{}", k + 1));
      one.text("name", flaw.name);
      transfer_flag(one, "open", flaw.open);
      one.value("n_grains", flaw.n_grains);
      one.value("n_joints", flaw.n_joints);
      for (int c = 0; c < dim; ++c)
        {
          auto along = mapped<double>(flaw.outline, [&](const auto& point) { return point[c]; });
          one.array(fmt::format("outline_{}_m", "xyz"[c]), along);
          if (c > 0 && along.size() != flaw.outline.size())
            throw InputError("the outline of a flaw is incomplete");
          flaw.outline.resize(along.size(), Vector<dim>::Zero());
          for (std::size_t p = 0; p < along.size(); ++p)
            flaw.outline[p][c] = along[p];
        }
    }
}

/// Transfers the smooth joints; like transfer_flaws(), it stores nothing of a specimen without any.
template <int dim, typename Archive>
void transfer_smooth_joints(Archive& root, Specimen<dim>& specimen)
{
  if (!goes<&Hdf5Reader::has>(root, "smooth_joints", !specimen.smooth_joints.empty() || !specimen.kept_apart.empty()))
    return;
  constexpr std::size_t most_neighbours = 1000; // before a list is made for so many
  auto archive = root.subgroup("smooth_joints");
  auto& joints = specimen.smooth_joints;
  // A column of all of them, one number each.
  const auto pass_by = [&](const std::string& name, const auto& part) {
    using Number = std::remove_cvref_t<decltype(part(std::declval<SmoothJoint<dim>&>()))>;
    std::vector<std::conditional_t<std::is_floating_point_v<Number>, double, std::uint32_t>> column;
    column.reserve(joints.size());
    for (auto& joint : joints)
      column.push_back(part(joint));
    archive.array(name, column);
    if constexpr (Archive::reads)
      {
        if (joints.empty() && column.size() <= most_neighbours * specimen.grains.size())
          joints.resize(column.size());
        if (joints.size() != column.size())
          throw InputError("smooth joints are incomplete");
        for (std::size_t k = 0; k < joints.size(); ++k)
          part(joints[k]) = Number(column[k]);
      }
  };
  // One that is joint.*first.*second of each.
  const auto pass = [&](const std::string& name, const auto... members) {
    pass_by(
      name, [=](auto& joint) -> auto& { return (joint.*....*members); });
  };
  using Joint = SmoothJoint<dim>;
  using smooth_joint::Face;
  using State = smooth_joint::State<dim>;
  pass("grain_1", &Joint::grain_1);
  pass("grain_2", &Joint::grain_2);
  pass("number", &Joint::number);
  pass("area_m2", &Joint::area);
  pass("half_radius_difference_m", &Joint::half_radius_difference);
  for (int c = 0; c < dim; ++c)
    {
      pass_by(
        fmt::format("normal_{}", "xyz"[c]), [c](auto& joint) -> auto& { return joint.normal[c]; });
      pass_by(
        fmt::format("branch_{}_m", "xyz"[c]), [c](auto& joint) -> auto& { return joint.branch[c]; });
    }
  pass("normal_stiffness_Pa_per_m", &Joint::face, &Face::normal_stiffness);
  pass("shear_stiffness_Pa_per_m", &Joint::face, &Face::shear_stiffness);
  pass("friction", &Joint::face, &Face::friction);
  pass("dilation_slope", &Joint::face, &Face::dilation_slope);
  pass("tensile_strength_Pa", &Joint::face, &Face::bond, &Bond<double>::tensile_strength);
  pass("cohesion_Pa", &Joint::face, &Face::bond, &Bond<double>::cohesion);
  pass("friction_slope", &Joint::face, &Face::bond, &Bond<double>::friction_slope);
  pass("gap_m", &Joint::state, &State::gap);
  pass("bonded", &Joint::state, &State::bonded);

  std::vector<std::uint32_t> ends;
  for (const auto& [one, two] : specimen.kept_apart)
    {
      ends.push_back(one);
      ends.push_back(two);
    }
  archive.array("kept_apart", ends);
  if constexpr (Archive::reads)
    {
      specimen.kept_apart.resize(ends.size() / 2);
      for (std::size_t k = 0; k < specimen.kept_apart.size(); ++k)
        specimen.kept_apart[k] = {ends[2 * k], ends[2 * k + 1]};
    }
}

/// Names and colours of the minerals, and the number of each grain's; nothing of a specimen without.
template <int dim, typename Archive>
void transfer_minerals(Archive& grains, Specimen<dim>& specimen)
{
  constexpr std::uint32_t most_minerals = 250; // as of a table
  if (!goes<&Hdf5Reader::has>(grains, "mineral", !specimen.minerals.empty()))
    return;
  grains.array("mineral", specimen.mineral);
  std::uint32_t n = std::uint32_t(specimen.minerals.size());
  grains.value("n_minerals", n);
  if (n == 0 || n > most_minerals)
    throw InputError("no mineral, or more than a specimen can have");
  specimen.minerals.resize(n);
  for (std::uint32_t k = 0; k < n; ++k)
    {
      grains.text(fmt::format("mineral_{}", k + 1), specimen.minerals[k].name);
      grains.value(fmt::format("colour_{}", k + 1), specimen.minerals[k].colour);
    }
}

/// The layout of the file: one description serves writing, which changes nothing, and reading.
template <int dim, typename Archive>
void transfer(Archive& root, Specimen<dim>& specimen)
{
  const auto component = [](const char* what, const int c) { return fmt::format("{}_{}_m", what, "xyz"[c]); };
  for (int c = 0; c < dim; ++c)
    root.value(component("size", c), specimen.size[c]);
  std::uint32_t periodic = specimen.is_periodic();
  root.value("periodic", periodic);
  std::uint32_t round = specimen.is_round();
  root.value("round", round);
  if constexpr (Archive::reads)
    specimen.shape = periodic != 0 ? BodyShape::periodic : round != 0 ? BodyShape::cylinder : BodyShape::box;
  root.value("thickness_m", specimen.thickness);
  root.value("bulk_density_kg_per_m3", specimen.bulk_density);
  root.value("seed", specimen.seed);

  auto report = root.subgroup("report");
  report.value("n_grains", specimen.report.n_grains);
  report.value("n_joints", specimen.report.n_joints);
  report.value("coordination_number", specimen.report.coordination_number);
  report.value("coordination_number_core", specimen.report.coordination_number_core);
  report.value("installation_gap_ratio", specimen.report.installation_gap_ratio);
  report.value("porosity", specimen.report.porosity);
  report.value("mean_overlap_ratio", specimen.report.mean_overlap_ratio);
  report.value("largest_overlap_ratio", specimen.report.largest_overlap_ratio);
  report.value("resolution", specimen.report.resolution);
  report.value("radius_multiplier", specimen.report.radius_multiplier);
  report.value("packing_stress_Pa", specimen.report.packing_stress);
  report.value("mean_radius_m", specimen.report.mean_radius);
  if (goes<&Hdf5Reader::has_attribute>(report, "n_smooth_joints", specimen.report.n_smooth_joints > 0))
    report.value("n_smooth_joints", specimen.report.n_smooth_joints);
  const bool has_clumps = goes<&Hdf5Reader::has_attribute>(report, "n_clumps", specimen.groups_are_rigid);
  if constexpr (Archive::reads)
    specimen.groups_are_rigid = has_clumps;
  if (has_clumps)
    report.value("n_clumps", specimen.report.n_clumps);
  if (goes<&Hdf5Reader::has_attribute>(report, "n_cut_joints", true)) // a file may be older
    {
      report.value("n_cut_joints", specimen.report.n_cut_joints);
      report.value("n_removed_grains", specimen.report.n_removed_grains);
    }

  auto contact = root.subgroup("particle_contact");
  contact.value("modulus_Pa", specimen.particle_contact.modulus);
  contact.value("stiffness_ratio", specimen.particle_contact.stiffness_ratio);
  contact.value("friction", specimen.particle_contact.friction);

  transfer_flaws<dim>(root, specimen.flaws);

  auto grains = root.subgroup("grains");
  grains.array("radius_m", specimen.grains.radius);
  for (int c = 0; c < dim; ++c)
    grains.array(component("position", c), specimen.grains.position[c]);
  grains.array("mass_kg", specimen.grains.mass);
  const std::string group_name = has_clumps ? "clump" : "mineral_grain";
  if (goes<&Hdf5Reader::has>(grains, group_name, !specimen.groups.empty()))
    grains.array(group_name, specimen.groups);

  transfer_minerals(grains, specimen);

  auto joints = root.subgroup("joints");
  auto& stored = specimen.joints;
  auto division = stored.division;
  if constexpr (dim == 2)
    joints.value("n_segments", division[0]);
  else
    {
      joints.value("n_rings", division[0]);
      joints.value("n_sectors", division[1]);
    }
  transfer_law<dim>(joints, stored);
  joints.value("thickness_m", stored.thickness);
  joints.value("friction", stored.friction);
  joints.value("friction_slope", stored.friction_slope);
  joints.array("grain_1", stored.grain_1);
  joints.array("grain_2", stored.grain_2);
  joints.array("number", stored.number);
  if constexpr (Archive::reads)
    {
      // Before a table is made for so many segments.
      const double n_segments = std::accumulate(division.begin(), division.end(), 1.0, std::multiplies<>());
      if (!(n_segments >= 1.0 && n_segments <= most_segments) ||
          n_segments * double(stored.grain_1.size()) != double(joints.size_of("bonded")))
        throw InputError("joints are missing, or divided into another number of segments");
      stored.divide(division, std::visit([](const auto& law) { return law.n_more; }, stored.law));
      stored.resize_all(stored.grain_1.size());
    }
  const auto pass = [&](const std::string& name, auto& values) { transfer_numbers(joints, name, values); };
  stored.visit_per_joint(pass);
  stored.visit_per_segment(pass);
  if (!specimen.minerals.empty())
    pass("further_friction", stored.further_friction);
  transfer_smooth_joints(root, specimen);
}
} // namespace

template <int dim>
void write_specimen(const Specimen<dim>& specimen, const std::filesystem::path& file, const std::string& made_of,
                    const std::function<void(Hdf5Writer&)>& more)
{
  write_hdf5(file, [&](Hdf5Writer& root) {
    std::string format = format_name;
    std::uint32_t version = schema_version;
    std::uint32_t dimension = dim;
    root.text("format", format);
    root.value("schema_version", version);
    root.value("dimension", dimension);
    transfer(root, const_cast<Specimen<dim>&>(specimen));
    if (std::string name = made_of; !name.empty())
      root.text(name_of_origin, name);
    if (more)
      more(root);
  });
}

template <int dim>
Specimen<dim> read_specimen(const std::filesystem::path& file, const std::function<void()>& check_now)
{
  Specimen<dim> specimen;
  const auto read = [&](Hdf5Reader& root) {
    std::string format;
    std::uint32_t version = 0;
    std::uint32_t dimension = 0;
    root.text("format", format);
    root.value("schema_version", version);
    root.value("dimension", dimension);
    if (format != format_name)
      throw InputError("another kind of file");
    if (version != schema_version)
      throw InputError("a specimen of layout {}, this program reads layout {}", version, schema_version);
    if (dimension != dim)
      throw InputError("a specimen in {} dimensions, the input asks for {}", dimension, dim);
    transfer(root, specimen);
    check_specimen(specimen);
  };
  read_foreign_hdf5(file, "a specimen.h5 of " + in_words(Work::specimen), read, check_now);

  auto& grains = specimen.grains;
  const auto masses = grains.mass;
  grains.place(std::vector<double>(grains.radius), Components<dim>(grains.position));
  grains.mass = masses;
  for (std::size_t i = 0; i < grains.size(); ++i)
    grains.moment_of_inertia[i] = masses[i] * gyration_squared<dim>(grains.radius[i]);
  return specimen;
}

SpecimenHead head_of_specimen(const std::filesystem::path& file, const std::function<void()>& check_now)
{
  SpecimenHead head{};
  const auto read = [&](Hdf5Reader& root) {
    root.value("dimension", head.dimension);
    if (head.dimension != 2 && head.dimension != 3)
      throw InputError("a specimen of neither two nor three dimensions");
    root.subgroup("report").value("n_grains", head.n_grains);
    if (root.has_attribute(name_of_origin))
      root.text(name_of_origin, head.made_of);
  };
  read_foreign_hdf5(file, "a specimen.h5 of " + in_words(Work::specimen), read, check_now);
  return head;
}

template decltype(write_specimen<2>) write_specimen<2>;
template decltype(read_specimen<2>) read_specimen<2>;
template decltype(write_specimen<3>) write_specimen<3>;
template decltype(read_specimen<3>) read_specimen<3>;
} // namespace feldspar
