#include "app/input/input.h"

#include "app/input/input_structure.h"
#include "app/input/parameter_table.h"
#include "app/input/quantity.h"
#include "base/input_error.h"

#include <deal.II/base/parameter_handler.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace feldspar
{
namespace
{
/// A file of lines in UTF-8, without the mark some editors put before the first.
std::string read_text(const std::filesystem::path& file)
{
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(fmt::format("{}: is a folder; an input file is needed", file.string()));
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::generic_category().message(errno)));
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (text.starts_with("\xEF\xBB\xBF"))
    text.erase(0, 3);

  const auto is_binary = [](const unsigned char c) { return c < 0x20 && (c < '\t' || c > '\r'); };
  if (std::any_of(text.begin(), text.end(), is_binary))
    throw InputError(fmt::format("{}: is not a text file", file.string()));
  try
    {
      static_cast<void>(nlohmann::json(text).dump()); // which checks the encoding
    }
  catch (const nlohmann::json::type_error&)
    {
      throw InputError(fmt::format("{}: is not encoded in UTF-8", file.string()));
    }
  return text;
}

/// What the file gives: entries with their places, and deal.II's reading of their values.
class GivenValues
{
public:
  GivenValues(const std::filesystem::path& file, const std::string& text)
    : name(file.string())
  {
    for (const Parameter& parameter : parameter_table())
      {
        handler.enter_subsection(std::string(parameter.section));
        handler.declare_entry(std::string(parameter.entry), parameter.default_text());
        handler.leave_subsection();
      }
    try
      {
        if (file.extension() == ".json")
          {
            const JsonInput json = scan_json(name, text);
            given = json.entries;
            std::istringstream stream(json.normal_text);
            handler.parse_input_from_json(stream);
          }
        else
          {
            given = scan_prm(name, text);
            handler.parse_input_from_string(text);
          }
      }
    catch (const dealii::ExceptionBase& error)
      {
        // The scan let pass what deal.II does not: the reason in one line at least.
        throw InputError(fmt::format("{}: cannot be read ({})", name, error.get_exc_name()));
      }
  }

  const std::vector<GivenEntry>& entries() const { return given; }

  bool has(const std::string_view section, const std::string_view entry) const
  {
    return find(section, entry) != nullptr;
  }

  std::string value(const std::string_view section, const std::string_view entry) const
  {
    return handler.get({std::string(section)}, std::string(entry));
  }

  /// An error about an entry: `beishan.prm:12: Flat joint/Bond friction angle = 95 deg: ` and the text.
  InputError error(const std::string_view section, const std::string_view entry, const std::string_view text) const
  {
    const GivenEntry* where = find(section, entry);
    return InputError(
      fmt::format("{}: {}/{} = {}: {}", where ? where->place : name, section, entry, value(section, entry), text));
  }

private:
  const GivenEntry* find(const std::string_view section, const std::string_view entry) const
  {
    const auto found = std::find_if(given.begin(), given.end(), [&](const GivenEntry& candidate) {
      return candidate.section == section && candidate.entry == entry;
    });
    return found == given.end() ? nullptr : &*found;
  }

  const std::string name;
  std::vector<GivenEntry> given;
  dealii::ParameterHandler handler;
};

/// What an entry that is not given means in three dimensions.
void settle_dimension(Input& input, const GivenValues& values)
{
  if (input.specimen.dimension == 2)
    return;
  if (!values.has("Specimen", "Porosity"))
    input.specimen.porosity = 0.36;
  if (!values.has("Flat joint", "Coordination number") && !values.has("Flat joint", "Installation gap ratio"))
    input.flat_joint.installation_gap_ratio = 0.05;
}

/// The gap that gets a joint follows from exactly one of two entries; naming the one takes the other's default away.
void settle_installation(Input& input, const GivenValues& values)
{
  FlatJointParameters& joint = input.flat_joint;
  if (joint.installation_gap_ratio && !values.has("Flat joint", "Coordination number"))
    joint.coordination_number.reset();
  if (joint.installation_gap_ratio && joint.coordination_number)
    throw values.error("Flat joint", "Installation gap ratio",
                       "excludes Coordination number, which is given too; keep one of them");
  if (!joint.installation_gap_ratio && !joint.coordination_number)
    throw values.error("Flat joint", "Coordination number", "is needed when Installation gap ratio is none");
}

void check_fractions(const Input& input, const GivenValues& values)
{
  if (input.flat_joint.gapped_fraction + input.flat_joint.slit_fraction > 1.0)
    throw values.error("Flat joint", "Slit fraction",
                       fmt::format("must be at most 1 together with Gapped fraction = {}",
                                   values.value("Flat joint", "Gapped fraction")));
}

