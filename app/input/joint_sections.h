#pragma once

#include "app/input/input.h"
#include "dem/laws/joint_laws.h"
#include "dem/rock/rock.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace feldspar
{
/// The section of the input that holds a law's entries: the name of the law with a capital letter.
inline std::string section_of(const std::string_view law_name)
{
  std::string section(law_name);
  section.front() = char(section.front() - 'a' + 'A');
  return section;
}

/// The parameters of the joint law that the input names.
inline JointParameters joint_parameters(const Input& input)
{
  std::optional<JointParameters> parameters;
  JointLaws::for_each(input.joints, [&](const std::string_view law, const auto& of_law) {
    if (law == input.specimen.joint_law)
      parameters = of_law;
  });
  if (!parameters)
    throw std::logic_error("a joint law without a section of its own");
  return *parameters;
}

/// The rock that the input asks for.
inline RockParameters rock_of(const Input& input)
{
  return {input.specimen,    joint_parameters(input), input.particle_contact, input.minerals,
          input.flaws.all(), input.smooth_joint,      input.mineral_grains,   input.clumps};
}
} // namespace feldspar
