#include "app/input/curves/curve_table.h"

#include "base/contains.h"
#include "base/quoted.h"
#include "base/table/quantity.h"
#include "base/text.h"
#include "dem/lab/protocols/protocols.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace feldspar
{
namespace
{
struct Quantity
{
  const Dimension* dimension;
  std::vector<std::string_view> names; ///< in small letters, words between spaces
};

const std::map<Measured, Quantity>& quantities()
{
  using enum Measured;
  static const std::map<Measured, Quantity> all{
    {axial_strain, {&strain, {"axial strain", "strain", "compressive strain", "tensile strain"}}},
    {axial_displacement,
     {&length, {"axial displacement", "displacement", "compressive extension", "shortening", "elongation"}}},
    {axial_stress,
     {&stress,
      {"axial stress", "stress", "compressive stress", "tensile stress", "splitting stress", "splitting tensile stress",
       "indirect tensile stress", "brazilian stress"}}},
    {deviator, {&stress, {"deviator stress", "deviatoric stress", "differential stress"}}},
    {axial_force,
     {&force, {"axial force", "axial load", "force", "load", "compressive load", "tensile force", "tensile load"}}},
    {lateral_strain, {&strain, {"lateral strain", "radial strain", "transverse strain", "circumferential strain"}}},
    {volumetric_strain, {&strain, {"volumetric strain"}}},
    {confining_pressure, {&stress, {"confining pressure", "confining stress", "cell pressure", "confinement"}}}};
  return all;
}

std::optional<Measured> measured_in(const std::string_view column)
{
  const std::string name = plain_name(title_with_mark_of(column).name);
  for (const auto& [measured, quantity] : quantities())
    if (contains(quantity.names, name))
      return measured;
  return std::nullopt;
}
} // namespace

CurveTable::CurveTable(const std::filesystem::path& of_file)
  : file(of_file.string())
  , table(of_file, [](const auto& names) {
    return std::ranges::count_if(names, [](const auto name) { return measured_in(name).has_value(); }) >= 2;
  })
{
  bool units_are_below = false;
  for (std::size_t c = 0; c < table.header().size(); ++c)
    if (const auto quantity = measured_in(table.name_of(c)))
      {
        if (has(*quantity))
          throw refusal(fmt::format("{} is there twice", quantities().at(*quantity).names.front()));
        const std::string_view unit = title_with_mark_of(table.name_of(c)).unit;
        units_are_below = units_are_below || unit.empty();
        columns[*quantity] = {c, unit.empty() ? 0.0 : unit_of(c, unit, *quantity)};
      }
  if (units_are_below && table.next())
    for (auto& [quantity, column] : columns)
      if (column.unit == 0.0)
        {
          const std::string_view cell = table.text(column.place);
          const std::string_view unit = title_of(cell).unit.empty() ? cell : title_of(cell).unit;
          if (unit.empty() || is_decimal_number(unit))
            throw refusal(fmt::format("{} has no unit", in_quotes(table.name_of(column.place))));
          column.unit = unit_of(column.place, unit, quantity);
        }
}

std::vector<std::string> CurveTable::unread() const
{
  std::vector<std::string> names;
  for (const std::string_view name : table.header())
    if (!name.empty() && !measured_in(name))
      names.push_back(in_quotes(name));
  return names;
}

std::optional<TestKind> CurveTable::kind() const
{
  for (const Measured quantity : {Measured::axial_stress, Measured::axial_force})
    if (has(quantity))
      {
        const std::string title = plain_name(table.name_of(columns.at(quantity).place));
        const auto has_word = [&](const std::string_view word) { return title.find(word) != std::string::npos; };
        if (has_word("splitting") || has_word("indirect") || has_word("brazilian"))
          return brazilian.kind;
        if (has_word("tensile"))
          return direct_tension.kind;
      }
  return std::nullopt;
}

std::vector<CurveSample> CurveTable::rows(const std::optional<CylinderSize>& size, const bool is_disc)
{
  using enum Measured;
  if (!has(axial_strain) && !has(axial_displacement))
    throw refusal("there is no column axial_strain, nor axial_displacement");
  if (!has(axial_stress) && !has(deviator) && !has(axial_force))
    throw refusal("there is no column axial_stress, nor axial_force");
  if (!size && needs_size())
    throw refusal("forces and displacements need the size of the specimen, as --curve-size \"50, 100 mm\" gives "
                  "diameter and height");
  // The load acts on a section of the cylinder, or splits the disc along its diameter: 2P/(πDt).
  const double area = !size     ? 0.0
                      : is_disc ? 0.5 * std::numbers::pi * size->diameter * size->height
                                : 0.25 * std::numbers::pi * size->diameter * size->diameter;
  const double loaded_length = !size ? 0.0 : is_disc ? size->diameter : size->height;
  std::vector<CurveSample> rows;
  while (table.next())
    {
      const double pressure = has(confining_pressure) ? value(confining_pressure) : 0.0;
      const double shortening = has(axial_strain) ? value(axial_strain) : value(axial_displacement) / loaded_length;
      const double pressed = has(axial_stress) ? value(axial_stress)
                             : has(deviator)   ? value(deviator) + pressure
                                               : value(axial_force) / area;
      double lateral = std::numeric_limits<double>::quiet_NaN();
      if (has(lateral_strain))
        lateral = value(lateral_strain);
      else if (has(volumetric_strain))
        lateral = 0.5 * (value(volumetric_strain) - shortening);
      CurveSample& row = rows.emplace_back();
      row.step = rows.size() - 1;
      row.axial_strain = row.gauge_axial_strain = -shortening;
      row.gauge_lateral_strain = -lateral;
      row.gauge_volumetric_strain = row.gauge_axial_strain + 2.0 * row.gauge_lateral_strain; // a cylinder
      row.axial_stress = -pressed;
      row.lateral_stress = -pressure;
    }
  return rows;
}

double CurveTable::value(const Measured quantity) const
{
  const auto& [place, unit] = columns.at(quantity);
  const double in_si = unit * table.number(place);
  if (!std::isfinite(in_si))
    throw InputError("{}:{}: {}: {} is beyond the range of numbers", file, table.line_of_row(), table.name_of(place),
                     in_quotes(table.text(place)));
  return in_si;
}

InputError CurveTable::refusal(const std::string& what) const
{
  return InputError("{}:{}: {}; the header must be as in \"axial_strain [%],lateral_strain [%],axial_stress "
                    "[MPa],confining_pressure [MPa]\", of which lateral strain and pressure may be left out",
                    file, table.line_of_header(), what);
}

double CurveTable::unit_of(const std::size_t column, const std::string_view unit, const Measured quantity) const
{
  return rephrased(
    [&] { return unit_in_si(unit, *quantities().at(quantity).dimension); },
    [&](const std::string& what) { return refusal(fmt::format("{}: {}", in_quotes(table.name_of(column)), what)); });
}
} // namespace feldspar
