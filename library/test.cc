#include "app/programme/checks.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/curve.h"
#include "laboratory/loading_stages.h"
#include "library/states.h"
#include "results/folder/summary.h"
#include "results/folder/table_columns.h"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar::v1
{
namespace
{
constexpr bool is_shown(const feldspar::Column<CurveSample>& column) { return !column.is(only_of_samples); }

std::vector<feldspar::Column<CurveSample>> shown_columns()
{
  std::vector<feldspar::Column<CurveSample>> columns;
  std::copy_if(std::begin(curve_columns), std::end(curve_columns), std::back_inserter(columns), is_shown);
  return columns;
}

TestKind kind_of(const std::string_view name)
{
  const std::vector<TestKind>& kinds = test_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const TestKind& one) { return one.name == name; });
  if (found == kinds.end())
    throw InputError(fmt::format("{}: no such test; there are {}", name, names(kinds)));
  return *found;
}

LoadingStage stage_of(const Stage& stage)
{
  return {stage.axial_strain, stage.axial_stress,       stage.lateral_strain,
          stage.duration,     stage.confining_pressure, stage.strain_rate};
}

void check_stage(const LoadingStage& stage, const LoadingStage* const before)
{
  if (const std::string what = objection(stage, before); !what.empty())
    throw InputError(what);
}
} // namespace

class TestState
{
public:
  template <int dim>
  using Running = std::unique_ptr<LabTest<dim>>;

  TestState(const Specimen& specimen, feldspar::Input wanted, const TestCase& wanted_case)
    : input(std::move(wanted))
    , test(wanted_case)
  {
    std::visit(
      [&]<int dim>(const feldspar::Specimen<dim>& body) {
        check_specimen_of_file(input, body);
        running = std::make_unique<LabTest<dim>>(LaboratoryCase{protocol_of(test.kind), test.confining_pressure},
                                                 feldspar::Specimen<dim>(body), input.tests, input.dynamics);
      },
      specimen.state().body);
  }

  template <typename Use>
  auto with(const Use& use) const
  {
    return std::visit([&](const auto& one) { return use(*one); }, running);
  }

  FinishedTest finished_now() const
  {
    const std::string own_name = name(test);
    return with([&](const auto& one) { return finished(one.finish(!one.has_ended()), own_name, own_name, ""); });
  }

  feldspar::Input input;
  TestCase test;
  std::variant<Running<2>, Running<3>> running;
  std::optional<LoadingStage> last_stage;
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
  if (confining_pressure != 0.0 && !kind.takes_confining_pressure)
    throw InputError(fmt::format("{} takes no confining pressure", kind.name));
  if (!(confining_pressure >= 0.0))
    throw InputError(fmt::format("the confining pressure is {:g} Pa; it must be at least 0", confining_pressure));
  return wanted;
}
} // namespace

Test::Test(const Specimen& specimen, const Input& input, const std::string_view kind, const double confining_pressure)
  : of(guarded([&] {
    const TestCase test{kind_of(kind), confining_pressure};
    return std::make_unique<TestState>(specimen, input_of_test(input, specimen, test.kind, confining_pressure), test);
  }))
{
}

Test::Test(const Specimen& specimen, const Input& input, const Stage& first)
  : of(guarded([&] {
    const LoadingStage stage = stage_of(first);
    check_stage(stage, nullptr);
    feldspar::Input wanted = input_of_test(input, specimen, own_loading.kind, 0.0);
    wanted.tests.of<LoadingTable>().stages = {stage};
    auto state = std::make_unique<TestState>(specimen, std::move(wanted), TestCase{own_loading.kind, 0.0});
    state->last_stage = stage;
    return state;
  }))
{
}

Test::Test(Test&&) noexcept = default;
Test& Test::operator=(Test&&) noexcept = default;
Test::~Test() = default;

void Test::follow(const Stage& stage)
{
  guarded([&] {
    if (!of->last_stage)
      throw InputError(
        fmt::format("{} follows no stages; begin a test of your own with its first stage", of->test.kind.name));
    const LoadingStage next = stage_of(stage);
    check_stage(next, &*of->last_stage);
    std::visit([&](auto& one) { one->follow(next); }, of->running);
    of->last_stage = next;
  });
}

bool Test::advance(const Check& check)
{
  return guarded([&] {
    return std::visit(
      [&](auto& one) {
        const bool goes_on = !one->has_ended() && one->advance(interrupting(check));
        if (one->went_wrong())
          throw InputError(one->finish(false).record.failure);
        return goes_on;
      },
      of->running);
  });
}

bool Test::has_ended() const
{
  return of->with([](const auto& one) { return one.has_ended(); });
}

std::uint64_t Test::n_rows() const
{
  return of->with([](const auto& one) { return one.curve().size(); });
}

std::vector<std::string> Test::columns() const
{
  std::vector<std::string> all;
  for (const auto& column : shown_columns())
    all.emplace_back(column.name);
  return all;
}

std::vector<double> Test::last_row() const
{
  return of->with([&](const auto& one) {
    std::vector<double> row;
    if (!one.curve().empty())
      for (const auto& column : curve_columns)
        if (is_shown(column))
          row.push_back((column.is(positive_in_test) ? of->test.kind.sign : 1.0) * column.get(one.curve().back()));
    return row;
  });
}

Table Test::curve(const std::uint64_t from) const
{
  return of->with([&](const auto& one) { return table_of(one.curve(), shown_columns(), of->test.kind.sign, from); });
}

Table Test::cracks() const
{
  const std::vector<Crack> cracks = of->finished_now().record.cracks;
  Table table = table_of(cracks, crack_columns, of->test.kind.sign);
  v1::Column in_tension{"in_tension", {}, true};
  for (const Crack& crack : cracks)
    in_tension.values.push_back(crack.kind == CrackKind::tension ? 1.0 : 0.0);
  table.insert(table.begin(), std::move(in_tension));
  return table;
}

Table Test::grains() const { return table_of(of->finished_now().appearance.grains_at_end, grain_columns("group")); }

std::string Test::summary() const
{
  return guarded([&] { return test_as_json(of->finished_now()); });
}
} // namespace feldspar::v1
