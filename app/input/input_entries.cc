#include "app/input/input_entries.h"

#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "app/input/quantity.h"
#include "base/input_error.h"
#include "base/quoted.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <system_error>

namespace feldspar
{
namespace
{
constexpr std::string_view none = "none";
constexpr std::string_view free_component = "free";
constexpr std::size_t most_seeds = 10000;
constexpr std::size_t most_confinements = 1000;
constexpr std::size_t most_variants = 10000;

std::uint64_t parse_count(const std::string_view text)
{
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("{} is not a non-negative integer below 2^64", in_quotes(text)));
  return value;
}

std::vector<TestKind> read_tests(const std::string_view text)
{
  const std::vector<TestKind>& known = test_kinds();
  std::vector<TestKind> tests;
  for (const std::string_view piece : split_at_commas(text))
    {
      const auto kind = std::find_if(known.begin(), known.end(), [&](const TestKind& k) { return k.name == piece; });
      if (kind == known.end())
        throw InputError(fmt::format("{} is not a test; list one or more of {}", in_quotes(piece), names(known)));
      if (std::find(tests.begin(), tests.end(), *kind) != tests.end())
        throw InputError(fmt::format("{} is listed twice", piece));
      tests.push_back(*kind);
    }
  return tests;
}

std::vector<double> read_confinements(const std::string_view text)
{
  if (split_at_commas(text).size() > most_confinements)
    throw InputError(fmt::format("must be at most {} pressures", most_confinements));
  const std::vector<double> pressures = parse_quantities(text, stress);
  for (auto p = pressures.begin(); p != pressures.end(); ++p)
    {
      if (*p <= 0.0)
        throw InputError(
          fmt::format("must be > 0 MPa each; without confinement it is {}", uniaxial_compression.kind.name));
      if (std::find(pressures.begin(), p, *p) != p)
        throw InputError(fmt::format("{} is given twice", format_quantity(*p, "MPa", stress)));
    }
  return pressures;
}

std::string write_confinements(const std::vector<double>& pressures)
{
  std::string text;
  for (const double p : pressures)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", format_number(p / 1e6));
  return text + " MPa";
}

std::string read_variant_entry(const std::string_view text)
{
  if (text == none)
    return "";
  std::vector<std::string> names;      // of all that can vary
  std::vector<std::string> with_entry; // of these, with this entry
  for (const Parameter& parameter : parameter_table())
    if (parameter.name() == text && !parameter.flags.varies)
      throw InputError("is one for all variants; it cannot vary");
    else if (parameter.flags.varies)
      {
        names.push_back(parameter.name());
        if (parameter.entry == text)
          with_entry.push_back(parameter.name());
      }
  if (std::find(names.begin(), names.end(), text) != names.end())
    return std::string(text);
  if (!with_entry.empty())
    throw InputError(fmt::format("lacks its section; write Section/Entry: {}", fmt::join(with_entry, " or ")));
  const std::string nearest = suggestion(text, {names.begin(), names.end()});
  throw InputError("is not an entry that can vary; write Section/Entry" +
                   (nearest.starts_with("; there are") ? ", e.g. Flat joint/Segments" : nearest));
}

std::vector<std::string> read_variant_values(std::string_view text)
{
  std::vector<std::string> values;
  if (text == none)
    return values;
  for (;;)
    {
      const std::size_t semicolon = text.find(';');
      if (values.size() == most_variants)
        throw InputError(fmt::format("must be at most {} values", most_variants));
      values.emplace_back(trim(text.substr(0, semicolon)));
      if (semicolon == std::string_view::npos)
        return values;
      text.remove_prefix(semicolon + 1);
    }
}

std::vector<std::uint64_t> read_seeds(const std::string_view text)
{
  std::vector<std::uint64_t> seeds;
  for (const std::string_view piece : split_at_commas(text))
    {
      const std::size_t dots = piece.find("..");
      if (const std::size_t dash = piece.find('-'); dash != std::string_view::npos && dash > 0)
        throw InputError(fmt::format("{}: a range is written with two dots, {}..{}", in_quotes(piece),
                                     excerpt(trim(piece.substr(0, dash))), excerpt(trim(piece.substr(dash + 1)))));
      const std::uint64_t first = parse_count(piece.substr(0, dots));
      const std::uint64_t last = dots == std::string_view::npos ? first : parse_count(piece.substr(dots + 2));
      if (last < first)
        throw InputError(fmt::format("the range {} runs backwards", excerpt(piece)));
      if (last - first >= most_seeds - seeds.size())
        throw InputError(fmt::format("must be at most {} seeds", most_seeds));
      for (std::uint64_t i = 0; i <= last - first; ++i)
        seeds.push_back(first + i);
    }
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : seeds)
    if (!seen.insert(seed).second)
      throw InputError(fmt::format("seed {} is given twice", seed));
  return seeds;
}

std::vector<std::optional<double>> read_direction(const std::string_view text)
{
  std::vector<std::optional<double>> direction;
  if (text == none)
    return direction;
  for (const std::string_view piece : split_at_commas(text))
    direction.push_back(piece == free_component ? std::nullopt : std::optional(parse_number(piece)));
  if (direction.size() != 3 && direction.size() != 6)
    throw InputError(fmt::format("{} component(s); there must be 3: xx, yy, xy; in three dimensions 6: xx, yy, zz, yz, "
                                 "xz, xy",
                                 direction.size()));
  if (std::none_of(direction.begin(), direction.end(), [](const auto& entry) { return entry.value_or(0.0) != 0.0; }))
    throw InputError("at least one component must be a number other than 0");
  return direction;
}

