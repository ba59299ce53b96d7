#include "results/folder/result_folder.h"

#include "base/colour.h"
#include "base/input_error.h"
#include "base/json_text.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "results/folder/csv_tables.h"
#include "results/folder/provenance_json.h"
#include "results/sample_fields.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr std::size_t most_characters_of_name = 180; ///< of a test; pictures add to it

std::optional<TestKind> kind_named(const std::string_view wanted, const std::vector<TestKind>& known)
{
  const auto kind = std::ranges::find(known, wanted, &TestKind::name);
  return kind == known.end() ? std::nullopt : std::optional(*kind);
}

Json read_summary(const std::filesystem::path& folder)
{
  const std::filesystem::path file = folder / result_file::summary;
  if (!std::filesystem::exists(file))
    throw InputError("{}: no result folder: there is no {} in it", folder.string(), result_file::summary);
  Json json = parse_json(file.string(), content_of(file));
  if (!json.contains("tests") || !json["tests"].is_array())
    throw InputError("{}: there is no list of \"tests\" in it", file.string());
  return json;
}

/// Flaws that are described as this program does it; they are for pictures alone.
std::vector<FlawPicture> flaws_of(const Json& json)
{
  std::vector<FlawPicture> flaws;
  const auto described = json.find("flaws");
  if (described == json.end() || !described->is_array())
    return flaws;
  for (const auto& one : *described)
    try
      {
        flaws.push_back({one.at("name").get<std::string>(), one.at("open").get<bool>(),
                         one.at("outline_m").get<std::vector<std::array<double, 3>>>()});
      }
    catch (const Json::exception&)
      {
        continue;
      }
  return flaws;
}

/// A member as `read` makes it; `otherwise` where it is not there, or one of its own members is missing.
template <typename T, typename Read>
T member_or(const Json& json, const char* const key, const T& otherwise, const Read& read)
{
  try
    {
      return json.contains(key) ? T(read(json[key])) : otherwise;
    }
  catch (const Json::exception&)
    {
      return otherwise;
    }
}

/// Stages of a test that follows a loading table.
std::vector<StageRecord> stages_of(const Json& json)
{
  return member_or(json, "stages", std::vector<StageRecord>(), [](const Json& all) {
    return mapped<StageRecord>(all.is_array() ? all : Json::array(), [](const Json& one) {
      return StageRecord{one.at("target").get<std::string>(), one.at("confining_pressure_Pa").get<double>(),
                         one.at("first_row").get<std::uint64_t>(), one.at("last_row").get<std::uint64_t>(),
                         one.at("reached").get<bool>()};
    });
  });
}

/// Minerals of the rock; none where one is none of a mineral.
std::vector<MineralShare> minerals_of(const Json& json)
{
  return member_or(json, "minerals", std::vector<MineralShare>(), [](const Json& all) {
    std::vector<MineralShare> minerals;
    for (const Json& one : all.is_array() ? all : Json::array())
      {
        const auto name = one.at("name").get<std::string>();
        const auto colour = parse_colour(one.at("colour").get<std::string>());
        if (!is_plain_name(name) || !colour)
          return std::vector<MineralShare>();
        minerals.push_back({{name, *colour}, one.at("n_grains").get<std::uint64_t>(), one.at("share").get<double>()});
      }
    return minerals;
  });
}

/// Notch of the body of a test. Layouts from before lengths were written have none of them.
std::optional<NotchGeometry> notch_of(const Json& json)
{
  return member_or(json, "notch", std::optional<NotchGeometry>(), [](const Json& notch) {
    return NotchGeometry{.intensity_over_stress = notch.at("intensity_over_stress_sqrt_m").get<double>(),
                         .work_over_stress = notch.at("work_over_stress_m3").get<double>(),
                         .ligament_area = notch.at("ligament_area_m2").get<double>(),
                         .ligament_length = notch.value("ligament_length_m", std::numeric_limits<double>::quiet_NaN()),
                         .is_valid = notch.at("is_valid").get<bool>()};
  });
}

