#include "app/calibration/calibrated_input.h"

#include "app/input/parameter_table.h"
#include "base/text.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string>
#include <string_view>

namespace feldspar::calibration
{
namespace
{
constexpr std::array<std::string_view, 8> sections_of_laboratory{
  "Specimen", "Flat joint", "Particle contact", "Minerals", "Dynamics", "Tests", "Seeds", "Report"};

constexpr double degree = std::numbers::pi / 180.0;

/// Value as it will be written: the round-off of products and logarithms would show in files.
double without_round_off(const double value) { return parse_number(fmt::format("{:.11e}", value)); }

/// b by which a ratio a : b is kept where a becomes another.
double kept(const double a, const double b, const double new_a)
{
  return a > 0.0 ? without_round_off(b * new_a / a) : b;
}

/// Rounds a value to four figures of its unit.
double to_figures(const double value, const double unit)
{
  return parse_number(fmt::format("{:.3e}", value / unit)) * unit;
}
} // namespace

MicroParameters micro_parameters(const Input& input)
{
  const FlatJointParameters& joint = std::get<FlatJointParameters>(input.joints);
  return {joint.modulus,
          joint.bond_tensile_strength,
          joint.stiffness_ratio,
          joint.bond_cohesion / joint.bond_tensile_strength,
          joint.bond_friction_angle,
          joint.friction,
          joint.installation_gap_ratio,
          input.minerals.boundary_strength};
}

Input with_parameters(const Input& input, const MicroParameters& parameters)
{
  Input result = input;
  FlatJointParameters& joint = std::get<FlatJointParameters>(result.joints);
  const FlatJointParameters& before = std::get<FlatJointParameters>(input.joints);
  ParticleContactParameters& contact = result.particle_contact;
  joint.modulus = without_round_off(parameters.modulus);
  joint.stiffness_ratio = without_round_off(parameters.stiffness_ratio);
  joint.friction = without_round_off(parameters.friction);
  contact.modulus = kept(before.modulus, contact.modulus, joint.modulus);
  contact.stiffness_ratio = kept(before.stiffness_ratio, contact.stiffness_ratio, joint.stiffness_ratio);
  contact.friction = kept(before.friction, contact.friction, joint.friction);
  joint.bond_tensile_strength = without_round_off(parameters.bond_tensile_strength);
  joint.bond_tensile_strength_deviation =
    kept(before.bond_tensile_strength, before.bond_tensile_strength_deviation, joint.bond_tensile_strength);
  joint.bond_cohesion = without_round_off(parameters.cohesion_ratio * parameters.bond_tensile_strength);
  joint.bond_cohesion_deviation = kept(before.bond_cohesion, before.bond_cohesion_deviation, joint.bond_cohesion);
  joint.bond_friction_angle = without_round_off(parameters.bond_friction_angle / degree) * degree;
  for (std::string* const file : {&result.minerals.table, &result.minerals.boundaries_file}) // read from another folder
    if (!file->empty())
      *file = std::filesystem::canonical(*file).string();
  result.minerals.boundary_strength = without_round_off(parameters.boundary_strength);
  if (parameters.gap)
    {
      joint.installation_gap_ratio = without_round_off(*parameters.gap);
      joint.coordination_number.reset();
    }
  return result;
}

std::string as_prm(const Input& input, const std::string& comment)
{
  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);)
    text += line.empty() ? "#\n" : "# " + line + "\n";
  for (const std::string_view section : sections_of_laboratory)
    {
      if (section == "Minerals" && input.minerals.minerals.empty())
        continue;
      fmt::format_to(std::back_inserter(text), "\nsubsection {}\n", section);
      for (const Parameter& parameter : parameter_table())
        if (parameter.section == section && has_use_for(input, parameter))
          // The defaults of entries that only other bodies have are left out with them.
          if (const std::string value = parameter.write(input);
              parameter.flags.bodies.empty() || value != parameter.default_text())
            fmt::format_to(std::back_inserter(text), "  set {} = {}\n", parameter.entry, value);
      text += "end\n";
    }
  return text;
}

MicroParameters rounded(const MicroParameters& parameters)
{
  MicroParameters result = parameters;
  result.modulus = to_figures(parameters.modulus, 1e9);
  result.bond_tensile_strength = to_figures(parameters.bond_tensile_strength, 1e6);
  result.stiffness_ratio = to_figures(parameters.stiffness_ratio, 1.0);
  result.cohesion_ratio =
    to_figures(parameters.cohesion_ratio * parameters.bond_tensile_strength, 1e6) / result.bond_tensile_strength;
  result.bond_friction_angle = to_figures(parameters.bond_friction_angle, degree);
  result.friction = to_figures(parameters.friction, 1.0);
  result.boundary_strength = to_figures(parameters.boundary_strength, 1.0);
  if (parameters.gap)
    result.gap = to_figures(*parameters.gap, 1.0);
  return result;
}
} // namespace feldspar::calibration