std::string write_direction(const std::vector<std::optional<double>>& direction)
{
  std::string text;
  for (const auto& component : direction)
    text += (text.empty() ? "" : ", ") + (component ? format_number(*component) : std::string(free_component));
  return text.empty() ? std::string(none) : text;
}

} // namespace

Entry<Input> test_list_entry()
{
  return {"List",
          Entry<Input>::Text{"", names(test_kinds()),
                             [](Input& input, const std::string_view text) { input.test_list = read_tests(text); },
                             [](const Input& input) { return names(input.test_list); }},
          "the tests to be made, separated by commas",
          {}};
}

Entry<Input> confinements_entry()
{
  return {
    "Confinements",
    Entry<Input>::Text{"MPa", "> 0 MPa each",
                       [](Input& input, const std::string_view text) { input.confinements = read_confinements(text); },
                       [](const Input& input) { return write_confinements(input.confinements); }},
    "pressures of the triaxial tests, normal stresses of direct shear, separated by commas",
    {}};
}

Entry<Input> checkpoint_entry()
{
  return {"Steps between checkpoints",
          Entry<Input>::Text{"", "integer > 0",
                             [](Input& input, const std::string_view text) {
                               input.steps_between_checkpoints = parse_count(text);
                               if (input.steps_between_checkpoints == 0)
                                 throw InputError("must be an integer > 0");
                             },
                             [](const Input& input) { return std::to_string(input.steps_between_checkpoints); }},
          "after which `lab --resume` can take up a test",
          {}};
}

std::vector<Entry<Input>> variant_entries()
{
  return {{"Entry",
           Entry<Input>::Text{
             "", "none, or Section/Entry",
             [](Input& input, const std::string_view text) { input.variant_entry = read_variant_entry(text); },
             [](const Input& input) { return input.variant_entry.empty() ? std::string(none) : input.variant_entry; }},
           "an entry that takes one value after the other",
           {}},
          {"Values",
           Entry<Input>::Text{
             "", "none, or values of that entry",
             [](Input& input, const std::string_view text) { input.variant_values = read_variant_values(text); },
             [](const Input& input) {
               return input.variant_values.empty() ? std::string(none)
                                                   : fmt::format("{}", fmt::join(input.variant_values, "; "));
             }},
           "each of them, separated by semicolons",
           {}}};
}

Entry<Input> seeds_entry()
{
  return {"Seeds",
          Entry<Input>::Text{"", "non-negative integers and ranges, such as 1, 5..7",
                             [](Input& input, const std::string_view text) { input.seeds = read_seeds(text); },
                             [](const Input& input) { return fmt::format("{}", fmt::join(input.seeds, ", ")); }},
          "one specimen for each seed",
          {}};
}

std::vector<Entry<ContactParameters>> contact_entries()
{
  using P = ContactParameters;
  return {entry::quantity("Radius 1", &P::radius_1, Measure::length, "mm", ranges::above_zero,
                          "of grain 1 of `feldspar contact`"),
          entry::quantity("Radius 2", &P::radius_2, Measure::length, "mm", ranges::above_zero,
                          "of grain 2 of `feldspar contact`")};
}

Entry<ContactParameters> contact_path_entry()
{
  return entry::file("File", &ContactParameters::path_file,
                     "displacements since rest, a CSV with the columns normal_m,shear_m,rotation_rad; in three "
                     "dimensions normal_m,shear_1_m,shear_2_m,twist_rad,bend_1_rad,bend_2_rad");
}

std::vector<Entry<StrainPathParameters>> strain_path_entries()
{
  using P = StrainPathParameters;
  const EntryFlags varies{.varies = true};
  return {entry::file("File", &P::path_file,
                      "points of the path of `feldspar rve`, a CSV with a column for each of xx,yy,xy (in three "
                      "dimensions xx,yy,zz,yz,xz,xy): strain_xx (tensor shear) or stress_xx_Pa, tension positive; "
                      "straight ways between; instead of Direction"),
          {"Direction",
           Entry<P>::Text{"", "none, or a number or free for each of xx, yy, xy (or xx, yy, zz, yz, xz, xy)",
                          [](P& path, const std::string_view text) { path.direction = read_direction(text); },
                          [](const P& path) { return write_direction(path.direction); }},
           "of the strain (tensor shear, tension positive); a free component stays at the stress of the confinement",
           varies},
          entry::number("Size", &P::size, {'(', 0.0, largest_strain, ']'}, "of the strain at the end, over Direction",
                        varies),
          entry::quantity("Confining pressure", &P::confining_pressure, Measure::stress, "MPa", ranges::from_zero,
                          "compression positive, on all sides before the strain begins; strains of Direction count "
                          "from there",
                          varies),
          entry::number("Largest step", &P::largest_step, {'(', 0.0, largest_strain, ']'},
                        "of any component of the strain in one increment", varies),
          entry::choice("Solver", &P::solver,
                        {{"event by event", PathSolver::event_by_event}, {"explicit", PathSolver::explicit_dynamics}},
                        "from break to break without a rate, or explicit dynamics as in the laboratory", varies),
          entry::integer("Steps per millistrain", &P::steps_per_millistrain, {'[', 1.0, 1e8, ']'},
                         "of explicit dynamics, for 1e-3 of the largest component of the strain", varies)};
}

Entry<Input> reference_entry()
{
  return entry::file("Reference file", &Input::reference_file,
                     "figures of the rock and of other models (JSON) to set the results beside");
}
} // namespace feldspar