void check_variants(const Input& input, const GivenValues& values)
{
  if (input.variant_entry.empty() != input.variant_values.empty())
    throw values.error("Variants", input.variant_entry.empty() ? "Entry" : "Values",
                       "Entry and Values go together: name both, or neither");
  try
    {
      variants(input);
    }
  catch (const InputError& error)
    {
      throw values.error("Variants", "Values", error.what());
    }
}

void check_specimen(const Input& input, const GivenValues& values)
{
  const SpecimenParameters& specimen = input.specimen;
  if (specimen.shape == "cylinder" && specimen.dimension != 3)
    throw values.error("Specimen", "Shape", "needs Dimension = 3");
  if (!specimen.packing_file.empty() && !specimen.specimen_file.empty())
    throw values.error("Specimen", "Specimen file", "excludes Packing file, which is given too; keep one of them");
  if (!specimen.packing_file.empty() || !specimen.specimen_file.empty())
    {
      if (!specimen.specimen_file.empty() && (input.seeds.size() > 1 || !input.variant_entry.empty()))
        throw values.error("Specimen", "Specimen file", "is one specimen; it goes with one seed and no variants");
      return; // files bring their own radii
    }
  // Also catches a slip of the unit before it fills the memory.
  constexpr double most_grains = 1e7;
  const double mean_radius = 0.5 * specimen.minimum_radius * (1.0 + specimen.radius_ratio);
  const double volume = specimen.dimension == 2
                          ? specimen.width * specimen.height / (mean_radius * mean_radius)
                          : specimen.width * specimen.width * specimen.height / std::pow(mean_radius, 3);
  if (const double n_grains = volume / 4.0; n_grains > most_grains)
    throw values.error("Specimen", "Minimum radius",
                       fmt::format("gives some {:.0e} grains; more than {:.0e} are not packed", n_grains, most_grains));
  const double least = 4.0 * specimen.minimum_radius * specimen.radius_ratio;
  const std::string demand =
    fmt::format("must be at least {}, or there is no room for two grains of the largest radius",
                format_quantity(least, "mm", length));
  if (specimen.width < least)
    throw values.error("Specimen", "Width", demand);
  if (specimen.height < least)
    throw values.error("Specimen", "Height", demand);
}

void check_strain_path(const Input& input, const GivenValues& values)
{
  const std::size_t n = input.strain_path.direction.size();
  if (n != 0 && n != (input.specimen.dimension == 2 ? 3u : 6u))
    throw values.error("Strain path", "Direction",
                       fmt::format("has {} components; in {} dimensions there must be {}", n, input.specimen.dimension,
                                   input.specimen.dimension == 2 ? "3: xx, yy, xy" : "6: xx, yy, zz, yz, xz, xy"));
}
} // namespace

std::vector<Variant> variants(const Input& input)
{
  if (input.variant_entry.empty())
    return {{"", input}};
  const std::size_t slash = input.variant_entry.find('/');
  const Parameter& parameter =
    *find_parameter(input.variant_entry.substr(0, slash), input.variant_entry.substr(slash + 1));
  std::vector<Variant> result;
  for (const std::string& value : input.variant_values)
    {
      result.push_back({fmt::format("{} = {}", input.variant_entry, value), input});
      Input& varied = result.back().input;
      parameter.read(varied, value);
      // Of the two ways to say which pairs get a joint the varied one holds.
      if (parameter.entry == "Coordination number")
        varied.flat_joint.installation_gap_ratio.reset();
      if (parameter.entry == "Installation gap ratio")
        varied.flat_joint.coordination_number.reset();
    }
  return result;
}

Input read_input(const std::filesystem::path& file, const std::filesystem::path& folder)
{
  const std::string text = read_text(file);
  if (file.extension() != ".prm" && file.extension() != ".json")
    throw InputError(fmt::format("{}: the name must end in .prm or .json", file.string()));
  const GivenValues values(file, text);

  Input input;
  input.folder = folder.empty() ? file.parent_path() : folder;
  for (const GivenEntry& given : values.entries())
    try
      {
        find_parameter(given.section, given.entry)->read(input, values.value(given.section, given.entry));
      }
    catch (const InputError& error)
      {
        throw values.error(given.section, given.entry, error.what());
      }
  settle_dimension(input, values);
  settle_installation(input, values);
  check_variants(input, values);
  for (const Variant& variant : variants(input))
    {
      check_fractions(variant.input, values);
      check_specimen(variant.input, values);
      check_strain_path(variant.input, values);
    }
  return input;
}
} // namespace feldspar
