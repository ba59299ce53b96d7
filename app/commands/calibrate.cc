#include "app/calibration/calibrated_input.h"
#include "app/calibration/calibration_results.h"
#include "app/calibration/elastic_cells.h"
#include "app/calibration/precision.h"
#include "app/calibration/problem.h"
#include "app/calibration/tested_points.h"
#include "app/commands/commands.h"
#include "app/programme/genesis_effort.h"
#include "app/programme/lab_run.h"
#include "app/programme/laboratory_effort.h"
#include "app/programme/specimen_source.h"
#include "app/run/interrupt.h"
#include "app/screen/progress.h"
#include "base/append.h"
#include "base/input_error.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "calibration/calibration_file.h"
#include "calibration/fit.h"
#include "calibration/target_outcomes.h"
#include "runs/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

/// `feldspar calibrate`: from the first intact cell to the tests of the answer: elastic constants, design, steps, strain
/// scale, fresh packings, posterior.
namespace feldspar
{
namespace
{
using namespace calibration;
using calibration::Place; // not that of an entry

/// Everything that a calibration knows while it runs.
template <int dim>
class CalibrationRun
{
public:
  explicit CalibrationRun(const Run& of)
    : run(of)
    , input(of.input)
    , wanted(of.input.calibration)
    , problem(problem_of(of.input))
    , progress(of.quiet)
    , next_packing(of.input.seeds.front())
  {
  }

  RunEnd go()
  {
    progress.start("a first packing");
    const Specimen<dim> first = packing_of<dim>(input, next_packing);
    progress.finish(fmt::format("{} grains", first.grains.size()));
    tell_cost(first);
    ResponseModel model = elastic_stage(
      std::get<FlatJointParameters>(input.joints).installation_gap_ratio.value_or(first.report.installation_gap_ratio));
    if (const std::string objection = design_stage(model); !objection.empty())
      return {false, objection}; // its tests stay

    Fit fit = fit_about(UnitPoint(problem.unknowns.size(), 0.5), 0.5, model, start);
    if (const auto predicted = predicted_outcomes(problem.targets, fit, model, wanted.tolerance, wanted.n_packings);
        std::ranges::any_of(predicted, [](const auto& one) { return one.is_out_of_reach; }))
      return end_out_of_reach(model, fit, predicted);

    fit = steps(model, fit);
    test_strain_scale(model, fit.place);
    return answer(model, fit);
  }

private:
  /// Reports the expected cost, by one of the packings and by rough scales of the rock.
  void tell_cost(const Specimen<dim>& first)
  {
    const MicroParameters guess = first_guess(problem, micro_parameters(input));
    const Input rock = with_parameters(input, guess);
    const auto programme = test_cases(input.test_list, input.confinements);
    std::vector<LaboratoryOrder> of_specimen;
    for (const TestCase& test : programme)
      of_specimen.push_back({test, &rock.tests, &rock.dynamics});
    const double of_waves = std::sqrt(
      guess.modulus / std::get<FlatJointParameters>(input.joints).modulus); // steps are as short as they are fast
    const double seconds = (of_waves * expected_effort<dim>(of_specimen, {{"", rock}}, {&first, 1}).processor_seconds +
                            expected_effort(input.specimen).seconds) /
                           n_threads_served();
    const auto cost = [&](const std::size_t n_specimens) {
      return fmt::format("{} specimens ({})", n_specimens, duration_in_words(seconds * double(n_specimens)));
    };
    progress.remark(fmt::format(
      "{} target(s), {} unknown ratio(s){}{}.\nThe design takes {} of some {:.0f} grains, {} test(s) each; steps take up to "
      "{}, the answer up to {} for each of at most {} rounds. Times are right within a factor of two or three.",
      problem.targets.size(), problem.unknowns.size(), problem.has_modulus ? ", the modulus" : "",
      problem.has_strength ? ", the strength" : "", cost(wanted.n_points * wanted.n_packings),
      double(first.grains.size()), programme.size(), cost(wanted.most_steps * wanted.n_step_packings),
      cost(wanted.most_packings), most_rounds));
    if (problem.has_strength)
      progress.remark(usual_precision(wanted, dim, first.grains.size()));
  }

