#include "app/commands.h"
#include "app/input.h"
#include "app/interrupt.h"
#include "app/jobs.h"
#include "app/output_folder.h"
#include "app/progress.h"
#include "app/provenance.h"
#include "app/specimen_source.h"
#include "dem/lab_tests.h"
#include "dem/specimen_file.h"
#include "report/comparison.h"
#include "report/csv_tables.h"
#include "report/figures.h"
#include "report/summary.h"
#include "report/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <mutex>

namespace feldspar
{
namespace
{
/// What one test of the programme is.
struct PlannedTest
{
  TestKind kind;
  const Specimen<2>* specimen;
};

/// Tells the one progress line how all running tests stand.
class Board
{
public:
  Board(Progress& shown, const std::vector<PlannedTest>& planned, const double stop_over_peak)
    : progress(shown)
    , stop_strain_over_peak(stop_over_peak)
    , entries(planned.size())
  {
    for (std::size_t k = 0; k < planned.size(); ++k)
      entries[k].kind = planned[k].kind;
    progress.start("tests");
  }

  void update(const std::size_t k, const CurveSample& row)
  {
    const std::lock_guard lock(showing);
    Entry& entry = entries[k];
    const double sign = laboratory_sign(entry.kind);
    entry.row = row;
    if (sign * row.axial_stress > entry.peak_stress)
      {
        entry.peak_stress = sign * row.axial_stress;
        entry.strain_at_peak = sign * row.axial_strain;
      }
    // Only a curve that has left its peak tells where it will end.
    const bool past_peak = sign * row.axial_stress < 0.9 * entry.peak_stress;
    entry.fraction = past_peak ? sign * row.axial_strain / (stop_strain_over_peak * entry.strain_at_peak) : 0.0;
    entry.running = true;
    draw();
  }

  void finish(const std::size_t k)
  {
    const std::lock_guard lock(showing);
    entries[k].running = false;
    entries[k].fraction = 1.0;
    draw();
  }

private:
  struct Entry
  {
    TestKind kind{};
    CurveSample row;
    double peak_stress = 0.0;
    double strain_at_peak = 0.0;
    double fraction = 0.0;
    bool running = false;
  };

  void draw()
  {
    double sum = 0.0;
    std::string text;
    for (const auto& entry : entries)
      {
        sum += std::min(1.0, entry.fraction);
        if (entry.running)
          text += fmt::format("{}{}: {:.4f} %, {:.1f} MPa, {} cracks", text.empty() ? "" : "; ", name(entry.kind),
                              100.0 * laboratory_sign(entry.kind) * entry.row.axial_strain,
                              laboratory_sign(entry.kind) * entry.row.axial_stress / 1e6,
                              entry.row.n_tension_cracks + entry.row.n_shear_cracks);
      }
    progress.update(sum > 0.0 ? sum / double(entries.size()) : std::numeric_limits<double>::quiet_NaN(), text);
  }

  Progress& progress;
  const double stop_strain_over_peak;
  std::mutex showing;
  std::vector<Entry> entries;
};

/// Runs every test on every specimen; those that Ctrl-C kept from starting are left out.
std::vector<FinishedTest> run_tests(const Input& input, const std::vector<Specimen<2>>& specimens, Progress& progress)
{
  std::vector<PlannedTest> planned;
  for (const auto& specimen : specimens)
    for (const TestKind kind : input.test_list)
      planned.push_back({kind, &specimen});

  Board board(progress, planned, input.tests.stop_strain_over_peak_strain);
  std::vector<std::optional<FinishedTest>> slots(planned.size());
  for_each_job(planned.size(), [&](const std::size_t k) {
    if (interrupted())
      return;
    const auto& [kind, specimen] = planned[k];
    FinishedTest test;
    test.name = fmt::format("{}_seed_{}", name(kind), specimen->seed);
    test.record = run_test(kind, *specimen, input.tests, input.dynamics, [&](const CurveSample& row) {
      board.update(k, row);
      return !interrupted();
    });
    test.results = evaluate(test.record);
    board.finish(k);
    slots[k] = std::move(test);
  });
  std::vector<FinishedTest> finished;
  for (auto& slot : slots)
    if (slot)
      finished.push_back(std::move(*slot));
  progress.finish(fmt::format("{} of {} test(s)", finished.size(), planned.size()));
  return finished;
}

void write_results(const std::filesystem::path& folder, const Provenance& made_by,
                   const std::vector<FinishedTest>& tests)
{
  std::filesystem::create_directories(folder / "curves");
  for (const auto& test : tests)
    write_curve(test, folder / "curves" / (test.name + ".csv"));
  write_cracks(tests, folder / "cracks.csv");
  write_summary(made_by, tests, folder / "summary.json");
}
} // namespace

int run_lab(const CommonOptions& options)
{
  const Input input = read_input(options.input);
  std::optional<std::filesystem::path> reference;
  if (!input.reference_file.empty())
    reference = input.reference_file;
  compare({}, reference); // a bad reference file is said before the work, not after it
  const OutputFolder folder(options.output, options.input, options.force);
  Progress progress(options.quiet);
  watch_for_interrupt();

  // Make the rock.
  const auto specimens = provide_specimens<2>(input, progress);
  for (const auto& specimen : specimens)
    write_specimen(specimen, folder.path() / specimen_file_name(specimen.seed, specimens.size()));

  // Break it.
  const auto tests = run_tests(input, specimens, progress);

  // Report.
  write_results(folder.path(), provenance(input, options.input), tests);
  std::string log;
  for (const auto& specimen : specimens)
    log += fmt::format("Specimen, seed {}\n{}\n", specimen.seed, describe(specimen.report));
  log += as_text(compare(tests, reference));
  if (!tests.empty())
    {
      std::filesystem::create_directories(folder.path() / "figures");
      if (const auto figures = draw_figures(tests, folder.path() / "figures"); !figures.problem.empty())
        log += "\n" + figures.problem + "\n";
    }
  for (const auto& test : tests)
    if (!test.results.peak_stress.value)
      log += fmt::format("\n{}: {}\n", test.name, test.results.peak_stress.reason);
  write_text_file(folder.path() / "log.txt", log);
  if (!options.quiet)
    fmt::print("\n{}\n", log);
  fmt::print("{}\n", folder.path().string());
  if (interrupted())
    {
      fmt::print(stderr, "feldspar: interrupted; what was there is in {}, run the same command to begin anew\n",
                 folder.path().string());
      return exit_code::interrupted;
    }
  return 0;
}
} // namespace feldspar
