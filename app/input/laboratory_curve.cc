#include "app/input/laboratory_curve.h"

#include "app/input/quantity.h"
#include "base/csv.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "dem/lab/protocols/protocols.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace feldspar
{
namespace
{
constexpr Dimension strain{"a strain", "1", "0.1 %"};
constexpr double steady = 0.05; // by so much the pressure may wander from its mean

/// A quantity that the file must have.
struct Quantity
{
  std::string_view name;
  const Dimension* dimension;
};

constexpr std::array<Quantity, 4> quantities{Quantity{"axial_strain", &strain}, Quantity{"lateral_strain", &strain},
                                             Quantity{"axial_stress", &stress},
                                             Quantity{"confining_pressure", &stress}};
constexpr std::string_view right_header =
  "axial_strain [%],lateral_strain [%],axial_stress [MPa],confining_pressure [MPa]";

/// The column of a quantity in the file, and its unit in SI.
struct QuantityColumn
{
  std::size_t column;
  double unit;
};

std::array<QuantityColumn, quantities.size()> columns_of(const std::string& header, const std::filesystem::path& file)
{
  const auto refuse = [&](const std::string& what) {
    return InputError(fmt::format("{}:1: {}; the header must be as in \"{}\"", file.string(), what, right_header));
  };
  std::array<std::optional<QuantityColumn>, quantities.size()> found;
  const auto columns = split_at_commas(header);
  for (std::size_t c = 0; c < columns.size(); ++c)
    {
      const std::string_view column = columns[c];
      const std::size_t bracket = std::min(column.find('['), column.size());
      const std::string_view name = trim(column.substr(0, bracket));
      const auto quantity =
        std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& one) { return one.name == name; });
      if (quantity == quantities.end())
        continue; // a column more does no harm
      if (bracket == column.size() || !column.ends_with(']'))
        throw refuse(fmt::format("{} has no unit in square brackets", in_quotes(column)));
      const std::string_view unit = trim(column.substr(bracket + 1, column.size() - bracket - 2));
      const bool is_plain = quantity->dimension == &strain && (unit == "-" || unit == "1");
      auto& place = found[std::size_t(quantity - quantities.begin())];
      if (place)
        throw refuse(fmt::format("{} is there twice", name));
      try
        {
          place = QuantityColumn{c, is_plain ? 1.0 : parse_quantity(fmt::format("1 {}", unit), *quantity->dimension)};
        }
      catch (const InputError& error)
        {
          throw refuse(fmt::format("{}: {}", in_quotes(column), error.what()));
        }
    }
  std::array<QuantityColumn, quantities.size()> all{};
  for (std::size_t q = 0; q < quantities.size(); ++q)
    if (!found[q])
      throw refuse(fmt::format("there is no column {}", quantities[q].name));
    else
      all[q] = *found[q];
  return all;
}

/// The mean pressure; 0 of a uniaxial test.
double steady_pressure(const std::vector<double>& pressures, const std::filesystem::path& file)
{
  double mean = 0.0;
  for (const double pressure : pressures)
    mean += pressure / double(pressures.size());
  for (std::size_t k = 0; k < pressures.size(); ++k)
    if (std::abs(pressures[k] - mean) > steady * std::abs(mean) || pressures[k] < 0.0)
      throw InputError(
        fmt::format("{}: confining_pressure is {:g} MPa in row {} and {:g} MPa in the mean; it must be the "
                    "same within 5 % all through the test, and not negative",
                    file.string(), pressures[k] / 1e6, k + 1, mean / 1e6));
  return std::round(mean); // to the pascal, as sums are not exact
}
/// Counts the strains of a curve from where its load begins, and drops the rows before: an extensometer has no zero of its
/// own, and a displacement gauge sees platens come to the specimen. Returns a sentence on what was changed or could not be,
/// without its full stop; empty if nothing was.
std::string count_strains_from_first_load(TestRecord& record, const std::size_t peak, const std::string& file)
{
  constexpr double no_load = 1e-3;     // of the peak deviator: such a row changes a secant modulus by 0.2 %
  constexpr double under_load = 1e-2;  // of the same: beyond it strains may have been counted from before
  constexpr double least_shift = 1e-9; // of what is announced
  auto& curve = record.curve;
  const double at_peak = record.kind.deviator(curve[peak], record.confining_pressure);
  const auto share = [&](const std::size_t row) {
    return record.kind.deviator(curve[row], record.confining_pressure) / at_peak;
  };
  if (share(0) > under_load)
    return fmt::format("{}: the first row is under {:.1f} % of the peak load already; strains are taken as they stand, "
                       "and strain at the peak, secant modulus and secant Poisson's ratio rest on their zero",
                       file, 100.0 * share(0));
  // A load cell may read something before the platen is in contact: the last row by its first reading, before the load
  // has left it.
  std::size_t loaded = 0;
  while (share(loaded) - share(0) <= under_load)
    ++loaded;
  std::size_t start = loaded;
  while (share(start) - share(0) > no_load)
    --start;
  const double reading = start > 0 ? share(0) : 0.0;
  const CurveSample zero = curve[start];
  curve.erase(curve.begin(), curve.begin() + std::ptrdiff_t(start));
  for (CurveSample& row : curve)
    {
      row.axial_strain -= zero.axial_strain;
      row.gauge_axial_strain -= zero.gauge_axial_strain;
      row.gauge_lateral_strain -= zero.gauge_lateral_strain;
      row.gauge_volumetric_strain -= zero.gauge_volumetric_strain;
    }
  const std::string offset =
    reading > no_load
      ? fmt::format("; the load of {:.2g} MPa that is read before stays in the stresses", reading * at_peak / 1e6)
      : "";
  if (std::max(std::abs(zero.axial_strain), std::abs(zero.gauge_lateral_strain)) < least_shift)
    return "";
  return fmt::format(
    "{}: strains are counted from row {} below the header, where the load begins; {:.4g} % of axial and "
    "{:.4g} % of lateral strain were taken off every row{}",
    file, start + 1, -100.0 * zero.axial_strain, -100.0 * zero.gauge_lateral_strain, offset);
}
} // namespace

