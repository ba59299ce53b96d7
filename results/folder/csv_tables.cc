#include "results/folder/csv_tables.h"

#include "base/quoted.h"
#include "base/table/csv.h"
#include "base/whole_file.h"
#include "results/folder/table_columns.h"
#include "results/minerals.h"

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
class Gaps
{
public:
  /// `fate`: what becomes of their rows, in words.
  Gaps(const std::filesystem::path& of_file, const std::string_view of_rows)
    : file(of_file.string())
    , fate(of_rows)
  {
  }

  void add(const CsvReader& table, const std::size_t column)
  {
    if (n == 0)
      first = fmt::format("line {}: {} is {}", table.line_of_row(), excerpt(table.name_of(column)),
                          excerpt(table.text(column)));
    ++n;
  }

  std::size_t number() const { return n; }

  std::string remark() const
  {
    if (n == 0)
      return "";
    return fmt::format("{}: {}{}, no finite number; {}", printable(file), first,
                       n > 1 ? fmt::format(" (and {} more such cell{})", n - 1, n > 2 ? "s" : "") : "", fate);
  }

private:
  std::string file;
  std::string_view fate;
  std::string first;
  std::size_t n = 0;
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

constexpr std::string_view left_out = "rows with such cells are left out";
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
  Gaps gaps(file, "curves have gaps there");
  TableRows<CurveSample> curve;
  while (table.next())
    curve.rows.push_back(row_of<CurveSample>(table, curve_columns, places, kind.sign, gaps));
  curve.remark = gaps.remark();
  return curve;
}

namespace
{
std::string header_of_cracks()
{
  std::string text = "test,kind,";
  append_names(text, crack_columns);
  return text;
}

void append_cracks(std::string& text, const std::vector<Crack>& cracks, const std::string& name, const TestKind& kind)
{
  for (const auto& crack : cracks)
    {
      fmt::format_to(std::back_inserter(text), "{},{},", name, kind_name(crack.kind));
      append_row(text, crack_columns, crack, kind.sign);
    }
}

/// The test that a row belongs to, and the place of its rows.
template <typename Row>
struct RowsOfTest
{
  std::string_view name;
  TestKind kind;
  std::vector<Row>* rows;
};

/// Gives each row to the test that it names; complete(row, table) adds what is no number.
template <typename Row, typename Columns, typename Complete>
std::string read_rows_into(const std::filesystem::path& file, const Columns& columns,
                           const std::vector<RowsOfTest<Row>>& tests, const Complete& complete)
{
  CsvReader table(file);
  const std::size_t name = table.place("test");
  const auto places = places_of(table, columns);
  std::map<std::string_view, const RowsOfTest<Row>*> by_name;
  for (const auto& test : tests)
    by_name[test.name] = &test;
  Gaps gaps(file, left_out);
  while (table.next())
    if (const auto found = by_name.find(table.text(name)); found != by_name.end())
      {
        const std::size_t n_gaps = gaps.number();
        Row row = row_of<Row>(table, columns, places, found->second->kind.sign, gaps);
        complete(row, table);
        if (gaps.number() == n_gaps)
          found->second->rows->push_back(row);
      }
  return gaps.remark();
}

std::string read_cracks_into(const std::filesystem::path& file, const std::vector<RowsOfTest<Crack>>& tests)
{
  return read_rows_into(file, crack_columns, tests, [](Crack& crack, const CsvReader& table) {
    crack.kind =
      table.text(table.place("kind")) == kind_name(CrackKind::tension) ? CrackKind::tension : CrackKind::shear;
  });
}
} // namespace

void write_cracks(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  std::string text = header_of_cracks();
  for (const auto& test : tests)
    append_cracks(text, test.record.cracks, test.name, test.record.kind);
  write_whole_file(file, text);
}

void write_cracks(const std::vector<Crack>& cracks, const std::string& name, const TestKind& kind,
                  const std::filesystem::path& file)
{
  std::string text = header_of_cracks();
  append_cracks(text, cracks, name, kind);
  write_whole_file(file, text);
}

std::string read_cracks(const std::filesystem::path& file, std::vector<FinishedTest>& tests)
{
  std::vector<RowsOfTest<Crack>> all;
  for (auto& test : tests)
    all.push_back({test.name, test.record.kind, &test.record.cracks});
  return read_cracks_into(file, all);
}

TableRows<Crack> read_cracks(const std::filesystem::path& file, const std::string& name, const TestKind& kind)
{
  TableRows<Crack> cracks;
  cracks.remark = read_cracks_into(file, {{name, kind, &cracks.rows}});
  return cracks;
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
  std::vector<std::vector<EmissionRow>> rows(tests.size());
  std::vector<RowsOfTest<EmissionRow>> all;
  for (std::size_t k = 0; k < tests.size(); ++k)
    all.push_back({tests[k].name, tests[k].record.kind, &rows[k]});
  std::string remark = read_rows_into(file, emission_columns, all, [](EmissionRow&, const CsvReader&) {});
  for (std::size_t k = 0; k < tests.size(); ++k)
    for (const EmissionRow& row : rows[k])
      tests[k].record.events.push_back(row.event);
  return remark;
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
  Gaps gaps(file, left_out);
  TableRows<GrainPicture> grains;
  while (table.next())
    {
      const std::size_t n_gaps = gaps.number();
      const GrainPicture grain = row_of<GrainPicture>(table, columns, places, 1.0, gaps);
      if (gaps.number() == n_gaps)
        grains.rows.push_back(grain);
    }
  grains.remark = gaps.remark();
  return grains;
}
} // namespace feldspar
