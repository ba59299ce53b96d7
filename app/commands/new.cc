#include "app/commands/commands.h"
#include "app/input/parameter_table.h"
#include "app/screen/print_result.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "results/quantities.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

/// `feldspar new`: an input to begin with, made from the table that reading and checking use, and a reference to fill in.
namespace feldspar
{
namespace
{
struct Template
{
  std::string_view name;
  std::string_view title;
  std::string_view command; ///< that takes the input
  Body body;
  std::vector<std::string_view> sections;              ///< whose basic entries are shown
  std::map<std::string_view, std::string_view> values; ///< of entries that differ from their defaults
};

const std::vector<Template>& templates()
{
  static const std::vector<Template> all{
    {"rock",
     "A rock in laboratory tests",
     "lab",
     Body::plane_box,
     {"Specimen", "Flat joint", "Tests", "Seeds", "Report"},
     {{"Specimen/Width", "15 mm"}, {"Specimen/Height", "30 mm"}}},
    {"study",
     "The effect of an entry on the strength",
     "lab",
     Body::plane_box,
     {"Specimen", "Variants", "Tests", "Seeds", "Report"},
     {{"Specimen/Width", "15 mm"},
      {"Specimen/Height", "30 mm"},
      {"Variants/Entry", "Flat joint/Bond cohesion"},
      {"Variants/Values", "200 MPa; 400 MPa"},
      {"Tests/List", "uniaxial_compression"},
      {"Seeds/Seeds", "1, 2"}}},
    {"sample",
     "A sample of finite elements with a representative volume of grains at every point",
     "multiscale",
     Body::sample,
     {"Specimen", "Flat joint", "Sample", "Tests", "Seeds", "Report"},
     {{"Specimen/Shape", "periodic"},
      {"Specimen/Width", "12 mm"},
      {"Specimen/Height", "12 mm"},
      {"Sample/Width", "12 mm"},
      {"Sample/Height", "24 mm"},
      {"Sample/Elements across", "1"},
      {"Sample/Elements along", "2"},
      {"Sample/Compression step", "1e-4"},
      {"Tests/List", "uniaxial_compression"}}}};
  return all;
}

/// The entry with its meaning as a comment; one that keeps its default is a comment too.
std::string entry_text(const Parameter& parameter, const std::string_view* const value)
{
  const std::string meaning = fmt::format("{}; allowed: {}", parameter.described(), parameter.range);
  return fmt::format("  # {}\n  {}set {} = {}\n", fmt::join(in_lines(meaning, 116, "  # "), "\n"), value ? "" : "# ",
                     parameter.entry, value ? std::string(*value) : parameter.default_text());
}

std::string input_text(const Template& wanted, const std::string& reference_file)
{
  auto values = wanted.values;
  values["Report/Reference file"] = reference_file;
  std::string text = fmt::format("# {}: feldspar {} {}.prm\n# Take the # away before `set` to change a default. All "
                                 "entries: feldspar parameters\n",
                                 wanted.title, wanted.command, wanted.name);
  for (const std::string_view section : wanted.sections)
    {
      text += fmt::format("\nsubsection {}\n", section);
      for (const Parameter& parameter : parameter_table())
        if (const auto& bodies = parameter.flags.bodies;
            parameter.section == section && parameter.flags.basic && (bodies.empty() || contains(bodies, wanted.body)))
          {
            const auto value = values.find(parameter.name());
            text += entry_text(parameter, value == values.end() ? nullptr : &value->second);
          }
      text += "end\n";
    }
  return text;
}

/// The values of the default rock, and every other property that one test gives, as null.
std::string reference_text()
{
  const std::map<std::string_view, std::string_view> known{
    {"tensile_strength_MPa", R"({"mean": 9.53, "min": 6.95, "max": 12.33})"},
    {"uniaxial_compressive_strength_MPa", R"({"mean": 161.47, "min": 160, "max": 170})"},
    {"youngs_modulus_GPa", "61.2"},
    {"poissons_ratio", "0.15"}};
  std::set<std::string_view> keys;
  std::string text = R"({
  "rock": "Beishan granite, the default rock",
  "note": "Replace rock and values by yours. tensile_strength_MPa is that of direct tension. A value is a number, or {mean, min, max}, or {mean, standard_deviation, n}; null: not measured.",
  "experiment": {
    "label": "laboratory")";
  for (const RockProperty& one : rock_properties)
    if (one.source != PropertySource::fit && keys.insert(one.key).second) // a choice of several figures
      {
        const auto value = known.find(one.key);
        text += fmt::format(",\n    \"{}\": {}", one.key, value == known.end() ? "null" : value->second);
      }
  return text + "\n  }\n}\n";
}
} // namespace

std::vector<std::string> names_of_templates() { return mapped<std::string>(templates(), &Template::name); }

int run_new(const NewOptions& options)
{
  const Template& wanted = *std::ranges::find(templates(), options.name, &Template::name);
  const std::filesystem::path folder = options.output.value_or("");
  const std::filesystem::path input = folder / (options.name + ".prm");
  const std::filesystem::path reference = folder / (options.name + "-reference.json");
  for (const auto& file : {input, reference})
    if (std::filesystem::exists(std::filesystem::symlink_status(file)))
      throw InputError("{}: is there already; name another folder by --output", file.string());
  if (!folder.empty())
    std::filesystem::create_directories(folder);
  write_whole_file(reference, reference_text());
  write_whole_file(input, input_text(wanted, reference.filename()));
  print_result("{} and {} are written. Next: feldspar {} {}\n", input.string(), reference.string(), wanted.command,
               input.string());
  return 0;
}
} // namespace feldspar
