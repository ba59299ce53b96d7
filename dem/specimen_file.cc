#include "dem/specimen_file.h"

#include "dem/input_error.h"

#include <H5Cpp.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

namespace feldspar
{
namespace
{
constexpr const char* format_name = "feldspar specimen";
constexpr int schema_version = 1;

template <typename T>
const H5::PredType& stored_type()
{
  if constexpr (std::is_same_v<T, double>)
    return H5::PredType::NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return H5::PredType::NATIVE_UINT64;
  else
    {
      static_assert(std::is_same_v<T, std::uint32_t>);
      return H5::PredType::NATIVE_UINT32;
    }
}

/// Writing and reading walk the same description of the file, each with its own archive.
class Writer
{
public:
  explicit Writer(H5::Group where)
    : group(std::move(where))
  {
  }

  template <typename T>
  void value(const std::string& name, T& stored)
  {
    group.createAttribute(name, stored_type<T>(), H5::DataSpace(H5S_SCALAR)).write(stored_type<T>(), &stored);
  }

  template <typename T>
  void array(const std::string& name, std::vector<T>& values, std::size_t)
  {
    const hsize_t n = values.size();
    group.createDataSet(name, stored_type<T>(), H5::DataSpace(1, &n)).write(values.data(), stored_type<T>());
  }

  Writer subgroup(const std::string& name) { return Writer(group.createGroup(name)); }

private:
  H5::Group group;
};

class Reader
{
public:
  explicit Reader(H5::Group where)
    : group(std::move(where))
  {
  }

  template <typename T>
  void value(const std::string& name, T& stored)
  {
    group.openAttribute(name).read(stored_type<T>(), &stored);
  }

  template <typename T>
  void array(const std::string& name, std::vector<T>& values, const std::size_t n_expected)
  {
    const H5::DataSet set = group.openDataSet(name);
    const auto n = std::size_t(set.getSpace().getSimpleExtentNpoints());
    if (n != n_expected)
      throw InputError(fmt::format("{} has {} entries, {} are expected", name, n, n_expected));
    values.resize(n);
    set.read(values.data(), stored_type<T>());
    if constexpr (std::is_same_v<T, double>)
      if (!std::all_of(values.begin(), values.end(), [](const double v) { return std::isfinite(v); }))
        throw InputError(fmt::format("{} holds a value that is not finite", name));
  }

  Reader subgroup(const std::string& name) { return Reader(group.openGroup(name)); }

private:
  H5::Group group;
};

/// The layout of the file. When reading, numbers come before the arrays whose lengths they give.
template <int dim, typename Archive>
void transfer(Archive root, Specimen<dim>& specimen)
{
  for (int c = 0; c < dim; ++c)
    root.value(std::string("size_") + "xyz"[c] + "_m", specimen.size[c]);
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
  const std::size_t n_grains = specimen.report.n_grains;
  grains.array("radius_m", specimen.grains.radius, n_grains);
  for (int c = 0; c < dim; ++c)
    grains.array(std::string("position_") + "xyz"[c] + "_m", specimen.grains.position[c], n_grains);
  grains.array("mass_kg", specimen.grains.mass, n_grains);

  auto joints = root.subgroup("joints");
  auto& stored = specimen.joints;
  const std::size_t n_joints = specimen.report.n_joints;
  joints.value("n_segments", stored.n_segments);
  joints.value("thickness_m", stored.thickness);
  joints.value("friction", stored.friction);
  joints.value("friction_slope", stored.friction_slope);
  joints.array("grain_1", stored.grain_1, n_joints);
  joints.array("grain_2", stored.grain_2, n_joints);
  joints.array("number", stored.number, n_joints);
  stored.visit_per_joint(
    [&](const std::string& name, std::vector<double>& values) { joints.array(name, values, n_joints); });
  stored.visit_per_segment([&](const std::string& name, std::vector<double>& values) {
    joints.array(name, values, n_joints * stored.n_segments);
  });
}

/// What sizes alone do not tell.
template <int dim>
void check(const Specimen<dim>& specimen)
{
  const auto positive = [](const double v) { return v > 0.0; };
  const auto& grains = specimen.grains;
  const auto& joints = specimen.joints;
  if (!std::all_of(grains.radius.begin(), grains.radius.end(), positive) ||
      !std::all_of(grains.mass.begin(), grains.mass.end(), positive))
    throw InputError("a grain has no positive radius and mass");
  if (joints.n_segments == 0)
    throw InputError("joints without segments");
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints.grain_1[j] >= joints.grain_2[j] || joints.grain_2[j] >= grains.size())
      throw InputError(
        fmt::format("joint {} names grains {} and {} of {}", j, joints.grain_1[j], joints.grain_2[j], grains.size()));
}
} // namespace

