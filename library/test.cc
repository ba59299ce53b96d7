#include "app/programme/checks.h"
#include "base/checksum/fingerprint.h"
#include "base/mapped.h"
#include "base/system/hdf5_archive.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "feldspar_version.h"
#include "laboratory/curve.h"
#include "laboratory/loading_stages.h"
#include "library/states.h"
#include "results/fits/strength_envelopes.h"
#include "results/folder/csv_tables.h"
#include "results/folder/result_folder.h"
#include "results/folder/table_columns.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>

namespace feldspar::v1
{
std::string fit_envelopes(const std::span<const double> sigma_3, const std::span<const double> sigma_1,
                          const std::optional<double> tensile_strength)
{
  return guarded([&] {
    if (sigma_3.size() != sigma_1.size())
      throw InputError("{} values of sigma_3 have {} of sigma_1; there must be one each", sigma_3.size(),
                       sigma_1.size());
    StrengthData data;
    data.tensile_strength = tensile_strength;
    for (std::size_t k = 0; k < sigma_3.size(); ++k)
      {
        if (!(std::isfinite(sigma_3[k]) && std::isfinite(sigma_1[k]) && sigma_1[k] > sigma_3[k]))
          throw InputError("point {}: sigma_1 = {:g} Pa must be above sigma_3 = {:g} Pa", k, sigma_1[k], sigma_3[k]);
        data.points.push_back({sigma_3[k], sigma_1[k]});
        if (sigma_3[k] == 0.0)
          data.uniaxial_compressive_strength = sigma_1[k];
      }
    return envelopes_as_text(fit_strength_envelopes(data));
  });
}

namespace
{
std::vector<feldspar::Column<CurveSample>> shown_columns()
{
  std::vector<feldspar::Column<CurveSample>> columns;
  std::copy_if(std::begin(curve_columns), std::end(curve_columns), std::back_inserter(columns),
               [](const auto& column) { return !column.is(only_of_samples); });
  return columns;
}

TestKind kind_of(const std::string_view name)
{
  const std::vector<TestKind>& kinds = test_kinds();
  const auto found = std::ranges::find(kinds, name, &TestKind::name);
  if (found == kinds.end())
    throw InputError("{}: no such test; there are {}", name, names(kinds));
  return *found;
}

LoadingStage stage_of(const Stage& stage)
{
  return {stage.axial_strain, stage.axial_stress,       stage.lateral_strain,
          stage.duration,     stage.confining_pressure, stage.strain_rate};
}

void check_stage(const LoadingStage& stage, const LoadingStage& before)
{
  if (const std::string what = objection(stage, &before); !what.empty())
    throw InputError(what);
}

/// A number that two tests hardly share: entries, grains and joints.
std::uint64_t fingerprint_of(const Specimen& specimen, const Input& input)
{
  Fingerprint print;
  for (const auto& [entry, value] : input.given())
    print.add(fmt::format("{} = {}\n", entry, value));
  for (const Table& table : {specimen.grains(), specimen.joints()})
    for (const v1::Column& column : table)
      for (const double value : column.values)
        print.add(std::bit_cast<std::uint64_t>(value));
  return print.value();
}
} // namespace

class TestState
{
public:
  template <int dim>
  using Running = std::unique_ptr<LabTest<dim>>;

  TestState(const Specimen& specimen, const Input& given, feldspar::Input wanted, const TestCase& wanted_case,
            const double pressure, std::vector<Stage> own_stages = {})
    : input(std::move(wanted))
    , test(wanted_case)
    , kind(test.kind.name)
    , pressure_at_start(pressure)
    , stages(std::move(own_stages))
    , whose(fingerprint_of(specimen, given))
  {
    std::visit(
      [&]<int dim>(const feldspar::Specimen<dim>& body) {
        if (body.is_periodic())
          throw InputError("the specimen is a periodic cell; a laboratory test needs walls: set Specimen/Shape = box");
        check_on_body(input, body_of(dim, body.shape));
        running = std::make_unique<LabTest<dim>>(LaboratoryCase{protocol_of(test.kind), test.confining_pressure},
                                                 feldspar::Specimen<dim>(body), input.tests, input.dynamics);
      },
      specimen.state().body);
  }

