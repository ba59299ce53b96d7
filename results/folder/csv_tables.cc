#include "results/folder/csv_tables.h"

#include "base/csv.h"
#include "base/quoted.h"
#include "base/whole_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace feldspar
{
namespace
{
/// A column by its name, with where its number is in a row. `laboratory`: changes sign to be positive in the sense of
/// the test; `added`: tables of before it was added do without, and it is 0; `of_samples`: only curves of samples of finite
/// elements have it; `may_be_nan`: a body may not have it, as a gauge with too few grains.
template <typename Row>
struct Column
{
  std::string_view name;
  std::function<double(const Row&)> get;
  std::function<void(Row&, double)> set;
  bool laboratory = false;
  bool added = false;
  bool of_samples = false;
  bool may_be_nan = false;
  double most = 0.0; ///< of a count or a number of something, the largest that is one; 0 of what need not be whole
};

/// `part` gives the number's place in a row.
template <typename Row, typename Part>
Column<Row> column(const std::string_view name, const Part& part, const bool laboratory = false)
{
  using Number = std::remove_cvref_t<decltype(part(std::declval<Row&>()))>;
  return {name,
          [=](const Row& row) { return double(part(row)); },
          [=](Row& row, const double value) {
            auto& place = part(row);
            place = Number(value);
          },
          laboratory,
          false,
          false,
          false,
          std::is_integral_v<Number> ? std::min(0x1p53, double(std::numeric_limits<Number>::max())) : 0.0};
}

template <typename Row, typename T>
Column<Row> column(const std::string_view name, T Row::*member, const bool laboratory = false)
{
  return column<Row>(
    name, [member](auto& row) -> auto& { return row.*member; }, laboratory);
}

Column<CurveSample> perhaps_nan(Column<CurveSample> column)
{
  column.may_be_nan = true;
  return column;
}

Column<CurveSample> energy(const std::string_view name, double Energies::*member)
{
  return perhaps_nan(column<CurveSample>(
    name, [member](auto& row) -> auto& { return row.energies.*member; }));
}

template <typename Row, std::size_t n>
Column<Row> coordinate(const std::string_view name, std::array<double, n> Row::*member, const std::size_t c)
{
  return column<Row>(
    name, [=](auto& row) -> auto& { return (row.*member)[c]; });
}

template <typename Row>
Column<Row> added(Column<Row> column)
{
  column.added = true;
  return column;
}

Column<CurveSample> of_samples(Column<CurveSample> column)
{
  column.of_samples = true;
  return added(column);
}

const std::vector<Column<CurveSample>>& curve_columns()
{
  static const std::vector<Column<CurveSample>> columns{
    column<CurveSample>("step", &CurveSample::step), column<CurveSample>("time_s", &CurveSample::time),
    column<CurveSample>("axial_strain", &CurveSample::axial_strain, true),
    column<CurveSample>("axial_stress_Pa", &CurveSample::axial_stress, true),
    column<CurveSample>("end_stress_difference_Pa", &CurveSample::end_stress_difference, true),
    column<CurveSample>("lateral_stress_Pa", &CurveSample::lateral_stress, true),
    column<CurveSample>("mid_stress_Pa", &CurveSample::mid_stress, true),
    perhaps_nan(column<CurveSample>("gauge_axial_strain", &CurveSample::gauge_axial_strain, true)),
    perhaps_nan(column<CurveSample>("gauge_lateral_strain", &CurveSample::gauge_lateral_strain, true)),
    perhaps_nan(column<CurveSample>("gauge_volumetric_strain", &CurveSample::gauge_volumetric_strain, true)),
    column<CurveSample>("n_tension_cracks", &CurveSample::n_tension_cracks),
    column<CurveSample>("n_shear_cracks", &CurveSample::n_shear_cracks),
    column<CurveSample>("unbalanced_force_ratio", &CurveSample::unbalanced_force_ratio),
    energy("boundary_work_J", &Energies::boundary_work), energy("kinetic_energy_J", &Energies::kinetic),
    energy("strain_energy_J", &Energies::strain), energy("slip_energy_J", &Energies::slip),
    energy("released_energy_J", &Energies::released), energy("damping_energy_J", &Energies::damping),
    added(energy("kinetic_energy_at_start_J", &Energies::kinetic_at_start)),
    // The boundary work by the name of what does it on a sample: reactions of the platens, pressures on the sides.
    of_samples(energy("platen_work_J", &Energies::boundary_work)),
    of_samples(energy("redistribution_energy_J", &Energies::redistribution))};
  return columns;
}

std::vector<Column<CurveSample>> curve_columns(const TestBody body)
{
  std::vector<Column<CurveSample>> columns = curve_columns();
  if (body != TestBody::finite_elements)
    std::erase_if(columns, [](const auto& column) { return column.of_samples; });
  return columns;
}

/// All but the name of the test and the kind.
const std::vector<Column<Crack>>& crack_columns()
{
  static const std::vector<Column<Crack>> columns{column<Crack>("joint", &Crack::joint),
                                                  column<Crack>("segment", &Crack::segment),
                                                  column<Crack>("step", &Crack::step),
                                                  column<Crack>("axial_strain", &Crack::axial_strain, true),
                                                  coordinate("x_m", &Crack::centroid, 0),
                                                  coordinate("y_m", &Crack::centroid, 1),
                                                  coordinate("z_m", &Crack::centroid, 2),
                                                  coordinate("normal_x", &Crack::normal, 0),
                                                  coordinate("normal_y", &Crack::normal, 1),
                                                  coordinate("normal_z", &Crack::normal, 2),
                                                  column<Crack>("size_m", &Crack::size),
                                                  column<Crack>("released_energy_J", &Crack::released_energy),
                                                  added(column<Crack>("on_smooth_joint", &Crack::on_smooth_joint))};
  return columns;
}

/// `group`: the name of the column of the groups, which outlives the columns.
std::vector<Column<GrainPicture>> grain_columns(const std::string_view group)
{
  return {coordinate("start_x_m", &GrainPicture::start, 0),
          coordinate("start_y_m", &GrainPicture::start, 1),
          coordinate("start_z_m", &GrainPicture::start, 2),
          coordinate("x_m", &GrainPicture::position, 0),
          coordinate("y_m", &GrainPicture::position, 1),
          coordinate("z_m", &GrainPicture::position, 2),
          column<GrainPicture>("radius_m", &GrainPicture::radius),
          column<GrainPicture>("fragment", &GrainPicture::fragment),
          added(column<GrainPicture>(group, &GrainPicture::mineral))};
}

const char* kind_name(const CrackKind kind) { return kind == CrackKind::tension ? "tension" : "shear"; }

template <typename Row>
void append_names(std::string& text, const std::vector<Column<Row>>& columns)
{
  for (const auto& one : columns)
    fmt::format_to(std::back_inserter(text), "{}{}", &one == columns.data() ? "" : ",", one.name);
  text += '\n';
}

template <typename Row>
void append_row(std::string& text, const std::vector<Column<Row>>& columns, const Row& row, const double sign)
{
  for (const auto& one : columns)
    fmt::format_to(std::back_inserter(text), "{}{}", &one == columns.data() ? "" : ",",
                   one.laboratory ? sign * one.get(row) : one.get(row));
  text += '\n';
}

/// Where the columns stand in this table.
template <typename Row>
std::vector<std::optional<std::size_t>> places_of(const CsvReader& table, const std::vector<Column<Row>>& columns)
{
  std::vector<std::optional<std::size_t>> places;
  for (const auto& one : columns)
    places.push_back(one.added && !table.has(one.name) ? std::nullopt : std::optional(table.place(one.name)));
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

template <typename Row>
Row row_of(const CsvReader& table, const std::vector<Column<Row>>& columns,
           const std::vector<std::optional<std::size_t>>& places, const double sign, Gaps& gaps)
{
  Row row{};
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (places[k])
      {
        const double value =
          columns[k].most > 0.0 ? table.count(*places[k], columns[k].most) : table.number_or_nan(*places[k]);
        if (std::isinf(value) || (std::isnan(value) && !columns[k].may_be_nan))
          gaps.add(table, *places[k]);
        columns[k].set(row, columns[k].laboratory ? sign * value : value);
      }
  return row;
}

constexpr std::string_view left_out = "rows with such cells are left out";
} // namespace

void write_curve(const TestRecord& record, const std::filesystem::path& file)
{
  const auto columns = curve_columns(record.body);
  std::string text;
  append_names(text, columns);
  for (const auto& row : record.curve)
    append_row(text, columns, row, record.kind.sign);
  write_whole_file(file, text);
}

TableRows<CurveSample> read_curve(const std::filesystem::path& file, const TestKind& kind)
{
  CsvReader table(file);
  const auto places = places_of(table, curve_columns());
  Gaps gaps(file, "curves have gaps there");
  TableRows<CurveSample> curve;
  while (table.next())
    curve.rows.push_back(row_of(table, curve_columns(), places, kind.sign, gaps));
  curve.remark = gaps.remark();
  return curve;
}

namespace
{
std::string header_of_cracks()
{
  std::string text = "test,kind,";
  append_names(text, crack_columns());
  return text;
}

void append_cracks(std::string& text, const std::vector<Crack>& cracks, const std::string& name, const TestKind& kind)
{
  for (const auto& crack : cracks)
    {
      fmt::format_to(std::back_inserter(text), "{},{},", name, kind_name(crack.kind));
      append_row(text, crack_columns(), crack, kind.sign);
    }
}

/// Cracks of one test.
struct CracksOfTest
{
  std::string_view name;
  TestKind kind;
  std::vector<Crack>* cracks;
};

std::string read_cracks_into(const std::filesystem::path& file, const std::vector<CracksOfTest>& tests)
{
  CsvReader table(file);
  const std::size_t name = table.place("test");
  const std::size_t kind = table.place("kind");
  const auto places = places_of(table, crack_columns());
  std::map<std::string_view, const CracksOfTest*> by_name;
  for (const auto& test : tests)
    by_name[test.name] = &test;
  Gaps gaps(file, left_out);
  while (table.next())
    if (const auto found = by_name.find(table.text(name)); found != by_name.end())
      {
        const std::size_t n_gaps = gaps.number();
        Crack crack = row_of(table, crack_columns(), places, found->second->kind.sign, gaps);
        crack.kind = table.text(kind) == kind_name(CrackKind::tension) ? CrackKind::tension : CrackKind::shear;
        if (gaps.number() == n_gaps)
          found->second->cracks->push_back(crack);
      }
  return gaps.remark();
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
  std::vector<CracksOfTest> all;
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
      const GrainPicture grain = row_of(table, columns, places, 1.0, gaps);
      if (gaps.number() == n_gaps)
        grains.rows.push_back(grain);
    }
  grains.remark = gaps.remark();
  return grains;
}
} // namespace feldspar
