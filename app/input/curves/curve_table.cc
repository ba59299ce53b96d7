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

/// In the order of Measured.
const std::array<Quantity, 8>& quantities()
{
  static const std::array<Quantity, 8> all{
    Quantity{&strain, {"axial strain", "strain", "compressive strain", "tensile strain"}},
    Quantity{&length, {"axial displacement", "displacement", "compressive extension", "shortening", "elongation"}},
    Quantity{&stress,
             {"axial stress", "stress", "compressive stress", "tensile stress", "splitting stress",
              "splitting tensile stress", "indirect tensile stress", "brazilian stress"}},
    Quantity{&stress, {"deviator stress", "deviatoric stress", "differential stress"}},
    Quantity{&force,
             {"axial force", "axial load", "force", "load", "compressive load", "tensile force", "tensile load"}},
    Quantity{&strain, {"lateral strain", "radial strain", "transverse strain", "circumferential strain"}},
    Quantity{&strain, {"volumetric strain"}},
    Quantity{&stress, {"confining pressure", "confining stress", "cell pressure", "confinement"}}};
  return all;
}

std::optional<Measured> measured_in(const std::string_view column)
{
  const std::string name = plain_name(title_with_mark_of(column).name);
  for (std::size_t q = 0; q < quantities().size(); ++q)
    if (contains(quantities()[q].names, name))
      return Measured(q);
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
        if (column(*quantity))
          throw refusal(fmt::format("{} is there twice", quantities()[std::size_t(*quantity)].names.front()));
        const std::string_view unit = title_with_mark_of(table.name_of(c)).unit;
        units_are_below = units_are_below || unit.empty();
        columns[std::size_t(*quantity)] = {c, unit.empty() ? 0.0 : unit_of(c, unit, *quantity)};
      }
  if (units_are_below && table.next())
    for (std::size_t q = 0; q < columns.size(); ++q)
      if (columns[q] && columns[q]->unit == 0.0)
        {
          const std::string_view cell = table.text(columns[q]->column);
          const std::string_view unit = title_of(cell).unit.empty() ? cell : title_of(cell).unit;
          if (unit.empty() || is_decimal_number(unit))
            throw refusal(fmt::format("{} has no unit", in_quotes(table.name_of(columns[q]->column))));
          columns[q]->unit = unit_of(columns[q]->column, unit, Measured(q));
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
    if (const auto& place = column(quantity))
      {
        const std::string title = plain_name(table.name_of(place->column));
        const auto has_word = [&](const std::string_view word) { return title.find(word) != std::string::npos; };
        if (has_word("splitting") || has_word("indirect") || has_word("brazilian"))
          return brazilian.kind;
        if (has_word("tensile"))
          return direct_tension.kind;
      }
  return std::nullopt;
}

std::optional<double> CurveTable::value(const Measured quantity) const
{
  const auto& place = column(quantity);
  if (!place)
    return std::nullopt;
  const double in_si = place->unit * table.number(place->column);
  if (!std::isfinite(in_si))
    throw InputError("{}:{}: {}: {} is beyond the range of numbers", file, table.line_of_row(),
                     table.name_of(place->column), in_quotes(table.text(place->column)));
  return in_si;
}

InputError CurveTable::refusal(const std::string& what) const
{
  constexpr std::string_view right_header =
    "axial_strain [%],lateral_strain [%],axial_stress [MPa],confining_pressure [MPa]";
  return InputError("{}:{}: {}; the header must be as in \"{}\", of which lateral strain and pressure may "
                    "be left out",
                    file, table.line_of_header(), what, right_header);
}

double CurveTable::unit_of(const std::size_t of_column, const std::string_view unit, const Measured quantity) const
{
  return rephrased(
    [&] { return unit_in_si(unit, *quantities()[std::size_t(quantity)].dimension); },
    [&](const std::string& what) { return refusal(fmt::format("{}: {}", in_quotes(table.name_of(of_column)), what)); });
}

/// Reads the rows; stresses and strains tension positive, a lateral strain that is not there is NaN.
std::vector<CurveSample> rows_of(CurveTable& table, const std::optional<CylinderSize>& size, const bool is_disc)
{
  using enum Measured;
  if (!table.has(axial_strain) && !table.has(axial_displacement))
    throw table.refusal("there is no column axial_strain, nor axial_displacement");
  if (!table.has(axial_stress) && !table.has(deviator) && !table.has(axial_force))
    throw table.refusal("there is no column axial_stress, nor axial_force");
  if (!size && table.needs_size())
    throw table.refusal("forces and displacements need the size of the specimen, as --curve-size \"50, 100 mm\" "
                        "gives diameter and height");
  // The load acts on a section of the cylinder, or splits the disc along its diameter: 2P/(πDt).
  const double area = !size     ? 0.0
                      : is_disc ? 0.5 * std::numbers::pi * size->diameter * size->height
                                : 0.25 * std::numbers::pi * size->diameter * size->diameter;
  const double loaded_length = !size ? 0.0 : is_disc ? size->diameter : size->height;
  std::vector<CurveSample> rows;
  while (table.next())
    {
      const double pressure = table.value(confining_pressure).value_or(0.0);
      const double shortening =
        table.has(axial_strain) ? *table.value(axial_strain) : *table.value(axial_displacement) / loaded_length;
      const double pressed = table.has(axial_stress) ? *table.value(axial_stress)
                             : table.has(deviator)   ? *table.value(deviator) + pressure
                                                     : *table.value(axial_force) / area;
      double lateral = std::numeric_limits<double>::quiet_NaN();
      if (table.has(lateral_strain))
        lateral = *table.value(lateral_strain);
      else if (table.has(volumetric_strain))
        lateral = 0.5 * (*table.value(volumetric_strain) - shortening);
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
} // namespace feldspar
