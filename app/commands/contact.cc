#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/input/joint_sections.h"
#include "app/input/parameter_table.h"
#include "app/run/output_folder.h"
#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "base/table/csv.h"
#include "base/whole_file.h"
#include "dem/laws/joint_laws.h"

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <iterator>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

/// `feldspar contact`: one joint along a displacement path, each row one update of the law.
namespace feldspar
{
namespace
{
constexpr double thickness = 1.0; // of a joint in the plane [m]

template <typename Law>
Face<double> make_face(const typename Law::Parameters& joint, const Input& input)
{
  const ContactParameters& grains = input.contact;
  const double normal_stiffness = stiffness_per_area(joint.modulus, grains.radius_1, grains.radius_2);
  return {normal_stiffness, normal_stiffness / joint.stiffness_ratio,
          face_half_length(joint.radius_multiplier, grains.radius_1, grains.radius_2), thickness,
          Law::friction(joint, input.particle_contact)};
}

/// The state of an element after the update by its law.
template <typename Update>
struct Segments
{
  template <typename Parameters>
  Segments(const Parameters& joint, const std::size_t n)
    : strength{joint.bond_tensile_strength, joint.bond_cohesion, std::tan(joint.bond_friction_angle)}
    , updates(n)
  {
    for (auto& update : updates)
      update.state.bonded = true;
  }

  const Bond<double>& bond(unsigned int) const { return strength; }
  const auto& state(const unsigned int i) const { return updates[i].state; }
  void set(const unsigned int i, const Update& update) { updates[i] = update; }

  Bond<double> strength;
  std::vector<Update> updates;
};

/// Columns of the path and of the response.
struct Columns
{
  const char* path;
  const char* resultants;
  const char* segment;
};

template <int dim>
constexpr Columns columns = {"normal_m,shear_m,rotation_rad", "normal_force_N,shear_force_N,moment_Nm",
                             ",sigma_{0}_Pa,tau_{0}_Pa,bonded_{0}"};
template <>
constexpr Columns columns<3> = {
  "normal_m,shear_1_m,shear_2_m,twist_rad,bend_1_rad,bend_2_rad",
  "normal_force_N,shear_force_1_N,shear_force_2_N,twist_moment_Nm,bend_moment_1_Nm,bend_moment_2_Nm",
  ",sigma_{0}_Pa,tau_1_{0}_Pa,tau_2_{0}_Pa,bonded_{0}"};

template <int dim>
std::string csv_header(const std::size_t n_segments)
{
  std::string header = columns<dim>.resultants;
  for (std::size_t i = 1; i <= n_segments; ++i)
    header += fmt::format(fmt::runtime(columns<dim>.segment), i);
  return header + '\n';
}

/// Motion of the face from one row of the path to the next; the contact plane stays where it is.
template <int dim>
FaceMotion<dim, double> row_motion(const std::vector<double>& before, const std::vector<double>& now)
{
  FaceMotion<dim, double> motion;
  motion.opening_before = before[0];
  motion.opening = now[0];
  for (int c = 0; c < dim - 1; ++c)
    motion.slip_increment[c] = now[1 + c] - before[1 + c];
  for (int c = 0; c < n_rotations<dim>; ++c)
    {
      motion.rotation_before[c] = before[dim + c];
      motion.rotation[c] = now[dim + c];
    }
  return motion;
}

template <int dim, typename Law>
std::string response(const Law& law, const typename Law::Parameters& joint, const Input& input)
{
  const auto path = read_csv(input.contact.path_file, columns<dim>.path);
  const Face<double> face = make_face<Law>(joint, input);
  const auto elements = face_elements<dim>(Law::division(joint));
  Segments<typename Law::template Update<double>> segments(joint, elements.size());
  std::string table = csv_header<dim>(elements.size());
  std::vector<double> before(dim + n_rotations<dim>, 0.0);
  for (std::size_t row = 0; row < path.size(); ++row)
    {
      const auto motion = row_motion<dim>(before, path[row]);
      const auto sum = law.template update<double>(face, elements, motion, segments);
      const auto append = [&](const double value, const char* comma = ",") {
        if (!std::isfinite(value))
          throw InputError("{}: row {} below the header: the response is beyond the range of numbers: a "
                           "displacement, a rotation or a stiffness is far too large",
                           input.contact.path_file, row + 1);
        fmt::format_to(std::back_inserter(table), "{}{}", comma, value + 0.0); // adding zero turns -0 into 0
      };
      append(sum.normal_force, "");
      for (const double force : sum.shear_force)
        append(force);
      for (const double moment : sum.moment)
        append(moment);
      for (std::size_t i = 0; i < elements.size(); ++i)
        {
          const auto& update = segments.updates[i];
          append(Law::normal_stress(face, elements[i], motion, update));
          for (const double tau : update.state.shear_stress)
            append(tau);
          fmt::format_to(std::back_inserter(table), ",{:d}", update.state.bonded);
        }
      table += '\n';
      before = path[row];
    }
  return table;
}

/// The response of the joint to the path.
template <int dim>
std::string response(const Input& input)
{
  const JointParameters joint = joint_parameters(input);
  return std::visit(
    [&]<typename Law, typename Parameters>(const Law& law, const Parameters& parameters) -> std::string {
      if constexpr (std::same_as<typename Law::Parameters, Parameters>)
        return response<dim>(law, parameters, input);
      else
        throw std::logic_error("a joint law with the parameters of another");
    },
    JointLaws::make<dim>(joint, input.particle_contact), joint);
}
} // namespace

std::string contact_response(const Input& input, const std::filesystem::path& input_file)
{
  if (input.contact.path_file.empty())
    throw InputError("{}: Contact path/File: is missing; name a CSV file of displacements", input_file.string());
  for (const char* const name : {"Clumps/Diameter", "Mineral grains/Mean size", "Minerals/Table"})
    if (const std::string value = find_parameter(name)->write(input); value != none)
      throw InputError("{}: {} = {}: one contact of two grains has no use for it; leave it out", input_file.string(),
                       name, value);
  return input.specimen.dimension == 2 ? response<2>(input) : response<3>(input);
}

int run_contact(const CommonOptions& options)
{
  const Input input = read_input(options.input, {}, options.settings);
  const std::string table = contact_response(input, options.input);
  const OutputFolder folder(options.output, options.input, write_over(options, places_of_contacts, input));
  const FolderLock lock(folder.path());
  const FileList list(folder.path());
  write_whole_file(folder.path() / "contact.csv", table);
  if (!options.quiet)
    print_result("{}\n", (folder.path() / "contact.csv").string());
  return 0;
}
} // namespace feldspar