  /// Use by one thread at a time. The thread that runs the test may look at it meanwhile, as the handler of a signal.
  template <typename Use>
  auto alone(const Use& use)
  {
    const std::lock_guard lock(one_at_a_time);
    return guarded([&] { return std::visit([&](auto& one) { return use(*one); }, running); });
  }

  /// The same for what changes the test.
  template <typename Use>
  auto changing(const Use& use)
  {
    return alone([&](auto& one) {
      if (is_running)
        throw InputError("the test is running, and cannot be run by what it calls meanwhile");
      is_running = true;
      struct Ending
      {
        bool& flag;
        ~Ending() { flag = false; }
      } const ending{is_running};
      return use(one);
    });
  }

  FinishedTest finished_now()
  {
    const std::string own_name = name(test);
    return alone([&](const auto& one) { return finished(one.finish(!one.has_ended()), own_name, own_name, ""); });
  }

  double sign() const { return test.kind.sign; }

  /// The text that must be equal in a file from which the test is read.
  std::string identity() const
  {
    nlohmann::ordered_json all{{"kind", kind},
                               {"confining_pressure", pressure_at_start},
                               {"stages", nlohmann::ordered_json::array()},
                               {"whose", whose},
                               {"version", feldspar::version}};
    for (const Stage& stage : stages)
      {
        nlohmann::ordered_json numbers{stage.confining_pressure};
        for (const auto member : optional_numbers)
          numbers.push_back(stage.*member ? nlohmann::ordered_json(*(stage.*member)) : nlohmann::ordered_json());
        all["stages"].push_back(numbers);
      }
    return all.dump();
  }

  static constexpr std::array optional_numbers{&Stage::axial_strain, &Stage::axial_stress, &Stage::lateral_strain,
                                               &Stage::duration, &Stage::strain_rate};