  /// The intact rock, and a place to begin at.
  ResponseModel elastic_stage(const double gap)
  {
    progress.start("elastic cells");
    const MicroParameters fixed = micro_parameters(input);
    const ElasticTable elastic =
      elastic_constants<dim>(input, wanted.stiffness_ratio, wanted.installation_gap_ratio, gap, run.folder, progress);
    check_poissons_ratio(problem, wanted, elastic);
    const auto& [least, largest] = elastic.range();
    progress.finish(fmt::format("E {:.2f} to {:.2f} of the joints', nu {:.3f} to {:.3f}", least.modulus_ratio,
                                largest.modulus_ratio, least.poissons_ratio, largest.poissons_ratio));
    start.point.assign(problem.unknowns.size(), 0.5);
    start.log_strength = std::log(first_guess(problem, fixed).bond_tensile_strength);
    const MicroParameters middle = parameters_at(start.point, problem.unknowns, fixed);
    const auto modulus = target_of(problem, ResponseScale::modulus);
    start.log_modulus = std::log(
      modulus ? *modulus / elastic.at(middle.stiffness_ratio, middle.gap.value_or(gap)).modulus_ratio : fixed.modulus);
    return {problem.responses, problem.unknowns, fixed, elastic, gap};
  }

  /// The next seeds of packings.
  std::vector<std::uint64_t> take_packings(const std::size_t n)
  {
    std::vector<std::uint64_t> seeds(n);
    std::iota(seeds.begin(), seeds.end(), next_packing);
    next_packing += n;
    return seeds;
  }

  FitFreedom freedom_about(const UnitPoint& centre, const double half_width) const
  {
    return {problem.has_modulus, problem.has_strength, centre, half_width};
  }

  Fit fit_about(const UnitPoint& centre, const double half_width, const ResponseModel& model, const Place& from) const
  {
    return best_fit(model, problem.targets, wanted.tolerance, freedom_about(centre, half_width), from);
  }

  /// Packings of the design. A packing on which no test can begin is left out: every point is tested on each, and a
  /// figure that one of them never gives would be learnt from none. The rock is that of the middle of the design.
  std::vector<std::uint64_t> packings_of_design(const Input& rock)
  {
    constexpr std::size_t most_left_out = 10;
    progress.start("packings of the design");
    std::vector<std::uint64_t> seeds;
    std::size_t n_left_out = 0;
    while (seeds.size() < wanted.n_packings)
      {
        const auto tried = take_packings(wanted.n_packings - seeds.size());
        std::vector<std::string> objections(tried.size());
        for_each_job(tried.size(), [&](const std::size_t k) {
          objections[k] = objection_to_packing<dim>(rock, tried[k], run.folder);
        });
        for (std::size_t k = 0; k < tried.size(); ++k)
          if (objections[k].empty())
            seeds.push_back(tried[k]);
          else if (++n_left_out == most_left_out)
            throw InputError("{} ({} of the first {} packings)", objections[k], n_left_out, n_left_out + seeds.size());
          else
            progress.remark(fmt::format("Packing {} is left out: {}.", tried[k], objections[k]));
      }
    progress.finish(fmt::format("{} packing(s)", seeds.size()));
    return seeds;
  }

  /// Learns how the responses depend on the ratios. Says why it cannot; nothing if it could.
  std::string design_stage(ResponseModel& model)
  {
    const auto seeds = packings_of_design(with_parameters(input, model.parameters(start)));
    std::vector<TestedPoint> orders;
    const auto points = sobol_points(wanted.n_points, problem.unknowns.size(), input.seeds.front());
    for (std::size_t i = 0; i < points.size(); ++i)
      for (const std::uint64_t seed : seeds)
        orders.push_back(
          {"design", i, seed, points[i], model.parameters({points[i], start.log_modulus, start.log_strength}), {}});
    append(tested, test("design", orders));
    model.learn(tested);
    for (const Target& target : problem.targets)
      if (!model.knows(target.response))
        {
          write_design(model, tested, run.folder);
          return fmt::format("{}: the design gave too few values of it, from all packings of a point: raise "
                             "Calibration/Design points, or narrow its bounds; {} shows the values",
                             problem.response_of(target).title, calibration_file::design);
        }
    progress.remark(precision_by_design(wanted, problem, model));
    return "";
  }

  /// Steps in a region about the last place, each confirmed on the same packings, until the targets are met there.
  Fit steps(ResponseModel& model, Fit fit)
  {
    const auto seeds = take_packings(wanted.n_step_packings);
    Fit best = fit;
    std::optional<double> least;
    double half_width = 0.25;
    const auto is_near = [&](const TargetOutcome& outcome) { return is_nearly_met(outcome, wanted.tolerance); };
    for (n_steps = 0; n_steps < wanted.most_steps;)
      {
        ++n_steps;
        const Place place = fit.place;
        std::vector<TestedPoint> orders;
        for (const std::uint64_t seed : seeds)
          orders.push_back({fmt::format("step {}", n_steps), 0, seed, place.point, model.parameters(place), {}});
        auto of_step = test(fmt::format("step {}", n_steps), orders);
        const std::vector<TargetOutcome> outcomes = outcomes_of(of_step, problem.targets, model, place);
        append(corrections, of_step);
        append(tested, std::move(of_step));
        double misfit = 0.0;
        for (const TargetOutcome& outcome : outcomes)
          misfit += std::pow(outcome.deviation(), 2);
        if (!least || misfit < *least)
          {
            least = misfit;
            best = fit;
            model.correct(corrections);
          }
        else
          half_width *= 0.5; // the region in which the corrections hold was too large
        if (std::ranges::all_of(outcomes, is_near))
          break;
        model.correct(corrections);
        fit = fit_about(best.place.point, half_width, model, best.place);
      }
    // Corrections by all that was learnt on the way.
    model.correct(corrections);
    return fit_about(best.place.point, 0.5 * half_width, model, best.place);
  }

