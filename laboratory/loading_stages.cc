#include "laboratory/loading_stages.h"

#include "base/contains.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/table/csv.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::array<std::string_view, 6> columns{"axial_strain",          "axial_stress_Pa",   "hold_s",
                                                  "confining_pressure_Pa", "strain_rate_per_s", "lateral_strain"};

/// Beyond the stiffness of any rock [Pa].
constexpr double largest_stress = 1e11;
/// Twelve days [s]; grains take some 1e14 steps for it, a sample of finite elements as few as its rate says.
constexpr double longest_hold = 1e6;

/// The places of the columns that a table has, which must be of these.
std::array<std::optional<std::size_t>, columns.size()> places_in(CsvReader& table, const std::string& file)
{
  std::array<std::optional<std::size_t>, columns.size()> places;
  for (std::size_t k = 0; k < columns.size(); ++k)
    places[k] = table.find_in_si(columns[k]);
  for (std::size_t c = 0; c < table.header().size(); ++c)
    if (!table.name_of(c).empty() && !contains(places, c))
      throw InputError("{}:{}: {} is no column of a loading table; they are {}, or have their unit in "
                       "brackets, as in \"axial_stress [MPa]\"",
                       file, table.line_of_header(), in_quotes(table.name_of(c)), fmt::join(columns, ", "));
  return places;
}

} // namespace

std::string objection(const LoadingStage& stage, const LoadingStage* const before)
{
  for (const auto& [column, stress] :
       {std::pair(columns[1], stage.axial_stress.value_or(0.0)), {columns[3], stage.confining_pressure}})
    if (stress > 0.0 && (stress < 1e3 || stress > largest_stress))
      return fmt::format("{} = {:g} is {}; stresses of the table are in Pa, 60 MPa is 60e6", column, stress,
                         stress < 1e3 ? "less than 1 kPa" : "more than 100 GPa");
  if (stage.axial_strain && stage.axial_stress)
    return "axial_strain and axial_stress_Pa are both given; a stage ends at one of them";
  if (stage.lateral_strain && (stage.axial_strain || stage.axial_stress || stage.duration))
    return "lateral_strain and another target are both given; a stage led by the lateral strain ends at it";
  if (!stage.axial_strain && !stage.axial_stress && !stage.duration && !stage.lateral_strain)
    return "has no target; give axial_strain, axial_stress_Pa, hold_s or lateral_strain";
  if (stage.lateral_strain && !(*stage.lateral_strain < 0.0 && *stage.lateral_strain >= -largest_axial_strain))
    return fmt::format(
      "lateral_strain = {:g}: must lie in [{}, 0); compression is positive, a specimen that widens has "
      "a negative one",
      *stage.lateral_strain, -largest_axial_strain);
  if (stage.lateral_strain && !stage.strain_rate)
    return "lateral_strain needs strain_rate_per_s, of itself; at a fifth of an axial rate most rock is shortened as fast "
           "at first";
  if (stage.lateral_strain && before && before->lateral_strain && *stage.lateral_strain >= *before->lateral_strain)
    return fmt::format(
      "lateral_strain = {:g}: must be below {:g} of the stage before; a broken specimen does not narrow",
      *stage.lateral_strain, *before->lateral_strain);
  if (stage.axial_strain && stage.duration)
    return "axial_strain and hold_s are both given; a hold keeps the platens, or an axial_stress_Pa";
  if (stage.axial_strain && !(*stage.axial_strain >= 0.0 && *stage.axial_strain <= largest_axial_strain))
    return fmt::format("axial_strain = {:g}: must lie in [0, {}]; compression is positive", *stage.axial_strain,
                       largest_axial_strain);
  if (stage.axial_stress && !(*stage.axial_stress >= 0.0))
    return fmt::format("axial_stress_Pa = {:g}: must be at least 0; platens press and cannot pull",
                       *stage.axial_stress);
  if (stage.duration && stage.axial_stress && *stage.axial_stress == 0.0)
    return "axial_stress_Pa = 0 cannot be held; platens that touch nothing have no stress to follow";
  if (stage.duration && !(*stage.duration > 0.0 && *stage.duration <= longest_hold))
    return fmt::format("hold_s = {:g}: must lie in (0, {:g}]", *stage.duration, longest_hold);
  if (!(stage.confining_pressure >= 0.0))
    return fmt::format("confining_pressure_Pa = {:g}: must be at least 0; compression is positive",
                       stage.confining_pressure);
  if (stage.strain_rate && !(*stage.strain_rate > 0.0))
    return fmt::format("strain_rate_per_s = {:g}: must be above 0; the target gives the direction", *stage.strain_rate);
  if (before && (before->confining_pressure > 0.0) != (stage.confining_pressure > 0.0))
    return "confining_pressure_Pa is 0 in some stages and not in others; a wall that presses on nothing cannot be held";
  if (before && stage.axial_stress && !stage.duration && stage.confining_pressure != before->confining_pressure)
    return "changes confining_pressure_Pa on the way to an axial stress; change it in a hold or on the way to a strain";
  return "";
}

std::vector<Entry<TestParameters>> loading_table_entries()
{
  using P = LoadingTable;
  using namespace tests_flags;
  return within_tests<P>({entry::file(
    "Loading table", &P::file,
    "CSV of the stages of own_loading, a row each, with the columns axial_strain, axial_stress_Pa, hold_s, "
    "confining_pressure_Pa, strain_rate_per_s, lateral_strain, or with units, as in axial_stress [MPa]; compression positive; on a sample of finite elements "
    "rates only say how long a strain takes beside a hold",
    as_basic(of_platens))});
}

std::vector<LoadingStage> read_loading_stages(const std::filesystem::path& path)
{
  const std::string file = path.string();
  CsvReader table(path);
  const auto places = places_in(table, file);
  std::vector<LoadingStage> stages;
  while (table.next())
    {
      const auto cell = [&](const std::size_t column) -> std::optional<double> {
        if (!places[column] || table.text(*places[column]).empty())
          return std::nullopt;
        return table.number(*places[column]);
      };
      LoadingStage stage;
      stage.axial_strain = cell(0);
      stage.axial_stress = cell(1);
      stage.duration = cell(2);
      stage.confining_pressure = cell(3).value_or(stages.empty() ? 0.0 : stages.back().confining_pressure);
      stage.strain_rate = cell(4);
      stage.lateral_strain = cell(5);
      if (const std::string what = objection(stage, stages.empty() ? nullptr : &stages.back()); !what.empty())
        throw InputError("{}:{}: stage {}: {}", file, table.line_of_row(), stages.size() + 1, what);
      stages.push_back(stage);
    }
  if (stages.empty())
    throw InputError("{}: there is no stage below the header", file);
  return stages;
}

std::string words(const LoadingStage& stage)
{
  const std::string stress = stage.axial_stress ? fmt::format("axial stress {:g} MPa", *stage.axial_stress / 1e6) : "";
  if (stage.duration)
    return fmt::format("hold of {:g} s{}", *stage.duration, stage.axial_stress ? " at " + stress : "");
  if (stage.lateral_strain)
    return fmt::format("lateral strain {:g}", *stage.lateral_strain);
  return stage.axial_strain ? fmt::format("axial strain {:g}", *stage.axial_strain) : stress;
}

std::string full_text(const LoadingStage& stage)
{
  const auto text = [](const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "none"; };
  return fmt::format("{},{},{},{},{},{}\n", text(stage.axial_strain), text(stage.axial_stress), text(stage.duration),
                     stage.confining_pressure, text(stage.strain_rate), text(stage.lateral_strain));
}
} // namespace feldspar