  feldspar::Input input;
  TestCase test;
  std::string kind;
  double pressure_at_start; ///< confinement, compression positive [Pa]
  std::vector<Stage> stages;
  std::uint64_t whose;

private:
  std::variant<Running<2>, Running<3>> running;
  std::recursive_mutex one_at_a_time;
  bool is_running = false;
};

namespace
{
/// The input of one test on a specimen that stands already.
feldspar::Input input_of_test(const Input& input, const Specimen& specimen, const TestKind& kind,
                              const double confining_pressure)
{
  feldspar::Input wanted = input.state().read();
  wanted.specimen.dimension = unsigned(specimen.dimension());
  wanted.test_list = {kind};
  wanted.confinements = {confining_pressure};
  constexpr double largest = 1e11; // beyond the stiffness of any rock
  if (!(confining_pressure >= 0.0 && confining_pressure <= largest))
    throw InputError("the confining pressure is {:g} Pa; it must lie in [0, {:g}]", confining_pressure, largest);
  if (confining_pressure != 0.0 && !kind.takes_confining_pressure)
    throw InputError("{} takes no confining pressure", kind.name);
  if (confining_pressure == 0.0 && kind.takes_confining_pressure)
    throw InputError("{} needs a confining pressure above 0", kind.name);
  return wanted;
}
} // namespace

Test::Test(const Specimen& specimen, const Input& input, const std::string_view kind, const double confining_pressure)
  : of(guarded([&] {
    const TestCase test{kind_of(kind), confining_pressure};
    return std::make_unique<TestState>(specimen, input, input_of_test(input, specimen, test.kind, confining_pressure),
                                       test, confining_pressure);
  }))
{
}

Test::Test(const Specimen& specimen, const Input& input, const double confining_pressure, const Stage& first)
  : of(guarded([&] {
    const LoadingStage stage = stage_of(first);
    LoadingStage before;
    before.confining_pressure = confining_pressure;
    check_stage(stage, before);
    feldspar::Input wanted = input_of_test(input, specimen, own_loading.kind, 0.0);
    wanted.tests.of<LoadingTable>().stages = {stage};
    wanted.tests.of<LoadingTable>().pressure_at_start = confining_pressure;
    return std::make_unique<TestState>(specimen, input, std::move(wanted), TestCase{own_loading.kind, 0.0},
                                       confining_pressure, std::vector{first});
  }))
{
}

Test::Test(Test&&) noexcept = default;
Test& Test::operator=(Test&&) noexcept = default;
Test::~Test() = default;

void Test::follow(const Stage& stage)
{
  of->changing([&](auto& one) {
    if (of->stages.empty())
      throw InputError("{} follows no stages; begin a test of your own with its first stage", of->test.kind.name);
    const LoadingStage next = stage_of(stage);
    check_stage(next, stage_of(of->stages.back()));
    one.follow(next);
    of->stages.push_back(stage);
  });
}

const std::string& Test::kind() const { return of->kind; }

const std::vector<Stage>& Test::stages() const { return of->stages; }

void Test::save(const std::string& file) const
{
  of->alone([&](auto& one) {
    if (one.curve().empty())
      throw InputError("the test has no row yet; run it before it is saved");
    one.write_checkpoint(file, of->identity());
  });
}

Test Test::load(const Specimen& specimen, const Input& input, const std::string& file)
{
  return guarded([&] {
    std::string identity;
    read_hdf5(file, "a saved test", [&](Hdf5Reader& stored) { stored.text("identity", identity); });
    const auto saved = nlohmann::json::parse(identity, nullptr, false);
    if (!saved.is_object() || !saved.contains("stages"))
      throw InputError("{}: no saved test, but a checkpoint of the command", file);
    const double pressure = saved["confining_pressure"];
    std::vector<Stage> stages;
    for (const auto& numbers : saved["stages"])
      {
        Stage& stage = stages.emplace_back();
        stage.confining_pressure = numbers[0];
        for (std::size_t k = 0; k < TestState::optional_numbers.size(); ++k)
          if (!numbers[k + 1].is_null())
            stage.*TestState::optional_numbers[k] = numbers[k + 1].get<double>();
      }
    Test test = stages.empty() ? Test(specimen, input, std::string(saved["kind"]), pressure)
                               : Test(specimen, input, pressure, stages.front());
    for (std::size_t k = 1; k < stages.size(); ++k)
      test.follow(stages[k]);
    test.of->changing([&](auto& one) { one.read_checkpoint(file, test.of->identity()); });
    return test;
  });
}

bool Test::advance(const Check& check)
{
  return of->changing([&](auto& one) {
    const bool goes_on = !one.has_ended() && one.advance(interrupting(check));
    if (one.went_wrong())
      throw InputError(one.finish(false).record.failure);
    return goes_on;
  });
}

bool Test::has_ended() const
{
  return of->alone([](const auto& one) { return one.has_ended(); });
}

std::uint64_t Test::n_rows() const
{
  return of->alone([](const auto& one) { return one.curve().size(); });
}

std::vector<std::string> Test::columns() const
{
  return mapped<std::string>(shown_columns(), [](const auto& column) { return column.name; });
}

std::vector<double> Test::last_row() const
{
  return of->alone([&](const auto& one) {
    std::vector<double> row;
    if (!one.curve().empty())
      for (const auto& column : curve_columns)
        if (!column.is(only_of_samples))
          row.push_back((column.is(positive_in_test) ? of->sign() : 1.0) * column.get(one.curve().back()));
    return row;
  });
}

Table Test::curve(const std::uint64_t from) const
{
  return of->alone([&](const auto& one) { return table_of(one.curve(), shown_columns(), of->sign(), from); });
}

Table Test::cracks() const
{
  const std::vector<Crack> cracks = of->finished_now().record.cracks;
  Table table = table_of(cracks, crack_columns, of->sign());
  v1::Column in_tension{"in_tension", {}, true};
  for (const Crack& crack : cracks)
    in_tension.values.push_back(crack.kind == CrackKind::tension ? 1.0 : 0.0);
  table.insert(table.begin(), std::move(in_tension));
  return table;
}

Table Test::grains() const
{
  const FinishedTest now = of->finished_now();
  const std::string group = group_name(now.record);
  return table_of(now.appearance.grains_at_end, grain_columns(group));
}

std::string Test::summary() const
{
  const FinishedTest now = of->finished_now();
  return guarded([&] { return test_as_json(now); });
}
} // namespace feldspar::v1