  /// Tests whether strengths are proportional to those of the bonds at another ratio of strength to stiffness: strains
  /// are then larger.
  void test_strain_scale(const ResponseModel& model, const Place& place)
  {
    if (!problem.has_strength)
      return;
    constexpr double factor = 1.5;
    const std::uint64_t seed = tested.back().seed;
    MicroParameters as_is = model.parameters(place);
    MicroParameters stronger = as_is;
    stronger.bond_tensile_strength *= factor;
    const auto both =
      test("strain scale", {{"scale", 0, seed, place.point, as_is, {}}, {"scale", 1, seed, place.point, stronger, {}}});
    for (std::size_t j = 0; j < problem.responses.size(); ++j)
      if (const Response& response = problem.responses[j]; response.scale == ResponseScale::strength &&
                                                           !response.name.starts_with("strength_at_") &&
                                                           both[0].values[j] && both[1].values[j])
        scale_effects[response.name] = *both[1].values[j] / *both[0].values[j] / factor - 1.0;
    append(tested, both);
  }

  /// Tests the answer on packings by which nothing was chosen, as many as its standard errors ask for. One that misses
  /// by more than they explain is mended once or twice, and tested on others.
  RunEnd answer(ResponseModel& model, Fit fit)
  {
    std::vector<FinishedTest> finished_tests;
    Input best_input;
    std::vector<TargetOutcome> outcomes;
    Place place = fit.place;
    for (std::size_t round = 1;; ++round)
      {
        place = rounded_place(model, fit.place);
        const std::uint64_t first = next_packing;
        finished_tests.clear();
        std::vector<TestedPoint> points;
        std::size_t n = 0;
        std::size_t needed = std::min<std::size_t>(3, wanted.most_packings);
        while (n < needed)
          {
            const auto folder = run.folder / "calibration" / fmt::format("answer_{}_from_{}", round, n);
            std::filesystem::create_directories(folder);
            const Input batch = input_of(model.parameters(place), first + n, needed - n);
            append(finished_tests, run_answer(batch, folder, round));
            n = needed;
            points = as_tested_points(finished_tests, fmt::format("answer {}", round), model, place);
            outcomes = outcomes_of(points, problem.targets, model, place);
            needed = packings_needed(outcomes, wanted.tolerance, wanted.most_packings);
          }
        best_input = input_of(model.parameters(place), first, n);
        next_packing = first + wanted.most_packings;
        append(corrections, points);
        append(tested, points);
        model.correct(corrections);
        if (round == most_rounds || !is_worth_another_round(outcomes, wanted.tolerance))
          break;
        fit = fit_about(place.point, 0.1, model, place);
      }

    const TargetVerdict verdict = verdict_on(outcomes, wanted.tolerance);
    const std::string statement = statement_of(outcomes, model, wanted.tolerance);
    CalibrationOutcome outcome = outcome_of(model, place, outcomes, verdict, statement);
    progress.start("posterior");
    outcome.posterior =
      posterior(model, problem.targets, freedom_about(place.point, 0.5), place, wanted.n_samples, input.seeds.front());
    progress.finish(fmt::format("{} samples", outcome.posterior.samples.size()));
    finish(run, model, outcome, tested, best_input, finished_tests);
    return end_with(verdict, statement);
  }

  /// Ends the calibration where the surrogates already tell that the targets contradict each other.
  RunEnd end_out_of_reach(const ResponseModel& model, const Fit& fit, const std::vector<TargetOutcome>& predicted)
  {
    const std::string objection = nearest_in_words(predicted, model);
    const CalibrationOutcome outcome = outcome_of(model, fit.place, predicted, TargetVerdict::missed, objection);
    finish(run, model, outcome, tested, input_of(rounded(model.parameters(fit.place)), input.seeds.front(), 3), {});
    return end_with(outcome.verdict, objection);
  }

  static RunEnd end_with(const TargetVerdict verdict, const std::string& statement)
  {
    if (verdict == TargetVerdict::reached)
      return {false, ""};
    return {false, statement, verdict == TargetVerdict::missed ? exit_code::missed : exit_code::not_decided};
  }