/// Demands on the peak of a test; the defaults in layouts from before demands were written.
PeakDemands peak_demands_of(const Json& json)
{
  return member_or(json, "peak_demands", PeakDemands(), [](const Json& demands) {
    return PeakDemands{.least_stress = demands.at("least_stress_Pa").get<double>(),
                       .least_time = demands.at("least_time_s").get<double>(),
                       .least_fall = demands.at("least_fall").get<double>(),
                       .end_over_peak_strain = demands.at("end_over_peak_strain").get<double>()};
  });
}

FinishedTest test_of(const Json& json, const TestKind& kind)
{
  FinishedTest test;
  test.record.kind = kind;
  test.name = text_of(json, "name");
  test.variant = text_of(json, "variant");
  if (const auto settings = json.find("variant_values"); settings != json.end())
    test.settings = read_settings(*settings);
  test.record.failure = text_of(json, "failure");
  test.record.ended_early = text_of(json, "ended_early");
  test.record.came_apart = json.contains("came_apart") && json["came_apart"] == true;
  if (text_of(json, "body") == name(TestBody::finite_elements)) // layouts from before bodies were written have grains
    test.record.body = TestBody::finite_elements;
  test.record.interrupted = json.contains("interrupted") && json["interrupted"] == true;
  if (const auto seed = json.find("seed"); seed != json.end() && seed->is_number_unsigned())
    test.record.seed = seed->get<std::uint64_t>();
  if (const auto size = json.find("size_m"); size != json.end() && size->is_array())
    for (std::size_t c = 0; c < std::min<std::size_t>(size->size(), 3); ++c)
      if ((*size)[c].is_number())
        test.record.size[c] = (*size)[c].get<double>();
  const auto number = [&](const char* const key, const std::optional<double>& otherwise) {
    return member_or(json, key, otherwise, [](const Json& value) { return value.get<double>(); });
  };
  test.record.intermediate_stress = number("intermediate_stress_Pa", {});
  test.record.normal_stiffness = number("normal_stiffness_Pa_per_m", {});
  test.appearance.flaws = flaws_of(json);
  test.record.stages = stages_of(json);
  test.record.notch = notch_of(json);
  test.record.minerals = minerals_of(json);
  test.record.peak_demands = peak_demands_of(json);
  test.record.way_to_grains = *number("way_to_grains_m", test.record.way_to_grains);
  for (const TestQuantity& quantity : test_quantities)
    {
      const std::string key(quantity.name);
      Figure figure{std::nullopt, "not in this result folder"};
      if (const auto found = json.find(key); found != json.end() && found->is_number())
        figure = {found->get<double>(), ""};
      else if (const std::string reason = text_of(json, key + "_reason"); !reason.empty())
        figure.reason = reason;
      set_value(quantity, test, figure);
    }
  test.record.peak_demands.stress_rate = std::isnan(test.record.stress_rate) ? 0.0 : test.record.stress_rate;
  if (kind.pressure_acts_across && !json.contains("normal_stress_at_peak_Pa")) // layouts from before it could change
    test.results.normal_stress_at_peak = {test.record.confining_pressure, ""};
  test.group = text_of(json, "group");
  if (test.group.empty()) // a layout from before groups were written
    test.group = test.name.substr(0, test.name.rfind("_seed_"));
  return test;
}

/// The RVE at a point of a sample as a test of its own; its name is that of its files, without ending.
FinishedTest part_of(const FinishedTest& sample, const PointRve& rve)
{
  FinishedTest part;
  part.name = fmt::format("{}_cell_{}_point_{}", sample.name, rve.cell, rve.point);
  part.record.kind = sample.record.kind;
  return part;
}

/// Writes an RVE by the tables that tests have.
void write_rve(const PointRve& rve, const FinishedTest& of, const std::filesystem::path& folder)
{
  FinishedTest part = part_of(of, rve);
  part.record.cracks = rve.cracks;
  write_grains(rve.grains, folder / (part.name + "_grains.csv"));
  write_cracks({part}, folder / (part.name + "_cracks.csv"));
}

/// The RVEs that a test keeps in its summary; layout 1 has them under another key.
Json rves_in(const Json& test)
{
  const auto rves = test.find(test.contains("rves") ? "rves" : "volumes");
  return rves != test.end() && rves->is_array() ? *rves : Json::array();
}

