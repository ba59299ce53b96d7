#include "dem/specimen/specimen_file.h"

#include "base/hdf5_archive.h"
#include "base/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace feldspar
{
namespace
{
const std::string format_name = "feldspar specimen";
constexpr std::uint32_t schema_version = 3;

/// The layout of the file.
template <int dim, typename Archive>
void transfer(Archive& root, Specimen<dim>& specimen)
{
  const auto component = [](const char* what, const int c) { return fmt::format("{}_{}_m", what, "xyz"[c]); };
  for (int c = 0; c < dim; ++c)
    root.value(component("size", c), specimen.size[c]);
  std::uint32_t periodic = specimen.periodic;
  root.value("periodic", periodic);
  specimen.periodic = periodic != 0;
  std::uint32_t round = specimen.round;
  root.value("round", round);
  specimen.round = round != 0;
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

  auto contact = root.subgroup("particle_contact");
  contact.value("modulus_Pa", specimen.particle_contact.modulus);
  contact.value("stiffness_ratio", specimen.particle_contact.stiffness_ratio);
  contact.value("friction", specimen.particle_contact.friction);

  auto grains = root.subgroup("grains");
  grains.array("radius_m", specimen.grains.radius);
  for (int c = 0; c < dim; ++c)
    grains.array(component("position", c), specimen.grains.position[c]);
  grains.array("mass_kg", specimen.grains.mass);

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
  stored.divide(division);
  joints.value("thickness_m", stored.thickness);
  joints.value("friction", stored.friction);
  joints.value("friction_slope", stored.friction_slope);
  joints.array("grain_1", stored.grain_1);
  joints.array("grain_2", stored.grain_2);
  joints.array("number", stored.number);
  if constexpr (Archive::reads)
    stored.resize_all(stored.grain_1.size());
  const auto pass = [&](const std::string& name, auto& values) { transfer_numbers(joints, name, values); };
  stored.visit_per_joint(pass);
  stored.visit_per_segment(pass);
}

/// What types alone do not tell.
template <int dim>
void check(Specimen<dim>& specimen)
{
  auto& grains = specimen.grains;
  auto& joints = specimen.joints;
  const auto require = [](const bool holds, const char* otherwise) {
    if (!holds)
      throw InputError(otherwise);
  };
  require(grains.size() == specimen.report.n_grains && grains.mass.size() == grains.size(), "grains are missing");
  for (const auto& component : grains.position)
    require(component.size() == grains.size(), "grains are missing");
  const auto positive = [](const double v) { return v > 0.0; };
  require(std::all_of(grains.radius.begin(), grains.radius.end(), positive) &&
            std::all_of(grains.mass.begin(), grains.mass.end(), positive),
          "a grain has no positive radius and mass");

  require(joints.n_segments > 0, "joints without segments");
  require(joints.size() == specimen.report.n_joints && joints.grain_2.size() == joints.size() &&
            joints.number.size() == joints.size(),
          "joints are missing");
  for (std::size_t j = 0; j < joints.size(); ++j)
    require(joints.grain_1[j] < joints.grain_2[j] + std::uint32_t(specimen.periodic) && // or its own image
              joints.grain_2[j] < grains.size(),
            "a joint names a grain that is not there");
}
} // namespace

template <int dim>
void write_specimen(const Specimen<dim>& specimen, const std::filesystem::path& file,
                    const std::function<void(Hdf5Writer&)>& more)
{
  write_hdf5(file, [&](Hdf5Writer& root) {
    std::string format = format_name;
    std::uint32_t version = schema_version;
    std::uint32_t dimension = dim;
    root.text("format", format);
    root.value("schema_version", version);
    root.value("dimension", dimension);
    Specimen<dim> copy = specimen; // one description serves writing and reading, and reading changes
    transfer(root, copy);
    if (more)
      more(root);
  });
}

template <int dim>
Specimen<dim> read_specimen(const std::filesystem::path& file)
{
  Specimen<dim> specimen;
  read_hdf5(file, "a specimen.h5 of `feldspar specimen`", [&](Hdf5Reader& root) {
    std::string format;
    std::uint32_t version = 0;
    std::uint32_t dimension = 0;
    root.text("format", format);
    root.value("schema_version", version);
    root.value("dimension", dimension);
    if (format != format_name)
      throw InputError("another kind of file");
    if (version != schema_version)
      throw InputError(fmt::format("a specimen of layout {}, this program reads layout {}", version, schema_version));
    if (dimension != dim)
      throw InputError(fmt::format("a specimen in {} dimensions, the input asks for {}", dimension, dim));
    transfer(root, specimen);
    check(specimen);
  });

  auto& grains = specimen.grains;
  const auto masses = grains.mass;
  grains.place(std::vector<double>(grains.radius), Components<dim>(grains.position));
  grains.mass = masses;
  for (std::size_t i = 0; i < grains.size(); ++i)
    grains.moment_of_inertia[i] = masses[i] * gyration_squared<dim>(grains.radius[i]);
  return specimen;
}

template void write_specimen<2>(const Specimen<2>&, const std::filesystem::path&,
                                const std::function<void(Hdf5Writer&)>&);
template Specimen<2> read_specimen<2>(const std::filesystem::path&);
template void write_specimen<3>(const Specimen<3>&, const std::filesystem::path&,
                                const std::function<void(Hdf5Writer&)>&);
template Specimen<3> read_specimen<3>(const std::filesystem::path&);
} // namespace feldspar
