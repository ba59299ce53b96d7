#include "results/folder/csv_tables.h"

#include "base/mapped.h"
#include "base/quoted.h"
#include "base/table/csv.h"
#include "base/whole_file.h"
#include "results/folder/table_columns.h"
#include "results/minerals.h"
#include "results/runs/run.h"
#include "results/variant_setting.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>

namespace feldspar
{
namespace
{
std::vector<Column<CurveSample>> columns_of_curves(const TestBody body)
{
  std::vector<Column<CurveSample>> columns;
  for (const auto& one : curve_columns)
    if (!one.is(only_of_samples) || body == TestBody::finite_elements)
      columns.push_back(one);
  return columns;
}

const char* kind_name(const CrackKind kind) { return kind == CrackKind::tension ? "tension" : "shear"; }

template <typename Columns>
void append_names(std::string& text, const Columns& columns)
{
  for (const auto& one : columns)
    fmt::format_to(std::back_inserter(text), "{}{}", &one == std::data(columns) ? "" : ",", one.name);
  text += '\n';
}

template <typename Columns, typename Row>
void append_row(std::string& text, const Columns& columns, const Row& row, const double sign)
{
  for (const auto& one : columns)
    fmt::format_to(std::back_inserter(text), "{}{}", &one == std::data(columns) ? "" : ",",
                   one.is(positive_in_test) ? sign * one.get(row) : one.get(row));
  text += '\n';
}

/// Positions of the columns in this table.
template <typename Columns>
std::vector<std::optional<std::size_t>> places_of(const CsvReader& table, const Columns& columns)
{
  std::vector<std::optional<std::size_t>> places;
  for (const auto& one : columns)
    places.push_back(one.is(added_later) && !table.has(one.name) ? std::nullopt : std::optional(table.place(one.name)));
  return places;
}

/// The cells that should have a finite number and have none.
struct Gaps
{
  std::string first = {};
  std::size_t n = 0;

  void add(const CsvReader& table, const std::size_t column)
  {
    if (n++ == 0)
      first = fmt::format("line {}: {} is {}", table.line_of_row(), excerpt(table.name_of(column)),
                          excerpt(table.text(column)));
  }