void add_unless_empty(std::vector<std::string>& problems, std::string remark)
{
  if (!remark.empty())
    problems.push_back(std::move(remark));
}

/// The rows of a table; a remark on them becomes a problem.
template <typename Row>
std::vector<Row> rows_of(TableRows<Row> table, std::vector<std::string>& problems)
{
  add_unless_empty(problems, std::move(table.remark));
  return std::move(table.rows);
}

PointRve read_rve(const Json& json, const FinishedTest& of, const std::filesystem::path& folder,
                  std::vector<std::string>& problems)
{
  PointRve rve;
  try
    {
      rve.which = json.at("which").get<std::string>();
      rve.cell = json.at("cell").get<unsigned int>();
      rve.point = json.at("point").get<unsigned int>();
      rve.position = json.at("position_m").get<std::array<double, 3>>();
      rve.n_segments = json.at("n_segments").get<std::uint64_t>();
    }
  catch (const Json::exception&)
    {
      throw InputError("{}: an RVE of {} is not described as this program does it",
                       (folder.parent_path() / result_file::summary).string(), of.name);
    }
  std::vector<FinishedTest> part{part_of(of, rve)};
  const std::string& name = part[0].name;
  rve.grains = rows_of(read_grains(folder / (name + "_grains.csv")), problems);
  add_unless_empty(problems, read_cracks(folder / (name + "_cracks.csv"), part));
  rve.cracks = std::move(part[0].record.cracks);
  return rve;
}

/// Runs a reader; what it objects to becomes a problem.
template <typename Read>
void try_to(std::vector<std::string>& problems, Read&& read)
{
  try
    {
      read();
    }
  catch (const InputError& error)
    {
      problems.push_back(printable(error.what()));
    }
}

/// A few problems of one kind as they are; of more the first, and how many there are.
void add_few(std::vector<std::string>& problems, const std::vector<std::string>& of_one_kind)
{
  constexpr std::size_t most = 20;
  if (of_one_kind.size() <= most)
    problems.insert(problems.end(), of_one_kind.begin(), of_one_kind.end());
  else
    problems.push_back(fmt::format("{} (and {} more like it)", of_one_kind.front(), of_one_kind.size() - 1));
}
} // namespace

void write_result_folder(const Provenance& made_by, const std::vector<FinishedTest>& tests,
                         const RunEnvelopes& envelopes, const std::filesystem::path& folder)
{
  std::filesystem::create_directories(folder / result_file::curves);
  if (std::ranges::any_of(tests, [](const auto& test) { return test.record.body == TestBody::grains; }))
    std::filesystem::create_directories(folder / result_file::grains);
  if (std::ranges::any_of(tests, [](const auto& test) { return !test.appearance.rves.empty(); }))
    std::filesystem::create_directories(folder / result_file::points);
  for (const auto& test : tests)
    {
      write_curve(test.record, folder / result_file::curves / (test.name + ".csv"));
      if (test.record.body == TestBody::grains)
        write_grains(test.appearance.grains_at_end, folder / result_file::grains / (test.name + ".csv"),
                     group_name(test.record));
      for (const auto& rve : test.appearance.rves)
        write_rve(rve, test, folder / result_file::points);
    }
  write_cracks(tests, folder / result_file::cracks);
  write_events(tests, folder / result_file::emission);
  write_minerals(tests, folder / result_file::minerals);
  write_steps(tests, folder / result_file::steps);
  write_tests(tests, folder / result_file::tests);
  write_summary(made_by, tests, envelopes, folder / result_file::summary);
}

