#include "app/input/input_entries.h"

#include "app/input/nearest_name.h"
#include "app/input/parameter_table.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/table/quantity.h"
#include "base/text.h"
#include "laboratory/own_entries.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace feldspar
{
namespace
{
constexpr std::string_view free_component = "free";
constexpr std::size_t most_seeds = 10000;
constexpr std::size_t most_confinements = 1000;

std::uint64_t parse_count(const std::string_view text)
{
  if (const auto value = number_in<std::uint64_t>(text))
    return *value;
  throw InputError("{} is not a non-negative integer below 2^64", in_quotes(text));
}

std::vector<TestKind> read_tests(const std::string_view text)
{
  const std::vector<TestKind>& known = test_kinds();
  std::vector<TestKind> tests;
  for (const std::string_view piece : split_at_commas(text))
    {
      const auto kind = std::ranges::find(known, piece, &TestKind::name);
      if (kind == known.end())
        {
          const auto known_names = mapped<std::string_view>(known, &TestKind::name);
          throw InputError("{} is not a test; list one or more of {}{}", in_quotes(piece), names(known),
                           nearest_name(piece, known_names));
        }
      if (contains(tests, *kind))
        throw InputError("{} is listed twice", piece);
      tests.push_back(*kind);
    }
  return tests;
}

std::vector<double> read_confinements(const std::string_view text)
{
  const std::vector<double> pressures = parse_quantities(text, stress);
  if (pressures.size() > most_confinements)
    throw InputError("must be at most {} pressures", most_confinements);
  for (auto p = pressures.begin(); p != pressures.end(); ++p)
    {
      if (*p <= 0.0)
        throw InputError("must be > 0 MPa each; without confinement it is {}", uniaxial_compression.kind.name);
      if (std::find(pressures.begin(), p, *p) != p)
        throw InputError("{} is given twice", format_quantity(*p, "MPa", stress));
    }
  return pressures;
}

std::string write_confinements(const std::vector<double>& pressures)
{
  const auto in_mpa = mapped<std::string>(pressures, [](const double p) { return format_number(p / 1e6); });
  return fmt::format("{} MPa", fmt::join(in_mpa, ", "));
}

std::vector<double> read_gravity(const std::string_view text)
{
  const std::vector<double> components = text == none ? std::vector<double>() : parse_quantities(text, acceleration);
  if (components.size() == 1 || components.size() > 3)
    throw InputError("must be none, or have a component for each axis, e.g. \"{}\"", acceleration.example);
  return components;
}

std::string write_gravity(const std::vector<double>& components)
{
  const auto numbers = mapped<std::string>(components, format_number);
  return numbers.empty() ? std::string(none) : fmt::format("{} m/s^2", fmt::join(numbers, ", "));
}

std::vector<std::string> read_variant_entries(const std::string_view text)
{
  std::vector<std::string> entries;
  if (text != none)
    for (const std::string_view piece : split_at(";", text))
      entries.push_back(varied_entry(piece));
  return entries;
}

std::vector<std::vector<std::string>> read_variant_values(const std::string_view text)
{
  std::vector<std::vector<std::string>> values;
  if (text != none)
    for (const std::string_view list : split_at("||", text))
      {
        auto& of_entry = values.emplace_back();
        for (const std::string_view piece : split_at(";", list))
          std::ranges::move(values_of_range(piece), std::back_inserter(of_entry));
      }
  return values;
}

std::string write_variant_values(const std::vector<std::vector<std::string>>& values)
{
  const auto lists =
    mapped<std::string>(values, [](const auto& list) { return fmt::format("{}", fmt::join(list, "; ")); });
  return lists.empty() ? std::string(none) : fmt::format("{}", fmt::join(lists, " || "));
}

std::vector<std::uint64_t> read_seeds(const std::string_view text)
{
  std::vector<std::uint64_t> seeds;
  for (const std::string_view piece : split_at_commas(text))
    {
      if (piece.find(" step ") != std::string_view::npos)
        {
          for (const std::string& seed : values_of_range(piece))
            seeds.push_back(parse_count(seed));
          continue;
        }
      const std::size_t dots = piece.find("..");
      if (const std::size_t dash = piece.find('-'); dash != std::string_view::npos && dash > 0)
        throw InputError("{}: a range is written with two dots, {}..{}", in_quotes(piece),
                         excerpt(trim(piece.substr(0, dash))), excerpt(trim(piece.substr(dash + 1))));
      const std::uint64_t first = parse_count(piece.substr(0, dots));
      const std::uint64_t last = dots == std::string_view::npos ? first : parse_count(piece.substr(dots + 2));
      if (last < first)
        throw InputError("the range {} runs backwards", excerpt(piece));
      if (last - first >= most_seeds - seeds.size())
        throw InputError("must be at most {} seeds", most_seeds);
      for (std::uint64_t i = 0; i <= last - first; ++i)
        seeds.push_back(first + i);
    }
  for (std::set<std::uint64_t> seen; const std::uint64_t seed : seeds)
    if (!seen.insert(seed).second)
      throw InputError("seed {} is given twice", seed);
  return seeds;
}

std::vector<std::optional<double>> read_direction(const std::string_view text)
{
  std::vector<std::optional<double>> direction;
  if (text == none)
    return direction;
  for (const std::string_view piece : split_at_commas(text))
    direction.push_back(piece == free_component ? std::nullopt : std::optional(parse_number(piece)));
  if (std::ranges::none_of(direction, [](const auto& entry) { return entry.value_or(0.0) != 0.0; }))
    throw InputError("at least one component must be a number other than 0");
  return direction;
}

std::string write_direction(const std::vector<std::optional<double>>& direction)
{
  const auto components = mapped<std::string>(
    direction, [](const auto& one) { return one ? format_number(*one) : std::string(free_component); });
  return or_none(fmt::format("{}", fmt::join(components, ", ")));
}
} // namespace

std::vector<Entry<Input>> test_list_entries()
{
  return {entry::text("List", &Input::test_list, "", names(test_kinds()), read_tests, names,
                      "the tests to be made, separated by commas", {.basic = true}),
          entry::text("Confinements", &Input::confinements, "MPa", "> 0 MPa each", read_confinements,
                      write_confinements,
                      "pressures of the triaxial tests, normal stresses of direct shear, separated by commas, and "
                      "ranges such as 10..60 MPa step 10",
                      {.basic = true})};
}

std::vector<Entry<Input>> progress_entries()
{
  const auto read = [](const std::string_view text) {
    const std::uint64_t steps = parse_count(text);
    if (steps == 0)
      throw InputError("must be an integer > 0");
    return steps;
  };
  const auto write = [](const std::uint64_t steps) { return std::to_string(steps); };
  return {
    entry::text("Steps between checkpoints", &Input::steps_between_checkpoints, "", "integer > 0", read, write,
                "after which `lab --resume` can take up a test"),
    entry::choice(
      "Shared body", &Input::shared_body,
      {{"by size", SharedBody::by_size}, {"always", SharedBody::always}, {"never", SharedBody::never}},
      "whether the processes of mpirun compute each specimen together, with the same results, or each makes tests of its own; "
      "by size: specimens of 100 000 grains and more together")};
}

std::vector<Entry<TestParameters>> tests_text_entries()
{
  return {entry::text("Gravity", &TestParameters::gravity, "m/s^2", "none, or a number for each axis", read_gravity,
                      write_gravity,
                      "acceleration of all grains, from the first step on (of tilt: raised while the body is seated)",
                      tests_flags::of_grains)};
}

std::string varied_entry(const std::string_view text)
{
  std::vector<std::string> names;      // of all that can vary
  std::vector<std::string> with_entry; // of these, with this entry
  for (const Parameter& parameter : parameter_table())
    if (parameter.flags.varies)
      {
        names.push_back(parameter.name());
        if (parameter.entry == text)
          with_entry.push_back(parameter.name());
      }
    else if (parameter.name() == text)
      throw InputError("is one for all variants; it cannot vary");
  if (contains(names, text))
    return std::string(text);
  if (!with_entry.empty())
    throw InputError("lacks its section; write Section/Entry: {}", fmt::join(with_entry, " or "));
  const std::string nearest = suggestion(text, {names.begin(), names.end()});
  throw InputError("is not an entry that can vary; write Section/Entry" +
                   (nearest.starts_with("; there are") ? ", e.g. Flat joint/Segments" : nearest));
}

std::vector<Entry<VariantParameters>> variant_entries()
{
  using P = VariantParameters;
  const auto write_entries = [](const std::vector<std::string>& entries) {
    return or_none(fmt::format("{}", fmt::join(entries, "; ")));
  };
  return {
    entry::text("Entry", &P::entries, "", "none, or Section/Entry, several separated by semicolons",
                read_variant_entries, write_entries, "entries that take several values in one run", {.basic = true}),
    entry::text(
      "Values", &P::values, "", "none, or values of each entry", read_variant_values, write_variant_values,
      "values separated by semicolons, and ranges such as 10..60 MPa step 10; the lists of several entries by "
      "two upright bars, ||",
      {.basic = true}),
    entry::choice("Combine", &P::in_step, {{"grid", false}, {"in step", true}},
                  "grid: each value of an entry with each of the others; in step: the first values of all entries, "
                  "then the second, ..."),
    entry::file("Table", &P::table,
                "a CSV file instead of Entry and Values: a column for each entry, named Section/Entry, and a row "
                "for each variant")};
}

std::vector<Entry<Input>> seeds_entries()
{
  const auto write = [](const std::vector<std::uint64_t>& seeds) { return fmt::format("{}", fmt::join(seeds, ", ")); };
  return {entry::text("Seeds", &Input::seeds, "", "non-negative integers and ranges, such as 1, 5..7, 10..20 step 5",
                      read_seeds, write, "one specimen for each seed", {.basic = true})};
}

std::vector<Entry<ContactParameters>> contact_entries()
{
  using P = ContactParameters;
  return {entry::quantity("Radius 1", &P::radius_1, Measure::length, "mm", ranges::above_zero,
                          "of grain 1 of `feldspar contact`"),
          entry::quantity("Radius 2", &P::radius_2, Measure::length, "mm", ranges::above_zero,
                          "of grain 2 of `feldspar contact`")};
}

std::vector<Entry<ContactParameters>> contact_path_entries()
{
  return {entry::file("File", &ContactParameters::path_file,
                      "displacements since rest, a CSV with the columns normal_m,shear_m,rotation_rad; in three "
                      "dimensions normal_m,shear_1_m,shear_2_m,twist_rad,bend_1_rad,bend_2_rad")};
}

std::vector<Entry<StrainPathParameters>> strain_path_entries()
{
  using P = StrainPathParameters;
  const EntryFlags varies{.varies = true};
  const EntryFlags basic{.varies = true, .basic = true};
  return {
    entry::file("File", &P::path_file,
                "points of the path of `feldspar rve`, a CSV with a column for each of xx,yy,xy (in three "
                "dimensions xx,yy,zz,yz,xz,xy): strain_xx (tensor shear) or stress_xx_Pa, tension positive; "
                "straight ways between; instead of Direction",
                {.basic = true}),
    entry::text(
      "Direction", &P::direction, "", "none, or a number or free for each of xx, yy, xy (or xx, yy, zz, yz, xz, xy)",
      read_direction, write_direction,
      "of the strain (tensor shear, tension positive); a free component stays at the stress of the confinement", basic),
    entry::number("Size", &P::size, {'(', 0.0, largest_strain, ']'}, "of the strain at the end, over Direction", basic),
    entry::quantity("Confining pressure", &P::confining_pressure, Measure::stress, "MPa", {'[', 0.0, 1e5, ']'},
                    "compression positive, on all sides before the strain begins; strains of Direction count "
                    "from there",
                    basic),
    entry::number("Largest step", &P::largest_step, {'(', 0.0, largest_strain, ']'},
                  "of any component of the strain in one increment", basic),
    entry::quantity("Cell angle", &P::cell_angle, Measure::angle, "deg", {'[', -180.0, 180.0, ']'},
                    "by which the periodic cell is turned before its path begins: from x towards y, in three "
                    "dimensions from z towards x; strains and stresses stay in the axes of the path",
                    varies),
    entry::choice("Solver", &P::solver,
                  {{"event by event", PathSolver::event_by_event}, {"explicit", PathSolver::explicit_dynamics}},
                  "without a rate, or explicit dynamics as in the laboratory", varies),
    entry::integer("Steps per millistrain", &P::steps_per_millistrain, {'[', 1.0, 1e8, ']'},
                   "of explicit dynamics, for 1e-3 of the largest component of the strain", varies)};
}

std::vector<Entry<ReportLabels>> label_entries()
{
  using L = ReportLabels;
  const auto read = [](const std::string_view text) {
    constexpr std::size_t most = 200; // bytes: a line or two of a heading
    if (text.size() > most)
      throw InputError("is too long: {} bytes, at most {} are allowed", text.size(), most);
    if (printable(text) != text)
      throw InputError("{} is no line of UTF-8 text without control characters", in_quotes(text));
    return std::string(text == none ? "" : text);
  };
  const auto label = [&](const std::string_view name, std::string L::*const member, const std::string_view meaning) {
    return entry::text(name, member, "", "none, or a text", read, or_none, meaning);
  };
  return {
    label("Title", &L::title, "heading of the report; names the run in tables and keys, instead of its folder"),
    label("Client", &L::client, "under the heading of the report"),
    label("Specimen", &L::specimen, "name of the specimen, under the heading and at the top of each printed page"),
    label("Author", &L::author, "under the heading of the report"),
    label("Date", &L::date, "under the heading and at the top of each printed page, as it is written here")};
}

std::vector<Entry<Input>> report_entries()
{
  return {
    entry::file("Reference file", &Input::reference_file,
                "figures of the rock and of other models (JSON) to set the results beside", {.basic = true}),
    entry::file("Reference results", &Input::reference_results,
                "the summary.json of tests on another body of the same rock, such as that of `feldspar lab` "
                "for a `feldspar multiscale`: its installation gap, coordination number and porosity are set beside "
                "those of this run, and another gap is said to be one")};
}
} // namespace feldspar
