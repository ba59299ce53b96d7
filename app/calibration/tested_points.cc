#include "app/calibration/tested_points.h"

#include "app/calibration/calibrated_input.h"
#include "app/calibration/kept_values.h"
#include "app/input/joint_sections.h"
#include "app/programme/checks.h"
#include "app/programme/lab_run.h"
#include "app/programme/run_board.h"
#include "app/run/interrupt.h"
#include "app/screen/expected_length.h"
#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/rock/rock.h"
#include "runs/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace feldspar::calibration
{
namespace
{
/// The tests of all points, by what is simulated [s].
std::vector<BoardPart> for_board(const std::vector<TestCase>& programme, const Input& input, const std::size_t n_points)
{
  std::vector<BoardPart> parts;
  for (std::size_t k = 0; k < n_points; ++k)
    for (const TestCase& test : programme)
      parts.push_back({"", expected_last_strain(test, input) / (*protocol_of(test.kind).strain_rate)(input.tests)});
  return parts;
}

std::string name_of(const TestedPoint& point)
{
  std::string words = point.stage;
  std::ranges::replace(words, ' ', '_');
  return fmt::format("{}_{}_seed_{}", words, point.number, point.seed);
}

/// Shows a test by the strain that it has come to.
class TestObserver : public RunObserver
{
public:
  TestObserver(RunBoard& shown, const TestCase& of, const double expected_strain)
    : board(shown)
    , test(of)
    , last_strain(expected_strain)
  {
  }

  bool wants_end() const override { return board.wants_end(); }
  void advanced(const std::size_t part, const PartStanding& standing) override
  {
    constexpr double most = 0.99; // until it has ended
    board.advanced(part, {nullptr, std::min(most, test.kind.strain(*standing.row) / last_strain)});
  }

  void goes_back(const std::string& sentence) override { board.goes_back(sentence); }

private:
  RunBoard& board;
  const TestCase& test;
  double last_strain;
};
} // namespace

template <int dim>
std::string objection_to_packing(const Input& rock, const std::uint64_t seed, const std::filesystem::path& folder)
{
  const KeptValues kept(folder, fmt::format("packing_{}", seed), rock);
  if (kept.read(0))
    return "";
  const std::string objection = refusal_of([&] {
    const auto specimen = make_rock<dim>(rock_of(rock), seed, end_if_interrupted);
    for (const TestCase& test : test_cases(rock.test_list, rock.confinements))
      (*protocol_of(test.kind).template set_up<dim>())(specimen, test.confining_pressure, rock.tests, rock.dynamics);
  });
  if (objection.empty())
    kept.write({});
  return objection;
}

template <int dim>
std::vector<TestedPoint> test_points(const Input& input, const std::vector<Response>& responses,
                                     std::vector<TestedPoint> points, const std::filesystem::path& folder,
                                     Progress& progress)
{
  const std::filesystem::path checkpoints = folder / "checkpoints";
  std::filesystem::create_directories(checkpoints);
  const std::vector<TestCase> programme = test_cases(input.test_list, input.confinements);
  const auto part = [&](const std::size_t k, const std::size_t j) { return k * programme.size() + j; };
  RunBoard board(progress, "", for_board(programme, input, points.size()));
  for_each_job(points.size(), [&](const std::size_t k) {
    TestedPoint& point = points[k];
    const Input rock = with_parameters(input, point.parameters);
    const KeptValues kept(folder, name_of(point), rock);
    if (auto values = kept.read(responses.size()))
      {
        point.values = std::move(*values);
        for (std::size_t j = 0; j < programme.size(); ++j)
          board.taken_up(part(k, j));
        return;
      }
    end_if_interrupted();
    std::vector<FinishedTest> finished_tests;
    const auto name_of_test = [&](const TestCase& test) { return fmt::format("{}_{}", name_of(point), name(test)); };
    try
      {
        const auto specimen = make_rock<dim>(rock_of(rock), point.seed, end_if_interrupted);
        for (std::size_t j = 0; j < programme.size(); ++j)
          {
            const TestCase& test = programme[j];
            try
              {
                const std::string full_name = name_of_test(test);
                TestObserver observer(board, test, expected_last_strain(test, rock));
                const LaboratoryOrder wanted = laboratory_order(test, rock, full_name);
                TestOutcome outcome = run_test<dim>(
                  wanted, [&] { return specimen; }, Checkpoints(checkpoints, full_name, wanted.identity), part(k, j),
                  observer);
                end_if_interrupted();
                finished_tests.push_back(finished(std::move(outcome), name(test), full_name, ""));
              }
            catch (const InputError&)
              {
                // These parameters cannot withstand the test, such as its confinement: a point without that figure.
              }
            board.ended(part(k, j));
          }
      }
    catch (const InputError&)
      {
        for (std::size_t j = 0; j < programme.size(); ++j)
          board.ended(part(k, j)); // no specimen can be made of them
      }
    point.values = values_of(responses, finished_tests);
    kept.write(point.values);
    for (const TestCase& test : programme)
      for (const char* const ending : {".h5", ".previous.h5"})
        std::filesystem::remove(checkpoints / (name_of_test(test) + ending));
  });
  return points;
}

template decltype(objection_to_packing<2>) objection_to_packing<2>;
template decltype(objection_to_packing<3>) objection_to_packing<3>;
template decltype(test_points<2>) test_points<2>;
template decltype(test_points<3>) test_points<3>;
} // namespace feldspar::calibration
