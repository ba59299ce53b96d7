#include "app/input/curves/laboratory_curve.h"

#include "app/input/curves/curve_table.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/table/quantity.h"
#include "dem/lab/protocols/protocols.h"
#include "report/pictures/plot_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>

namespace feldspar
{
namespace
{
constexpr double steady = 0.05; // by so much the pressure may wander from its mean up to the peak
constexpr double noise_share =
  0.01; // of the peak stress: less, and not held, is the noise of a pressure cell in the open
constexpr double steady_if_small = 0.2; // the same of so small a pressure, whose wandering changes no strength

constexpr std::array<double CurveSample::*, 4> strains_of_row{
  &CurveSample::axial_strain, &CurveSample::gauge_axial_strain, &CurveSample::gauge_lateral_strain,
  &CurveSample::gauge_volumetric_strain};

/// Brings stresses and strains of a test in tension or on a disc to their signs, whichever way the file has them: the load is
/// that of the test, and rock elongates where it is pulled.
void turn_to_sense(TestRecord& record, const std::string& file)
{
  auto& curve = record.curve;
  const CurveSample top =
    *std::ranges::max_element(curve, {}, [](const CurveSample& row) { return std::abs(row.axial_stress); });
  if (std::ranges::any_of(curve, [&](const CurveSample& row) {
        return std::abs(row.lateral_stress) > noise_share * std::abs(top.axial_stress);
      }))
    throw InputError("{}: has a confining_pressure, which {} has not; --curve-test says which test it is", file,
                     record.kind.name);
  const double of_stress = record.kind.stress(top) < 0.0 ? -1.0 : 1.0;
  const double of_strain = record.kind.strain(top) < record.kind.strain(curve.front()) ? -1.0 : 1.0;
  for (CurveSample& row : curve)
    {
      row.axial_stress *= of_stress;
      row.lateral_stress = 0.0;
      for (const auto strain : strains_of_row)
        row.*strain *= of_strain;
    }
}

/// Brings the pressure of a curve to the one of its test: rows before it was reached and after it was lost are left out.
/// Returns a sentence for each part that was, without its full stop.
std::vector<std::string> hold_pressure(TestRecord& record, const std::string& file)
{
  auto& curve = record.curve;
  std::vector<std::string> remarks;
  const std::size_t peak = std::size_t(std::ranges::min_element(curve, {}, &CurveSample::axial_stress) - curve.begin());
  auto up_to_peak =
    mapped<double>(std::span(curve).first(peak + 1), [](const auto& row) { return -row.lateral_stress; });
  std::ranges::nth_element(up_to_peak, up_to_peak.begin() + std::ptrdiff_t(up_to_peak.size() / 2));
  const double median = up_to_peak[up_to_peak.size() / 2];
  const bool is_small = std::ranges::all_of(curve, [&](const CurveSample& row) {
    return std::abs(row.lateral_stress) <= noise_share * std::abs(curve[peak].axial_stress);
  });
  const auto is_held = [&](const CurveSample& row) {
    return std::abs(-row.lateral_stress - median) <= (is_small ? steady_if_small : steady) * median;
  };
  std::size_t begin = 0;
  while (begin < peak && !is_held(curve[begin]))
    ++begin;
  std::size_t end = peak;
  while (end < curve.size() && is_held(curve[end]))
    ++end;
  const auto deviator = [](const CurveSample& row) { return row.lateral_stress - row.axial_stress; };
  // Rows that are left out at the beginning fill the cell; a test is loaded after it, row by row.
  const bool is_filled =
    peak >= begin + 2 && (begin == 0 || deviator(curve[begin - 1]) <= steady * deviator(curve[peak]));
  std::size_t first_off = is_filled ? begin : 0;
  while (first_off <= peak && median > 0.0 && is_held(curve[first_off]))
    ++first_off;
  if (first_off <= peak)
    {
      if (!is_small)
        throw InputError("{}: confining_pressure is {:g} MPa in row {} and {:g} MPa in most rows; once reached it "
                         "must be the same within 5 % up to the peak, and not negative",
                         file, -curve[first_off].lateral_stress / 1e6, first_off + 1, median / 1e6);
      for (CurveSample& row : curve)
        row.lateral_stress = 0.0;
      return remarks;
    }
  if (begin > 0)
    remarks.push_back(
      fmt::format("{}: the first {} rows, before the confining pressure was reached, are left out", file, begin));
  if (end < curve.size())
    remarks.push_back(fmt::format("{}: the last {} rows, in which the confining pressure was not held, are left out",
                                  file, curve.size() - end));
  curve.erase(curve.begin() + std::ptrdiff_t(end), curve.end());
  curve.erase(curve.begin(), curve.begin() + std::ptrdiff_t(begin));
  double mean = 0.0;
  for (const CurveSample& row : curve)
    mean -= row.lateral_stress / double(curve.size());
  record.confining_pressure = std::round(mean); // to the pascal, as sums are not exact
  return remarks;
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
    for (const auto strain : strains_of_row)
      row.*strain -= zero.*strain;
  const std::string offset =
    reading > no_load
      ? fmt::format("; the load of {:.2g} MPa that is read before stays in the stresses", reading * at_peak / 1e6)
      : "";
  const double lateral = std::isfinite(zero.gauge_lateral_strain) ? zero.gauge_lateral_strain : 0.0;
  if (std::max(std::abs(zero.axial_strain), std::abs(lateral)) < least_shift)
    return "";
  return fmt::format(
    "{}: strains are counted from row {} below the header, where the load begins; {:.4g} % of axial and "
    "{:.4g} % of lateral strain were taken off every row{}",
    file, start + 1, 100.0 * record.kind.sign * zero.axial_strain, 100.0 * record.kind.sign * lateral + 0.0 /* no -0 */,
    offset);
}

/// Reads a curve as a finished test; remarks go to `remarks`.
FinishedTest read_curve_of_test(const MeasuredCurve& measured, std::vector<std::string>& remarks)
{
  const std::filesystem::path& file = measured.file;
  const std::string shown = printable(file.string());
  CurveTable table(file);
  if (const auto unread = table.unread(); !unread.empty())
    remarks.push_back(fmt::format("{}: the columns {} are not read", shown, fmt::join(unread, ", ")));
  FinishedTest test;
  TestRecord& record = test.record;
  const std::string name = plot::file_name(file.stem().string());
  test.name = test.group = name.empty() ? "measured" : name;
  const std::optional<TestKind> named = measured.kind ? measured.kind : table.kind();
  const bool is_pressed = !named || named->envelope_role == EnvelopeRole::compression;
  const bool is_disc = named && *named == brazilian.kind;
  if (!is_disc && table.needs_size() && measured.size && measured.size->height < measured.size->diameter)
    throw InputError("{}: a cylinder that is shorter than its diameter has no uniform stress; a disc that is "
                     "split needs --curve-test brazilian",
                     file.string());
  record.curve = table.rows(measured.size, is_disc);
  if (record.curve.empty())
    throw InputError("{}: there is no row below the header", file.string());
  auto& curve = record.curve;
  if (is_pressed)
    {
      std::ranges::move(hold_pressure(record, shown), std::back_inserter(remarks));
      const double least_stress =
        std::ranges::min(curve, {}, &CurveSample::axial_stress).axial_stress; // tension positive
      if (-least_stress <= record.confining_pressure && record.confining_pressure > 0.0)
        throw InputError("{}: axial_stress reaches {:g} MPa only, under a confining_pressure of {:g} MPa; it "
                         "must be the whole axial stress; give the part beyond the pressure as "
                         "deviator_stress",
                         file.string(), -least_stress / 1e6, record.confining_pressure / 1e6);
      record.kind = record.confining_pressure > 0.0 ? triaxial_compression.kind : uniaxial_compression.kind;
    }
  else
    {
      record.kind = *named;
      turn_to_sense(record, file.string());
    }
  // Laboratories choose where a curve ends: at the peak, right after it, or when it has risen again.
  record.peak_demands = {.may_end_rising = true};
  const auto peak = peak_row(record);
  if (!peak)
    throw InputError("{}: axial_stress never rises; compression is positive, and a specimen that is "
                     "pulled needs --curve-test direct_tension",
                     file.string());
  if (record.kind.strain(curve[*peak]) <= record.kind.strain(curve.front()))
    throw InputError("{}: axial_strain does not grow up to the peak; shortening is positive", file.string());
  // Elastic rock widens when it is pressed and narrows when it is pulled: other lateral strains would pass as a negative
  // Poisson's ratio.
  const auto half_of_peak = std::ranges::find_if(curve, [&](const CurveSample& row) {
    return record.kind.stress(row) >= 0.5 * (record.kind.stress(curve[*peak]) + record.kind.stress(curve.front()));
  });
  if (record.kind.has_uniform_stress &&
      record.kind.sign * (half_of_peak->gauge_lateral_strain - curve.front().gauge_lateral_strain) >= 0.0)
    throw InputError("{}: lateral_strain grows with the load at half of the peak, as the axial strain does; "
                     "rock widens where it is pressed and narrows where it is pulled, so that both have "
                     "other signs",
                     file.string());
  const bool ends_at_peak = *peak + 1 == curve.size();
  if (ends_at_peak)
    remarks.push_back(fmt::format("{}: the record ends at its highest stress, which is taken as the strength", shown));
  if (const std::string on_strains = count_strains_from_first_load(record, *peak, shown); !on_strains.empty())
    remarks.push_back(on_strains);

  test.results = evaluate(record);
  const bool has_lateral = std::isfinite(curve.front().gauge_lateral_strain);
  for (const TestQuantity& quantity : test_quantities)
    if (const auto figure = quantity.figure())
      {
        const NeedsBesidesCurve needs = quantity.needs;
        const char* const reason =
          needs == NeedsBesidesCurve::cracks                           ? "a measured curve counts no cracks"
          : needs == NeedsBesidesCurve::motion                         ? "not known of a measured curve"
          : needs == NeedsBesidesCurve::lateral_strain && !has_lateral ? "the measured curve has no lateral strain"
          : needs == NeedsBesidesCurve::fall && ends_at_peak           ? "the measured curve ends at its highest stress"
                                                                       : nullptr;
        if (reason != nullptr)
          test.results.*figure = {std::nullopt, reason};
      }
  return test;
}
} // namespace

CylinderSize parse_cylinder_size(const std::string_view text)
{
  const auto refusal = [](const std::string& why) {
    return InputError("--curve-size must be diameter and height, as in \"50, 100 mm\": {}", why);
  };
  const auto sizes = rephrased([&] { return parse_quantities(text, length); }, refusal);
  if (sizes.size() != 2 || !(sizes[0] > 0.0) || !(sizes[1] > 0.0))
    throw refusal("found is " + in_quotes(text));
  return {sizes[0], sizes[1]};
}

std::vector<MeasuredCurve> measured_curves(const std::vector<std::filesystem::path>& files,
                                           const std::vector<std::string>& sizes, const std::vector<std::string>& tests)
{
  const auto kinds = {uniaxial_compression.kind, triaxial_compression.kind, direct_tension.kind, brazilian.kind};
  for (const auto& [option, given] : {std::pair("--curve-size", sizes.size()), {"--curve-test", tests.size()}})
    if (given > 1 && given != files.size())
      throw InputError("{} is given {} times for {} curves; give it once for all or once for each, in their "
                       "order",
                       option, given, files.size());
  std::vector<MeasuredCurve> curves;
  for (std::size_t k = 0; k < files.size(); ++k)
    {
      MeasuredCurve& curve = curves.emplace_back(MeasuredCurve{.file = files[k]});
      if (!sizes.empty())
        curve.size = parse_cylinder_size(sizes[sizes.size() > 1 ? k : 0]);
      if (tests.empty())
        continue;
      const std::string& name = tests[tests.size() > 1 ? k : 0];
      const auto kind = std::ranges::find(kinds, name, &TestKind::name);
      if (kind == kinds.end())
        throw InputError("--curve-test {}: must be one of {}", excerpt(name), names(kinds));
      curve.kind = *kind;
    }
  return curves;
}

Series read_laboratory_curves(const std::vector<MeasuredCurve>& curves)
{
  Series series{curves.size() == 1 ? curves.front().file.filename().string() : "measured curves",
                SeriesKind::laboratory_curve,
                {},
                {},
                {}};
  for (const MeasuredCurve& curve : curves)
    series.tests.push_back(read_curve_of_test(curve, series.problems));
  return series;
}
} // namespace feldspar
