#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/processes/mpi_session.h"
#include "app/programme/checks.h"
#include "app/programme/multiscale_run.h"
#include "app/programme/reference_body.h"
#include "app/programme/run_board.h"
#include "app/programme/run_report.h"
#include "app/programme/sample_checks.h"
#include "app/programme/specimen_source.h"
#include "app/run/interrupt.h"
#include "app/run/provenance.h"
#include "base/append.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/ranks/ranks.h"
#include "results/folder/result_folder.h"
#include "results/runs/trust.h"

#include <fmt/format.h>

#include <algorithm>

/// `feldspar multiscale`: laboratory tests on a mesh of finite elements with a representative volume at every point.
namespace feldspar
{
namespace
{
std::string describe_run(const Input& input, const std::vector<Rock>& rocks, const std::vector<FinishedTest>& tests,
                         const RunEnvelopes& envelopes, const std::vector<std::string>& remarks)
{
  std::string text;
  for (const Rock& rock : rocks)
    if (const auto reports = rock.reports(); !reports.empty())
      text +=
        fmt::format("The first of {} RVEs of seed {}\n{}\n", reports.size(), rock.seed, describe(reports.front()));
  text += describe_tests(tests, reference_of(input), envelopes) + trust_as_text(tests);
  for (const auto& test : tests)
    if (const RankBalance& of_ranks = test.bookkeeping.ranks; ranks::number() > 1 && of_ranks.mean > 0.0)
      text += fmt::format(
        "{}: longest over mean time of the ranks {:.2f}, had no cell moved {:.2f}; cells were distributed "
        "anew {} times\n",
        test.name, of_ranks.longest / of_ranks.mean, of_ranks.longest_unmoved / of_ranks.mean, of_ranks.n_moves);
  for (const auto& remark : remarks)
    text += remark + "\n";
  return text;
}

/// RVEs, tests and report of a run in its folder, from wherever it stands.
RunEnd go(const Run& run, std::vector<std::string> remarks)
{
  const Input& input = run.input;
  Progress progress(run.quiet || !ranks::is_first());

  // Make the rock.
  const auto rocks = make_rocks(input, run.input_file, run.folder, progress);

  // Break it.
  const SampleSettings settings = sample_settings(input);
  std::vector<PlannedSample> planned;
  with_name_of(run.input_file, [&] { planned = plan(input, rocks, settings); });
  std::vector<BoardPart> shown;
  for (const PlannedSample& one : planned)
    shown.push_back({one.name, 1.0, BoardTest{one.test, &input, cost_of_sample(one.test.kind, input.sample)}});
  RunBoard board(progress, "tests", shown);
  const auto tests = run_samples(planned, run.folder, board);
  progress.finish(fmt::format("{} of {} done", std::ranges::count_if(tests, &FinishedTest::was_made), planned.size()));

  if (!tests.empty() &&
      std::ranges::all_of(tests, [](const FinishedTest& test) { return !test.record.failure.empty(); }))
    throw InputError("{}: {}", run.input_file.string(), tests.front().record.failure);

  // Report.
  const bool was_interrupted = ranks::any(interrupted());
  ranks::first([&] {
    auto [envelopes, missing] =
      write_and_report(provenance(input, run.input_file), tests, input.reference_file, run.folder, progress);
    append(remarks, std::move(missing));
    std::vector<SpecimenReport> bodies;
    for (const Rock& rock : rocks)
      append(bodies, rock.reports());
    append(remarks, beside_reference_body(input, bodies));
    write_log(run.folder, describe_run(input, rocks, tests, envelopes, remarks), run.quiet);
  });
  // Pictures are still to be made if the run was interrupted while it drew them.
  return {ranks::any(was_interrupted || interrupted()), failures(tests)};
}

int run_on_all_ranks(const CommonOptions& options)
{
  if (options.extract)
    {
      if (ranks::number() > 1)
        throw InputError("--extract is the work of one process; start it without mpirun");
      return extract_rve(options.input, *options.extract, options.quiet);
    }
  std::vector<std::string> remarks;
  const RunCommand multiscale{"multiscale",
                              [&](const Input& input, const std::filesystem::path& file) {
                                remarks = check_sample_input(input, file);
                                if (ranks::is_first())
                                  for (const auto& remark : remarks)
                                    fmt::print(stderr, "feldspar: {}: {}\n", printable(file.string()), remark);
                              },
                              [&](const Run& run) { return go(run, remarks); }};
  return run_command(multiscale, options);
}
} // namespace

int run_multiscale(const CommonOptions& options)
{
  return with_mpi([&] { return run_on_all_ranks(options); }, mpi_and_finite_elements);
}
} // namespace feldspar