std::vector<Series> read_result_folder(const std::filesystem::path& folder, const std::vector<TestKind>& kinds)
{
  const Json json = read_summary(folder);
  std::vector<std::string> problems;
  const auto version = json.find("schema_version");
  const bool is_whole = version != json.end() && version->is_number_integer() &&
                        *version >= oldest_summary_schema_version && *version <= summary_schema_version;
  if (!is_whole)
    problems.push_back(fmt::format("{} has layout {}; this program writes layout {}, so figures may be missing here",
                                   (folder / result_file::summary).string(),
                                   version == json.end() ? "unknown" : excerpt(version->dump()),
                                   summary_schema_version));

  std::vector<FinishedTest> tests;
  std::vector<std::string> of_kinds, of_names, of_tables, of_stages;
  const std::string summary = printable((folder / result_file::summary).string());
  for (const auto& entry : json["tests"])
    {
      const auto kind = entry.is_object() ? kind_named(text_of(entry, "kind"), kinds) : std::nullopt;
      const std::string name = entry.is_object() ? text_of(entry, "name") : "";
      if (!kind)
        of_kinds.push_back(fmt::format("{}: a test of a kind this program does not know was left out", summary));
      else if (!is_plain_name(name) || name.size() > most_characters_of_name)
        // Tables and pictures are named by it, and a path would lead out of the folder.
        of_names.push_back(fmt::format("{}: a test was left out for its name, {}; names have 1 to {} letters, digits "
                                       "or ._-+ and begin with a letter or a digit",
                                       summary, in_quotes(name), most_characters_of_name));
      else
        tests.push_back(test_of(entry, *kind));
    }
  if (tests.empty())
    throw InputError("{}: there is no test in it", (folder / result_file::summary).string());

  for (auto& test : tests)
    {
      const std::string table = test.name + ".csv";
      if (!test.record.failure.empty() && !std::filesystem::exists(folder / result_file::curves / table))
        continue; // it could not be made
      try_to(of_tables, [&] {
        test.record.curve = rows_of(read_curve(folder / result_file::curves / table, test.record.kind), of_tables);
      });
      if (std::ranges::any_of(test.record.stages, [&](const StageRecord& stage) {
            return stage.first_row > stage.last_row || stage.last_row >= test.record.curve.size();
          }))
        {
          test.record.stages.clear();
          if (!test.record.curve.empty()) // a table that is missing has been reported
            of_stages.push_back(fmt::format("{}: the stages of {} are not those of its curve", summary, test.name));
        }
      if (test.record.body == TestBody::grains)
        try_to(of_tables, [&] {
          test.appearance.grains_at_end = rows_of(read_grains(folder / result_file::grains / table), of_tables);
        });
      else if (std::filesystem::exists(folder / result_file::fields /
                                       (test.name + ".xdmf"))) // large: may be thrown away
        try_to(of_tables, [&] {
          constexpr std::size_t most_cells = 20'000; // of all times; the page has some 200 bytes for each
          test.appearance.fields = read_sample_fields(folder / result_file::fields, test.name);
          test.appearance.fields_before =
            read_earlier_sample_fields(folder / result_file::fields, test.name, most_cells);
        });
    }
  std::multimap<std::string_view, FinishedTest*> by_name;
  for (auto& test : tests)
    by_name.emplace(test.name, &test);
  for (const auto& entry : json["tests"])
    if (entry.is_object())
      {
        const std::string name = text_of(entry, "name");
        for (auto [named, end] = by_name.equal_range(name); named != end; ++named)
          for (const auto& rve : rves_in(entry))
            try_to(of_tables, [&, &test = *named->second] {
              test.appearance.rves.push_back(read_rve(rve, test, folder / result_file::points, of_tables));
            });
      }
  try_to(of_tables, [&] { add_unless_empty(of_tables, read_cracks(folder / result_file::cracks, tests)); });
  if (std::filesystem::exists(folder / result_file::emission))
    try_to(of_tables, [&] { add_unless_empty(of_tables, read_events(folder / result_file::emission, tests)); });
  for (const auto& of_one_kind : {of_kinds, of_names, of_tables, of_stages})
    add_few(problems, of_one_kind);

  const std::filesystem::path whole = std::filesystem::absolute(folder);
  const std::string label = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  std::vector<Series> all;
  std::map<std::string, std::size_t> place_of; // of the series of a label
  for (auto& test : tests)
    {
      const auto [place, is_new] = place_of.emplace(test.variant.empty() ? label : test.variant, all.size());
      if (is_new)
        all.push_back({place->first, kind_of_series(test.record.body), read_provenance(json), {}, {}});
      all[place->second].tests.push_back(std::move(test));
    }
  all.front().problems = problems;
  return all;
}
} // namespace feldspar