  /// `fate`: what becomes of their rows, in words.
  std::string remark(const std::filesystem::path& file,
                     const std::string_view fate = "rows with such cells are left out") const
  {
    if (n == 0)
      return "";
    return fmt::format("{}: {}{}, no finite number; {}", printable(file.string()), first,
                       n > 1 ? fmt::format(" (and {} more such cell{})", n - 1, n > 2 ? "s" : "") : "", fate);
  }
};

template <typename Row, typename Columns>
Row row_of(const CsvReader& table, const Columns& columns, const std::vector<std::optional<std::size_t>>& places,
           const double sign, Gaps& gaps)
{
  Row row{};
  for (std::size_t k = 0; k < std::size(columns); ++k)
    if (places[k])
      {
        const double value =
          columns[k].most > 0.0 ? table.count(*places[k], columns[k].most) : table.number_or_nan(*places[k]);
        if (std::isinf(value) || (std::isnan(value) && !columns[k].is(perhaps_nan)))
          gaps.add(table, *places[k]);
        columns[k].set(row, columns[k].is(positive_in_test) ? sign * value : value);
      }
  return row;
}
} // namespace

void write_curve(const TestRecord& record, const std::filesystem::path& file)
{
  const auto columns = columns_of_curves(record.body);
  std::string text;
  append_names(text, columns);
  for (const auto& row : record.curve)
    append_row(text, columns, row, record.kind.sign);
  write_whole_file(file, text);
}

TableRows<CurveSample> read_curve(const std::filesystem::path& file, const TestKind& kind)
{
  CsvReader table(file);
  const auto places = places_of(table, curve_columns);
  Gaps gaps;
  TableRows<CurveSample> curve;
  while (table.next())
    curve.rows.push_back(row_of<CurveSample>(table, curve_columns, places, kind.sign, gaps));
  curve.remark = gaps.remark(file, "curves have gaps there");
  return curve;
}

namespace
{
/// Gives each row without gaps to the test that it names: complete(row, table) adds what is no number, keep(record, row) takes it.
template <typename Row, typename Columns, typename Complete, typename Keep>
std::string read_rows_into(std::vector<FinishedTest>& tests, const std::filesystem::path& file, const Columns& columns,
                           const Complete& complete, const Keep& keep)
{
  CsvReader table(file);
  const std::size_t name = table.place("test");
  const auto places = places_of(table, columns);
  std::map<std::string_view, FinishedTest*> by_name;
  for (auto& test : tests)
    by_name[test.name] = &test;
  Gaps gaps;
  while (table.next())
    if (const auto found = by_name.find(table.text(name)); found != by_name.end())
      {
        const std::size_t n_gaps = gaps.n;
        Row row = row_of<Row>(table, columns, places, found->second->record.kind.sign, gaps);
        complete(row, table);
        if (gaps.n == n_gaps)
          keep(found->second->record, row);
      }
  return gaps.remark(file);
}
} // namespace

void write_cracks(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  std::string text = "test,kind,";
  append_names(text, crack_columns);
  for (const auto& test : tests)
    for (const auto& crack : test.record.cracks)
      {
        fmt::format_to(std::back_inserter(text), "{},{},", test.name, kind_name(crack.kind));
        append_row(text, crack_columns, crack, test.record.kind.sign);
      }
  write_whole_file(file, text);
}

std::string read_cracks(const std::filesystem::path& file, std::vector<FinishedTest>& tests)
{
  return read_rows_into<Crack>(
    tests, file, crack_columns,
    [](Crack& crack, const CsvReader& table) {
      crack.kind =
        table.text(table.place("kind")) == kind_name(CrackKind::tension) ? CrackKind::tension : CrackKind::shear;
    },
    [](TestRecord& record, const Crack& crack) { record.cracks.push_back(crack); });
}

void write_events(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  std::filesystem::remove(file); // of a run before
  if (std::ranges::all_of(tests, [](const FinishedTest& test) { return test.record.events.empty(); }))
    return;
  std::string text;
  append_names(text, emission_columns);
  text.insert(text.size() - 1, ",test,kind");
  for (const auto& test : tests)
    for (const EmissionEvent& event : test.record.events)
      {
        const EmissionRow row = emission_row(event, test.record.dimension());
        append_row(text, emission_columns, row, test.record.kind.sign);
        text.insert(text.size() - 1, fmt::format(",{},{}", test.name, row.source.kind));
      }
  write_whole_file(file, text);
}

std::string read_events(const std::filesystem::path& file, std::vector<FinishedTest>& tests)
{
  return read_rows_into<EmissionRow>(
    tests, file, emission_columns, [](EmissionRow&, const CsvReader&) {},
    [](TestRecord& record, const EmissionRow& row) { record.events.push_back(row.event); });
}

void write_minerals(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  std::string text =
    "test,step,axial_strain,mineral,share,n_grains,stress_xx_Pa,stress_xy_Pa,stress_xz_Pa,stress_yy_Pa,"
    "stress_yz_Pa,stress_zz_Pa,strain_xx,strain_xy,strain_xz,strain_yy,strain_yz,strain_zz,n_cracks_within,"
    "n_cracks_on_boundaries\n";
  const std::size_t n_of_header = text.size();
  for (const auto& test : tests)
    for (const Snapshot& snapshot : test.appearance.snapshots)
      {
        const auto means = mineral_means(test.record, snapshot, test.appearance.grains_at_end);
        for (std::size_t k = 0; k < means.size(); ++k)
          {
            const MineralShare& of = test.record.minerals[k];
            fmt::format_to(std::back_inserter(text), "{},{},{:.9g},{},{:.9g},{},{:.9g},{:.9g},{},{}\n", test.name,
                           snapshot.step, test.record.kind.sign * snapshot.axial_strain + 0.0, of.mineral.name,
                           of.share, of.n_grains, fmt::join(means[k].stress, ","), fmt::join(means[k].strain, ","),
                           means[k].n_cracks_within, means[k].n_cracks_on_boundaries);
          }
      }
  if (text.size() > n_of_header)
    write_whole_file(file, text);
}

void write_steps(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  constexpr double round_off = 1e-8; // a smaller residual is noise of the sums that it is made of
  std::string text = "test,step,axial_strain,iterations,residual,cascades,cuts\n";
  bool any = false;
  for (const auto& test : tests)
    if (const auto& work = test.bookkeeping.solver_work)
      for (const SolverStep& step : work->steps)
        {
          any = true;
          const double strain = test.record.kind.sign * step.axial_strain;
          fmt::format_to(std::back_inserter(text), "{},{},{:.9g},{},{:.1e},{},{}\n", test.name, step.step,
                         strain == 0.0 ? 0.0 : strain, step.n_iterations, std::max(step.residual, round_off),
                         step.n_cascades, step.n_cuts);
        }
  if (any)
    write_whole_file(file, text);
}

std::string group_name(const TestRecord& test) { return test.specimen.n_clumps > 0 ? "clump" : "mineral_grain"; }

void write_grains(const std::vector<GrainPicture>& grains, const std::filesystem::path& file, const std::string& group)
{
  std::string text;
  const auto columns = grain_columns(group);
  append_names(text, columns);
  for (const auto& grain : grains)
    append_row(text, columns, grain, 1.0);
  write_whole_file(file, text);
}

TableRows<GrainPicture> read_grains(const std::filesystem::path& file)
{
  CsvReader table(file);
  const auto columns = grain_columns(table.has("clump") ? "clump" : "mineral_grain");
  const auto places = places_of(table, columns);
  Gaps gaps;
  TableRows<GrainPicture> grains;
  while (table.next())
    {
      const std::size_t n_gaps = gaps.n;
      const GrainPicture grain = row_of<GrainPicture>(table, columns, places, 1.0, gaps);
      if (gaps.n == n_gaps)
        grains.rows.push_back(grain);
    }
  grains.remark = gaps.remark(file);
  return grains;
}

namespace
{
/// Text of a cell, with quotes where a reader of CSV needs them.
std::string cell(const std::string& text)
{
  if (text.find_first_of(",\"\n\r") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}
} // namespace

void write_tests(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  const auto settings = mapped<std::vector<VariantSetting>>(tests, [](const auto& test) { return test.settings; });
  const std::vector<VariedColumn> varied = varied_columns(settings);
  std::string text = "name,kind,seed";
  for (const VariedColumn& column : varied)
    text += fmt::format(",{}", cell(column.heading()));
  for (const TestQuantity& quantity : test_quantities)
    text += fmt::format(",{}", quantity.name);
  text += "\n";
  for (const auto& test : tests)
    {
      text += fmt::format("{},{},{}", cell(test.name), test.record.kind.name, test.record.seed);
      for (const VariedColumn& column : varied)
        text += fmt::format(",{}", cell(column.cell(test.settings)));
      for (const TestQuantity& quantity : test_quantities)
        {
          const Figure figure = value_of(quantity, test);
          text += figure.value && std::isfinite(*figure.value) ? fmt::format(",{:.10g}", *figure.value) : ",";
        }
      text += "\n";
    }
  write_whole_file(file, text);
}
} // namespace feldspar
