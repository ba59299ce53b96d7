#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/run/output_folder.h"
#include "app/screen/print_result.h"
#include "base/csv.h"
#include "base/input_error.h"
#include "base/whole_file.h"
#include "dem/laws/flat_joint.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <vector>

/// `feldspar contact`: one joint along a displacement path, each row one update of the law.
namespace feldspar
{
namespace
{
constexpr double thickness = 1.0; // of a joint in the plane [m]

Face<double> make_face(const FlatJointParameters& joint, const ContactParameters& grains)
{
  const double normal_stiffness = stiffness_per_area(joint.modulus, grains.radius_1, grains.radius_2);
  return {normal_stiffness, normal_stiffness / joint.stiffness_ratio,
          face_half_length(joint.radius_multiplier, grains.radius_1, grains.radius_2), thickness, joint.friction};
}

/// The segments of the joint: all as strong as the mean, at rest at first.
template <int dim>
struct Segments
{
  Segments(const FlatJointParameters& joint, const std::size_t n)
    : strength{joint.bond_tensile_strength, joint.bond_cohesion, std::tan(joint.bond_friction_angle)}
    , updates(n)
  {
    for (auto& update : updates)
      update.state = {{}, true};
  }

  const flat_joint::Bond<double>& bond(unsigned int) const { return strength; }
  const flat_joint::SegmentState<dim, double>& state(const unsigned int i) const { return updates[i].state; }
  void set(const unsigned int i, const flat_joint::SegmentUpdate<dim, double>& update) { updates[i] = update; }

  flat_joint::Bond<double> strength;
  std::vector<flat_joint::SegmentUpdate<dim, double>> updates;
};

/// Columns of the path and of the answer.
template <int dim>
struct Columns;

template <>
struct Columns<2>
{
  static constexpr const char* path = "normal_m,shear_m,rotation_rad";
  static constexpr const char* resultants = "normal_force_N,shear_force_N,moment_Nm";
  static constexpr const char* segment = ",sigma_{0}_Pa,tau_{0}_Pa,bonded_{0}";
};

template <>
struct Columns<3>
{
  static constexpr const char* path = "normal_m,shear_1_m,shear_2_m,twist_rad,bend_1_rad,bend_2_rad";
  static constexpr const char* resultants =
    "normal_force_N,shear_force_1_N,shear_force_2_N,twist_moment_Nm,bend_moment_1_Nm,bend_moment_2_Nm";
  static constexpr const char* segment = ",sigma_{0}_Pa,tau_1_{0}_Pa,tau_2_{0}_Pa,bonded_{0}";
};

template <int dim>
std::string csv_header(const std::size_t n_segments)
{
  std::string header = Columns<dim>::resultants;
  for (std::size_t i = 1; i <= n_segments; ++i)
    header += fmt::format(fmt::runtime(Columns<dim>::segment), i);
  return header + '\n';
}

/// From one row of the path to the next; the contact plane stays where it is.
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

template <int dim>
std::string csv_row(const Face<double>& face, const std::vector<FaceElement<dim>>& elements,
                    const FaceResultants<dim, double>& sum, const Segments<dim>& segments)
{
  // Adding zero turns -0 into 0.
  std::string row = fmt::format("{}", sum.normal_force + 0.0);
  const auto append = [&row](const double value) { fmt::format_to(std::back_inserter(row), ",{}", value + 0.0); };
  for (const double force : sum.shear_force)
    append(force);
  for (const double moment : sum.moment)
    append(moment);
  for (std::size_t i = 0; i < elements.size(); ++i)
    {
      const auto& update = segments.updates[i];
      append(mean_stress(place_segment(face, elements[i]).segment, update.normal));
      for (const double tau : update.state.shear_stress)
        append(tau);
      fmt::format_to(std::back_inserter(row), ",{:d}", update.state.bonded);
    }
  return row + '\n';
}

/// What the joint answers to the path.
template <int dim>
std::string answer(const Input& input)
{
  const auto path = read_csv(input.contact.path_file, Columns<dim>::path);
  const Face<double> face = make_face(input.flat_joint, input.contact);
  const auto elements = face_elements<dim>(face_division<dim>(input.flat_joint));
  Segments<dim> segments(input.flat_joint, elements.size());
  std::string table = csv_header<dim>(elements.size());
  std::vector<double> before(dim + n_rotations<dim>, 0.0);
  for (const std::vector<double>& now : path)
    {
      const auto sum = update_face<dim>(face, elements, row_motion<dim>(before, now), segments);
      table += csv_row<dim>(face, elements, sum, segments);
      before = now;
    }
  return table;
}
} // namespace

int run_contact(const CommonOptions& options)
{
  const Input input = read_input(options.input, {}, options.settings);
  if (input.contact.path_file.empty())
    throw InputError(
      fmt::format("{}: Contact path/File: is missing; name a CSV file of displacements", options.input.string()));
  const std::string table = input.specimen.dimension == 2 ? answer<2>(input) : answer<3>(input);
  const OutputFolder folder(options.output, options.input, options.force);
  write_whole_file(folder.path() / "contact.csv", table);
  if (!options.quiet)
    print_result("{}\n", (folder.path() / "contact.csv").string());
  return 0;
}
} // namespace feldspar
