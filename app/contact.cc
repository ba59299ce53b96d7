#include "app/commands.h"
#include "app/csv.h"
#include "app/input.h"
#include "app/output_folder.h"
#include "dem/input_error.h"
#include "dem/joint_update.h"
#include "report/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

/// `feldspar contact`: one joint along a displacement path, each row one update of the law.
namespace feldspar
{
namespace
{
constexpr double thickness = 1.0; // [m]

flat_joint::Face<double> make_face(const FlatJointParameters& joint, const ContactParameters& grains)
{
  const double normal_stiffness = joint.modulus / (grains.radius_1 + grains.radius_2);
  const double half_length = joint.radius_multiplier * std::min(grains.radius_1, grains.radius_2); // (12)
  return {normal_stiffness, normal_stiffness / joint.stiffness_ratio, 2.0 * half_length / joint.n_segments, thickness,
          joint.friction};
}

/// The segments of the joint: all as strong as the mean, at rest at first.
struct Segments
{
  explicit Segments(const FlatJointParameters& joint)
    : strength{joint.bond_tensile_strength, joint.bond_cohesion, std::tan(joint.bond_friction_angle)}
    , updates(joint.n_segments)
  {
    for (auto& update : updates)
      update.state = {{0.0}, true};
  }

  const flat_joint::Bond<double>& bond(unsigned int) const { return strength; }
  const flat_joint::SegmentState<2, double>& state(const unsigned int i) const { return updates[i].state; }
  void set(const unsigned int i, const flat_joint::SegmentUpdate<2, double>& update) { updates[i] = update; }

  flat_joint::Bond<double> strength;
  std::vector<flat_joint::SegmentUpdate<2, double>> updates;
};

std::string csv_header(const unsigned int n_segments)
{
  std::string header = "normal_force_N,shear_force_N,moment_Nm";
  for (unsigned int i = 1; i <= n_segments; ++i)
    header += fmt::format(",sigma_{0}_Pa,tau_{0}_Pa,bonded_{0}", i);
  return header + '\n';
}

std::string csv_row(const flat_joint::Face<double>& face, const FaceResultants<2, double>& sum,
                    const Segments& segments)
{
  // Adding zero turns -0 into 0.
  std::string row = fmt::format("{},{},{}", sum.normal_force + 0.0, sum.shear_force[0] + 0.0, sum.moment + 0.0);
  for (const auto& segment : segments.updates)
    fmt::format_to(std::back_inserter(row), ",{},{},{:d}", mean_stress(face, segment.normal) + 0.0,
                   segment.state.shear_stress[0] + 0.0, segment.state.bonded);
  return row + '\n';
}
} // namespace

int run_contact(const CommonOptions& options)
{
  const Input input = read_input(options.input);
  if (input.contact.path_file.empty())
    throw InputError(
      fmt::format("{}: Contact path/File: is missing; name a CSV file of displacements", options.input.string()));
  const auto path = read_csv(input.contact.path_file, "normal_m,shear_m,rotation_rad");
  const OutputFolder folder(options.output, options.input, options.force);

  const flat_joint::Face<double> face = make_face(input.flat_joint, input.contact);
  Segments segments(input.flat_joint);
  std::string table = csv_header(input.flat_joint.n_segments);
  std::vector<double> before{0.0, 0.0, 0.0};
  for (const std::vector<double>& now : path)
    {
      const FaceMotion<2, double> motion{.opening_before = before[0],
                                         .opening = now[0],
                                         .slope_before = before[2],
                                         .slope = now[2],
                                         .shear_increment = {now[1] - before[1]}};
      table += csv_row(face, update_face(face, input.flat_joint.n_segments, motion, segments), segments);
      before = now;
    }
  write_text_file(folder.path() / "contact.csv", table);
  if (!options.quiet)
    fmt::print("{}\n", (folder.path() / "contact.csv").string());
  return 0;
}
} // namespace feldspar