template <int dim>
void write_specimen(const Specimen<dim>& specimen, const std::filesystem::path& file)
{
  H5::Exception::dontPrint();
  std::filesystem::path unfinished = file;
  unfinished += ".unfinished";
  try
    {
      H5::H5File out(unfinished.string(), H5F_ACC_TRUNC);
      H5::Group root = out.openGroup("/");
      const H5::StrType text(H5::PredType::C_S1, H5T_VARIABLE);
      root.createAttribute("format", text, H5::DataSpace(H5S_SCALAR)).write(text, std::string(format_name));
      root.createAttribute("schema_version", H5::PredType::NATIVE_INT, H5::DataSpace(H5S_SCALAR))
        .write(H5::PredType::NATIVE_INT, &schema_version);
      root.createAttribute("dimension", H5::PredType::NATIVE_INT, H5::DataSpace(H5S_SCALAR))
        .write(H5::PredType::NATIVE_INT, std::array{dim}.data());
      Specimen<dim> copy = specimen; // one description serves writing and reading, and reading changes
      transfer(Writer(root), copy);
    }
  catch (const H5::Exception& error)
    {
      std::error_code ignored;
      std::filesystem::remove(unfinished, ignored);
      throw std::runtime_error(fmt::format("{} cannot be written: {}", file.string(), error.getDetailMsg()));
    }
  std::filesystem::rename(unfinished, file);
}

std::string specimen_file_name(const std::uint64_t seed, const std::size_t n_specimens)
{
  return n_specimens == 1 ? "specimen.h5" : fmt::format("specimen_seed_{}.h5", seed);
}

template <int dim>
Specimen<dim> read_specimen(const std::filesystem::path& file)
{
  H5::Exception::dontPrint();
  const std::string name = file.string();
  const auto refuse = [&](const std::string& what) {
    return InputError(fmt::format("{}: {}; a specimen.h5 of `feldspar specimen` is expected", name, what));
  };
  if (!std::filesystem::is_regular_file(file))
    throw refuse("no such file");
  try
    {
      const H5::H5File in(name, H5F_ACC_RDONLY);
      const H5::Group root = in.openGroup("/");
      if (!root.attrExists("format") || !root.attrExists("schema_version") || !root.attrExists("dimension"))
        throw refuse("an HDF5 file, but not a specimen");
      std::string format;
      const H5::Attribute format_attribute = root.openAttribute("format");
      format_attribute.read(format_attribute.getStrType(), format);
      int version = 0;
      root.openAttribute("schema_version").read(H5::PredType::NATIVE_INT, &version);
      int dimension = 0;
      root.openAttribute("dimension").read(H5::PredType::NATIVE_INT, &dimension);
      if (format != format_name)
        throw refuse("an HDF5 file, but not a specimen");
      if (version != schema_version)
        throw refuse(fmt::format("a specimen of layout {}, this program reads layout {}", version, schema_version));
      if (dimension != dim)
        throw refuse(fmt::format("a specimen in {} dimensions, the input asks for {}", dimension, dim));

      Specimen<dim> specimen;
      try
        {
          transfer(Reader(root), specimen);
          check(specimen);
        }
      catch (const InputError& error)
        {
          throw refuse(error.what());
        }
      auto& grains = specimen.grains;
      const auto masses = grains.mass;
      grains.place(std::vector<double>(grains.radius), Components<dim>(grains.position));
      grains.mass = masses;
      for (std::size_t i = 0; i < grains.size(); ++i)
        grains.moment_of_inertia[i] = masses[i] * gyration_squared<dim>(grains.radius[i]);
      auto& joints = specimen.joints;
      resize<dim>(joints.force, joints.size());
      resize<n_rotations<dim>>(joints.couple_1, joints.size());
      resize<n_rotations<dim>>(joints.couple_2, joints.size());
      return specimen;
    }
  catch (const H5::Exception&)
    {
      throw refuse("not an HDF5 file, cut short, or without something a specimen has");
    }
}

template void write_specimen<2>(const Specimen<2>&, const std::filesystem::path&);
template Specimen<2> read_specimen<2>(const std::filesystem::path&);
} // namespace feldspar