Series read_laboratory_curve(const std::filesystem::path& file)
{
  CsvReader table(file);
  const auto columns = columns_of(table.header(), file);

  FinishedTest test;
  const std::string name = plot::file_name(file.stem().string());
  test.name = test.group = name.empty() ? "measured" : name;
  std::vector<double> pressures;
  while (table.next())
    {
      const auto value = [&](const std::size_t q) {
        const double in_si = columns[q].unit * table.number(columns[q].column);
        if (!std::isfinite(in_si))
          throw InputError(fmt::format("{}:{}: {}: {} is beyond the range of numbers", file.string(),
                                       table.line_of_row(), quantities[q].name,
                                       in_quotes(table.text(columns[q].column))));
        return in_si;
      };
      CurveSample sample; // tension positive
      sample.step = test.record.curve.size();
      sample.axial_strain = sample.gauge_axial_strain = -value(0);
      sample.gauge_lateral_strain = -value(1);
      sample.gauge_volumetric_strain = sample.gauge_axial_strain + 2.0 * sample.gauge_lateral_strain; // a cylinder
      sample.axial_stress = -value(2);
      sample.lateral_stress = -value(3);
      pressures.push_back(value(3));
      test.record.curve.push_back(sample);
    }
  if (pressures.empty())
    throw InputError(fmt::format("{}: there is no row below the header", file.string()));
  test.record.confining_pressure = steady_pressure(pressures, file);
  const double least_stress =
    std::ranges::min(test.record.curve, {}, &CurveSample::axial_stress).axial_stress; // tension positive
  if (-least_stress <= test.record.confining_pressure && test.record.confining_pressure > 0.0)
    throw InputError(fmt::format("{}: axial_stress reaches {:g} MPa only, under a confining_pressure of {:g} MPa; it "
                                 "must be the whole axial stress, not the part beyond the pressure",
                                 file.string(), -least_stress / 1e6, test.record.confining_pressure / 1e6));
  test.record.kind = test.record.confining_pressure > 0.0 ? triaxial_compression.kind : uniaxial_compression.kind;
  // Laboratories choose where a curve ends: right after the peak, or when it has risen again.
  test.record.peak_demands = {.least_fall = 0.0, .may_end_rising = true};
  const auto peak = peak_row(test.record);
  if (!peak)
    throw InputError(
      fmt::format("{}: axial_stress never peaks: it must rise and fall again, compression positive", file.string()));
  const auto& curve = test.record.curve;
  if (curve[*peak].axial_strain >= curve.front().axial_strain)
    throw InputError(
      fmt::format("{}: axial_strain does not grow up to the peak; shortening is positive", file.string()));
  // Elastic rock widens when it is pressed: positive lateral strains would pass as a negative Poisson's ratio.
  for (std::size_t k = 0; k <= *peak; ++k)
    if (curve[k].axial_stress <=
        0.5 * (curve[*peak].axial_stress - curve.front().axial_stress) + curve.front().axial_stress)
      {
        if (curve[k].gauge_lateral_strain <= curve.front().gauge_lateral_strain)
          throw InputError(fmt::format("{}: lateral_strain grows with the load at half of the peak; compression is "
                                       "positive, so a specimen that widens has negative lateral strains",
                                       file.string()));
        break;
      }

  const std::string on_strains = count_strains_from_first_load(test.record, *peak, printable(file.string()));

  test.results = evaluate(test.record);
  for (const TestQuantity& quantity : test_quantities)
    if (quantity.figure() && quantity.needs != NeedsBesidesCurve::nothing)
      test.results.*quantity.figure() = {std::nullopt, quantity.needs == NeedsBesidesCurve::cracks
                                                         ? "a measured curve counts no cracks"
                                                         : "not known of a measured curve"};
  Series series{file.filename().string(), SeriesKind::laboratory_curve, {}, {test}, {}};
  if (!on_strains.empty())
    series.problems.push_back(on_strains);
  return series;
}
} // namespace feldspar
