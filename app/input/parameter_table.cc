#include "app/input/parameter_table.h"

#include "app/input/entry_parameter.h"
#include "app/input/input_entries.h"
#include "app/input/joint_sections.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/parameter_id.h"
#include "calibration/entries.h"
#include "coupling/rve/entries.h"
#include "coupling/sample/sample_entries.h"
#include "dem/dynamics/entries.h"
#include "dem/flaws/entries.h"
#include "dem/lab/emission_entries.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/laws/entries.h"
#include "dem/laws/joint_laws.h"
#include "dem/specimen/entries.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

namespace feldspar
{
namespace
{
std::vector<Parameter> make_parameter_table()
{
  std::vector<Parameter> table;
  const auto add_own = [&](const std::string& section, const std::vector<Entry<Input>>& entries) {
    for (const Entry<Input>& one : entries)
      table.push_back(parameter_of(section, one));
  };
  const auto add = [&]<typename P>(const std::string& section, const auto part, const std::vector<Entry<P>>& entries) {
    for (const Entry<P>& one : entries)
      add_own(section, {within<Input>(
                         one, [part](const Input& input) -> const P& { return std::invoke(part, input); },
                         [part](Input& input) -> P& { return std::invoke(part, input); })});
  };
  add("Specimen", &Input::specimen, specimen_entries());
  add("Specimen", &Input::specimen, sieve_curve_entries());
  const JointLaws::AllParameters joints;
  JointLaws::for_each(joints, [&]<typename P>(const std::string_view law, const P& parameters) {
    add(
      section_of(law), [](auto& input) -> auto& { return std::get<P>(input.joints); }, joint_entries(parameters));
  });
  add("Particle contact", &Input::particle_contact, particle_contact_entries());
  add("Smooth joint", &Input::smooth_joint, smooth_joint_entries());
  add_own("Minerals", mineral_file_entries());
  add("Minerals", &Input::minerals, mineral_entries());
  add("Mineral grains", &Input::mineral_grains, mineral_grain_entries());
  add("Clumps", &Input::clumps, clump_entries());
  add_own("Flaws", flaw_entries());
  add(
    "Flaws", [](auto& input) -> auto& { return input.flaws.map; }, map_entries());
  add("Dynamics", &Input::dynamics, dynamics_entries());
  add_own("Tests", test_list_entries());
  add("Tests", &Input::tests, test_entries());
  add("Tests", &Input::tests, tests_text_entries());
  add_own("Tests", progress_entries());
  add("Emission", &Input::tests, emission_entries());
  add("Variants", &Input::variants, variant_entries());
  add_own("Seeds", seeds_entries());
  add("Contact", &Input::contact, contact_entries());
  add("Contact path", &Input::contact, contact_path_entries());
  add("Strain path", &Input::strain_path, strain_path_entries());
  add("Representative volume", &Input::equilibrium, equilibrium_entries());
  add("Representative volume", &Input::boundary, boundary_entries());
  add("Sample", &Input::sample, sample_entries());
  add("Sample", &Input::sample, mesh_names_entries());
  add("Continuum", &Input::continuum, continuum_entries());
  add("Calibration", &Input::calibration, calibration_list_entries());
  add("Calibration", &Input::calibration, calibration_entries());
  add("Report", &Input::report_labels, label_entries());
  add_own("Report", report_entries());
  return table;
}

/// Parameters that no entry fills by itself: texts of a form of their own, and what libraries make of an entry.
std::vector<std::pair<ParameterId, InputPlace>> further_places()
{
  return {{parameters_id<TestKind>(), {"Tests", "List"}},
          {parameter_id<&TestCase::confining_pressure>(), {"Tests", "Confinements"}},
          {parameters_id<FlawParameters>(), {"Flaws", ""}}};
}

std::string command_of(const Work work)
{
  constexpr const char* commands[] = {"specimen", "rve", "multiscale", "multiscale --extract"}; // by their enumerators
  return fmt::format("`feldspar {}`", commands[std::size_t(work)]);
}

// Whoever can read an input is told of its parameters by section and entry.
[[maybe_unused]] const bool speaks_of_entries = (use_words_of_input({place_of, command_of}), true);
} // namespace

std::string or_none(std::string text) { return text.empty() ? std::string(none) : text; }

InputPlace place_of(const ParameterId& id)
{
  for (const auto& [known, place] : further_places())
    if (known == id)
      return place;
  for (const Parameter& parameter : parameter_table())
    if (parameter.id && parameter.id->owner == id.owner && (!id.place || parameter.id->place == id.place))
      return {std::string(parameter.section), id.place ? std::string(parameter.entry) : ""};
  return {"", std::string(id.name)};
}

std::string Parameter::name() const { return fmt::format("{}/{}", section, entry); }

std::string Parameter::default_text() const
{
  static const Input defaults;
  return write(defaults);
}

std::string Parameter::described() const
{
  std::string text(meaning);
  for (std::size_t k = 0; k < flags.demands.size(); ++k)
    if (const Demand& one = flags.demands[k]; // of several on one entry the last is the strictest
        !contains(std::span(flags.demands).subspan(k + 1), one.other, &Demand::other))
      text += fmt::format("; {}{}{} {}{}{}", one.of_value, one.of_value.empty() ? "" : " ",
                          one.allowed.empty() ? "excludes" : "needs", one.other, one.allowed.empty() ? "" : " = ",
                          fmt::join(one.allowed, " or "));
  return text;
}

const std::vector<Parameter>& parameter_table()
{
  static const std::vector<Parameter> table = make_parameter_table();
  return table;
}

std::vector<std::string_view> section_names()
{
  std::vector<std::string_view> names;
  for (const Parameter& parameter : parameter_table())
    if (names.empty() || names.back() != parameter.section)
      names.push_back(parameter.section);
  return names;
}

std::vector<std::string_view> entry_names(const std::string_view section)
{
  std::vector<std::string_view> names;
  for (const Parameter& parameter : parameter_table())
    if (parameter.section == section)
      names.push_back(parameter.entry);
  return names;
}

const Parameter* find_parameter(const std::string_view name)
{
  const std::size_t slash = std::min(name.find('/'), name.size());
  const std::string_view section = name.substr(0, slash), entry = name.substr(std::min(slash + 1, name.size()));
  for (const Parameter& parameter : parameter_table())
    if (parameter.section == section && parameter.entry == entry)
      return &parameter;
  return nullptr;
}

const Demand* unmet_demand(const Input& input, const Parameter& parameter)
{
  const auto& demands = parameter.flags.demands;
  const std::string value = demands.empty() ? "" : parameter.write(input);
  const auto unmet = std::ranges::find_if(demands, [&](const Demand& demand) {
    if (demand.of_value.empty() ? value == parameter.default_text() : value != demand.of_value)
      return false;
    const Parameter& other = *find_parameter(demand.other);
    const std::string found = other.write(input);
    return demand.allowed.empty() ? found != other.default_text() : !contains(demand.allowed, found);
  });
  return unmet == demands.end() ? nullptr : &*unmet;
}

bool has_smooth_joints(const Input& input)
{
  const auto shapes = input.flaws.all();
  return input.mineral_grains.mean_size || input.minerals.form_of_rock() == MineralGrainForm::smooth_boundaries ||
         std::ranges::any_of(shapes, [](const Shape& shape) { return smooth_sides(shape) != nullptr; });
}

bool has_use_for(const Input& input, const Parameter& parameter)
{
  if (parameter.section == "Smooth joint" && !has_smooth_joints(input))
    return false;
  if (parameter.section == "Clumps" && parameter.entry == "Form" && !input.clumps.diameter)
    return false;
  if (parameter.section == "Minerals" && parameter.entry != "Table" && input.minerals.minerals.empty())
    return false;
  const bool is_of_slices = parameter.entry == "Slices" || parameter.entry == "Slice distance";
  if (parameter.section == "Minerals" && (parameter.entry == "Pixel size" || is_of_slices) &&
      (!input.minerals.has_picture() || (is_of_slices && input.specimen.dimension != 3)))
    return false;
  const auto laws = JointLaws::names();
  return std::ranges::none_of(laws, [&](const std::string_view law) {
    return parameter.section == section_of(law) && law != input.specimen.joint_law;
  });
}

std::vector<std::string> sentences_on(const std::vector<Variant>& variants,
                                      std::string (*const sentence_on)(const Input&, const Parameter&))
{
  std::vector<std::string> sentences;
  for (const Variant& variant : variants)
    for (const Parameter& parameter : parameter_table())
      if (const std::string one = sentence_on(variant.input, parameter); !one.empty() && !contains(sentences, one))
        sentences.push_back(one);
  return sentences;
}

void check_body(const Input& input, const Body body)
{
  for (const Parameter& parameter : parameter_table())
    if (const auto& bodies = parameter.flags.bodies; !bodies.empty() && !contains(bodies, body))
      if (const std::string value = parameter.write(input); value != parameter.default_text())
        throw InputError("{} = {}: {}{}", parameter.name(), value, parameter.flags.needs,
                         body == Body::sample ? "; a sample of finite elements has no use for it" : "");
}
} // namespace feldspar
