#include "app/input/input_entries.h"
#include "app/input/parameter_table.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/table/quantity.h"
#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>

/// The entries of bodies that have a form of their own: the sieve curve of the grains, the names of a mesh.
namespace feldspar
{
namespace
{
/// SIZE PASSING %; SIZE PASSING %
std::vector<SievePoint> read_sieve_curve(const std::string_view text)
{
  std::vector<SievePoint> curve;
  if (text == none)
    return curve;
  for (const std::string_view piece : split_at(";", text))
    {
      const std::string_view numbers = trim(piece.substr(0, piece.size() - std::size_t(piece.ends_with('%'))));
      const std::size_t space = numbers.rfind(' ');
      if (!piece.ends_with('%') || space == std::string_view::npos)
        throw InputError("{} is no point of a sieve curve; write size and share of the mass that passes, "
                         "e.g. 2 mm 35 %",
                         in_quotes(piece));
      curve.push_back(
        {parse_quantity(trim(numbers.substr(0, space)), length), parse_number(numbers.substr(space + 1)) / 100.0});
      if (curve.size() > 1 ? !(curve.back().size > curve[curve.size() - 2].size &&
                               curve.back().passing >= curve[curve.size() - 2].passing)
                           : !(curve.back().size > 0.0))
        throw InputError("{}: sizes must be above 0 and increase, and no share may be below that before",
                         in_quotes(piece));
    }
  if (curve.size() < 2 || curve.front().passing != 0.0 || curve.back().passing != 1.0)
    throw InputError(
      "must begin with 0 % at the size of the smallest grains and end with 100 % at that of the largest");
  constexpr double largest_ratio = 100.0; // as of Radius ratio
  if (curve.back().size > largest_ratio * curve.front().size)
    throw InputError("the largest size must be at most {:g} times the smallest", largest_ratio);
  return curve;
}

std::string write_sieve_curve(const std::vector<SievePoint>& curve)
{
  const auto points = mapped<std::string>(curve, [](const SievePoint& point) {
    return fmt::format("{} {} %", format_quantity(point.size, "mm", length), format_number(100.0 * point.passing));
  });
  return or_none(fmt::format("{}", fmt::join(points, "; ")));
}

/// BOUNDARY = GROUP, GROUP; BOUNDARY = GROUP
std::map<std::string, std::vector<std::string>> read_mesh_names(const std::string_view text)
{
  std::map<std::string, std::vector<std::string>> names;
  if (text == none)
    return names;
  constexpr std::array<std::string_view, 6> known{"left", "right", "bottom", "top", "axis", "side"};
  for (const std::string_view piece : split_at(";", text))
    {
      const std::size_t equals = std::min(piece.find('='), piece.size());
      const std::string_view name = trim(piece.substr(0, equals));
      if (!contains(known, name))
        throw InputError("{} is no boundary of a sample; write {} = NAME", in_quotes(name), fmt::join(known, ", "));
      const auto groups = split_at_commas(piece.substr(std::min(equals + 1, piece.size())));
      if (contains(groups, ""))
        throw InputError("{} lacks the name of a group of the mesh; write {} = NAME", name, name);
      if (!names.emplace(name, std::vector<std::string>(groups.begin(), groups.end())).second)
        throw InputError("{} is given twice; separate several groups by commas", name);
    }
  return names;
}

std::string write_mesh_names(const std::map<std::string, std::vector<std::string>>& names)
{
  const auto boundaries = mapped<std::string>(
    names, [](const auto& one) { return fmt::format("{} = {}", one.first, fmt::join(one.second, ", ")); });
  return or_none(fmt::format("{}", fmt::join(boundaries, "; ")));
}
} // namespace

std::vector<Entry<SpecimenParameters>> sieve_curve_entries()
{
  const auto excluded = [](const std::string_view other) {
    return Demand{"",
                  other,
                  {},
                  "gives the sizes of all grains; leave out Minimum radius, Radius ratio and Size distribution"};
  };
  return {entry::text(
    "Sieve curve", &SpecimenParameters::sieve_curve, "", "none, or SIZE PASSING %, separated by semicolons",
    read_sieve_curve, write_sieve_curve,
    "diameters of grains and the share of the mass in smaller ones (in the plane: of the area), from 0 to 100 %, "
    "instead of the radii: `0.8 mm 0 %; 1.2 mm 40 %; 2 mm 100 %`; between two points the mass is spread evenly "
    "over the logarithm of the size",
    {.varies = true,
     .of_specimen = true,
     .demands = {excluded("Specimen/Minimum radius"), excluded("Specimen/Radius ratio"),
                 excluded("Specimen/Size distribution")}})};
}

std::vector<Entry<SampleParameters>> mesh_names_entries()
{
  return {entry::text(
    "Mesh names", &SampleParameters::mesh_names, "", "none, or BOUNDARY = GROUP, several separated by semicolons",
    read_mesh_names, write_mesh_names,
    "physical groups of the mesh file that are the boundaries of the sample, where they have other names there: "
    "`left = west; bottom = base_1, base_2`; a group without a name has its number")};
}
} // namespace feldspar
