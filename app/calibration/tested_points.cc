#include "app/calibration/tested_points.h"

#include "app/calibration/calibrated_input.h"
#include "app/calibration/kept_values.h"
#include "app/input/joint_sections.h"
#include "app/programme/lab_run.h"
#include "app/run/interrupt.h"
#include "app/run/jobs.h"
#include "app/run/run_record.h"
#include "app/screen/expected_length.h"
#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/rock/rock.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

namespace feldspar::calibration
{
namespace
{
/// The strain at which a test will probably end.
double expected_end(const TestCase& test, const Input& rock)
{
  return expected_last_strain(expected_strain_at_peak(test, rock).value_or(0.0), rock.tests);
}

/// Progress of several points at a time, by the strains that their tests have come to.
class PointBoard
{
public:
  PointBoard(Progress& shown, const std::vector<TestCase>& programme, const Input& input, const std::size_t n_points)
    : progress(shown)
    , points(n_points, 0.0)
    , n_tests(programme.size() * n_points)
  {
    for (const TestCase& test : programme)
      costs.push_back(expected_end(test, input) / (*protocol_of(test.kind).strain_rate)(input.tests));
    left = double(n_points) * std::accumulate(costs.begin(), costs.end(), 0.0);
  }

  /// The j-th test of the k-th point has come to this share of itself.
  void update(const std::size_t k, const std::size_t j, const double share)
  {
    const std::lock_guard lock(showing);
    points[k] =
      std::accumulate(costs.begin(), costs.begin() + std::ptrdiff_t(j), 0.0) + std::min(share, 1.0) * costs[j];
    n_done += share >= 1.0;
    draw();
  }

  /// A point that an earlier run has made is no work of this one.
  void take_up()
  {
    const std::lock_guard lock(showing);
    left -= std::accumulate(costs.begin(), costs.end(), 0.0);
    n_done += costs.size();
    draw();
  }

private:
  void draw()
  {
    const double spent = std::accumulate(points.begin(), points.end(), 0.0);
    const double fraction = left > 0.0 ? std::min(spent / left, 1.0) : double(n_done) / double(n_tests);
    progress.update(fraction, fmt::format("{} of {} tests", n_done, n_tests));
  }

  Progress& progress;
  std::mutex showing;
  std::vector<double> costs;  ///< of the tests of a point, by the time that is simulated [s]
  std::vector<double> points; ///< what has been spent on each
  double left = 0.0;          ///< in all, but for points that were resumed
  std::size_t n_tests;
  std::size_t n_done = 0;
};
} // namespace

std::string PointOrder::name() const
{
  std::string words = stage;
  std::replace(words.begin(), words.end(), ' ', '_');
  return fmt::format("{}_{}_seed_{}", words, number, seed);
}

template <int dim>
std::string objection_to_packing(const Input& rock, const std::uint64_t seed, const std::filesystem::path& folder)
{
  const std::string name = fmt::format("packing_{}", seed);
  const auto file = folder / "calibration" / (name + ".json");
  const std::string identity = run_identity(rock, name);
  if (read_values(file, identity, 0))
    return "";
  try
    {
      const auto specimen = make_rock<dim>(rock_of(rock), seed, end_if_interrupted);
      for (const TestCase& test : test_cases(rock.test_list, rock.confinements))
        (*protocol_of(test.kind).template set_up<dim>())(specimen, test.confining_pressure, rock.tests, rock.dynamics);
    }
  catch (const InputError& error)
    {
      return error.what();
    }
  std::filesystem::create_directories(file.parent_path());
  write_values(file, identity, {});
  return "";
}

template <int dim>
std::vector<TestedPoint> test_points(const Input& input, const std::vector<Response>& responses,
                                     const std::vector<PointOrder>& orders, const std::filesystem::path& folder,
                                     Progress& progress)
{
  const std::filesystem::path kept = folder / "calibration";
  const std::filesystem::path checkpoints = folder / "checkpoints";
  std::filesystem::create_directories(kept);
  std::filesystem::create_directories(checkpoints);
  const std::vector<TestCase> programme = test_cases(input.test_list, input.confinements);
  std::vector<TestedPoint> tested(orders.size());
  PointBoard board(progress, programme, input, orders.size());
  for_each_job(orders.size(), [&](const std::size_t k) {
    const PointOrder& order = orders[k];
    tested[k] = {order.stage, order.number, order.seed, order.point, order.parameters, {}};
    const Input rock = with_parameters(input, order.parameters);
    const std::string identity = run_identity(rock, order.name());
    const auto file = kept / (order.name() + ".json");
    if (auto values = read_values(file, identity, responses.size()))
      {
        tested[k].values = std::move(*values);
        board.take_up();
        return;
      }
    end_if_interrupted();
    std::vector<FinishedTest> finished_tests;
    const auto name_of = [&](const TestCase& test) { return fmt::format("{}_{}", order.name(), name(test)); };
    try
      {
        const auto specimen = make_rock<dim>(rock_of(rock), order.seed, end_if_interrupted);
        for (std::size_t j = 0; j < programme.size(); ++j)
          {
            const TestCase& test = programme[j];
            try
              {
                const std::string full_name = name_of(test);
                TestOutcome outcome =
                  run_test(test, rock, specimen, Checkpoints(checkpoints, full_name, run_identity(rock, full_name)),
                           [&](const CurveSample& row) {
                             constexpr double most = 0.99; // until it has ended
                             board.update(k, j, std::min(most, test.kind.strain(row) / expected_end(test, rock)));
                           });
                end_if_interrupted();
                finished_tests.push_back(finished(std::move(outcome), name(test), full_name, ""));
              }
            catch (const InputError&)
              {
                // These parameters cannot withstand the test, such as its confinement: a point without that figure.
              }
            board.update(k, j, 1.0);
          }
      }
    catch (const InputError&)
      {
        for (std::size_t j = 0; j < programme.size(); ++j)
          board.update(k, j, 1.0); // no specimen can be made of them
      }
    tested[k].values = values_of(responses, finished_tests);
    write_values(file, identity, tested[k].values);
    for (const TestCase& test : programme)
      for (const char* const ending : {".h5", ".previous.h5"})
        std::filesystem::remove(checkpoints / (name_of(test) + ending));
  });
  return tested;
}

template std::string objection_to_packing<2>(const Input&, std::uint64_t, const std::filesystem::path&);
template std::string objection_to_packing<3>(const Input&, std::uint64_t, const std::filesystem::path&);
template std::vector<TestedPoint> test_points<2>(const Input&, const std::vector<Response>&,
                                                 const std::vector<PointOrder>&, const std::filesystem::path&,
                                                 Progress&);
template std::vector<TestedPoint> test_points<3>(const Input&, const std::vector<Response>&,
                                                 const std::vector<PointOrder>&, const std::filesystem::path&,
                                                 Progress&);
} // namespace feldspar::calibration