  CalibrationOutcome outcome_of(const ResponseModel& model, const Place& place,
                                const std::vector<TargetOutcome>& outcomes, const TargetVerdict verdict,
                                const std::string& statement) const
  {
    CalibrationOutcome outcome;
    outcome.rock = problem.reference.rock;
    outcome.statement = statement;
    outcome.verdict = verdict;
    outcome.tolerance = wanted.tolerance;
    outcome.targets = outcomes;
    outcome.scale_effects = scale_effects;
    outcome.n_steps = n_steps;
    outcome.best = model.parameters(place);
    for (std::size_t j = 0; j < problem.responses.size(); ++j)
      if (model.knows(j))
        {
          const LearntResponse& learnt = model.learnt(j);
          outcome.sensitivities[problem.responses[j].name] =
            sobol_indices([&](const UnitPoint& point) { return learnt.surrogate->mean(point); },
                          problem.unknowns.size(), 1024, input.seeds.front());
          if (problem.responses[j].scale == ResponseScale::modulus)
            outcome.modulus_of_specimens_over_cells = std::exp(learnt.surrogate->mean(place.point) + learnt.correction);
        }
    return outcome;
  }

  /// A run of `feldspar lab` of the same input gives the same tests.
  Input input_of(const MicroParameters& parameters, const std::uint64_t first_seed, const std::size_t n) const
  {
    Input result = with_parameters(input, parameters);
    result.seeds.resize(n);
    std::iota(result.seeds.begin(), result.seeds.end(), first_seed);
    result.calibration = {};
    result.reference_file = std::filesystem::canonical(input.reference_file).string();
    // Values as a reader of the file would have them, to the last bit.
    const auto file = run.folder / "calibration" / "answer.prm";
    std::filesystem::create_directories(file.parent_path());
    write_whole_file(file, as_prm(result, ""));
    return read_input(file);
  }

  Place rounded_place(const ResponseModel& model, const Place& place) const
  {
    const MicroParameters parameters = rounded(model.parameters(place));
    Place result = place;
    for (std::size_t k = 0; k < problem.unknowns.size(); ++k)
      result.point[k] = problem.unknowns[k].coordinate(problem.unknowns[k].of(parameters));
    result.log_modulus = std::log(parameters.modulus);
    result.log_strength = std::log(parameters.bond_tensile_strength);
    return result;
  }

  std::vector<FinishedTest> run_answer(const Input& best_input, const std::filesystem::path& folder,
                                       const std::size_t round)
  {
    progress.remark(
      fmt::format("Answer, round {}: packings {} to {}.", round, best_input.seeds.front(), best_input.seeds.back()));
    const RunPlan plan(best_input);
    auto specimens = provide_specimens<dim>(plan, folder, progress);
    auto finished_tests = run_programme(plan, plan_tests(plan, sizes_of(specimens)), specimens, folder, progress);
    end_if_interrupted();
    return finished_tests;
  }

  std::vector<TestedPoint> as_tested_points(const std::vector<FinishedTest>& finished_tests, const std::string& stage,
                                            const ResponseModel& model, const Place& place) const
  {
    std::map<std::uint64_t, std::vector<FinishedTest>> by_seed;
    for (const FinishedTest& one : finished_tests)
      by_seed[one.record.seed].push_back(one);
    std::vector<TestedPoint> points;
    for (const auto& [seed, tests] : by_seed)
      points.push_back({stage, 0, seed, place.point, model.parameters(place), values_of(problem.responses, tests)});
    return points;
  }

  std::vector<TestedPoint> test(const std::string& title, const std::vector<TestedPoint>& orders)
  {
    progress.start(title);
    auto points = test_points<dim>(input, problem.responses, orders, run.folder, progress);
    progress.finish(fmt::format("{} specimen(s)", points.size()));
    return points;
  }

  static constexpr std::size_t most_rounds = 3;

  const Run& run;
  const Input& input;
  const CalibrationParameters& wanted;
  Problem problem;
  Progress progress;
  std::uint64_t next_packing; ///< its seed
  Place start{};
  std::vector<TestedPoint> tested;      ///< all
  std::vector<TestedPoint> corrections; ///< after the design
  std::map<std::string, double> scale_effects;
  std::size_t n_steps = 0;
};
} // namespace

int run_calibrate(const CommonOptions& options)
{
  return run_command({"calibrate", calibration::check_input,
                      [](const Run& run) {
                        return run.input.specimen.dimension == 2 ? CalibrationRun<2>(run).go()
                                                                 : CalibrationRun<3>(run).go();
                      }},
                     options);
}
} // namespace feldspar
