#include "app/commands/commands.h"
#include "app/commands/report_command.h"
#include "app/commands/volume_extract.h"
#include "app/input/input.h"
#include "app/input/parameter_table.h"
#include "app/run/interrupt.h"
#include "app/run/multiscale_run.h"
#include "app/run/provenance.h"
#include "app/run/reference_body.h"
#include "app/run/specimen_source.h"
#include "app/screen/print_result.h"
#include "app/screen/test_board.h"
#include "base/append.h"
#include "base/input_error.h"
#include "base/whole_file.h"
#include "coupling/sample/ranks.h"
#include "report/sections/comparison.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/reference.h"
#include "results/folder/result_folder.h"
#include "results/trust.h"

#include <deal.II/base/mpi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>

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
        fmt::format("The first of {} volumes of seed {}\n{}\n", reports.size(), rock.seed, describe(reports.front()));
  std::optional<Reference> reference;
  if (!input.reference_file.empty())
    reference = read_reference(input.reference_file);
  text += as_text(compare(tests, reference)) + "\n";
  if (const auto found = envelopes.find(""); found != envelopes.end() && found->second.data.points.size() > 1)
    text += as_text(found->second) + "\n";
  text += trust_as_text(tests);
  for (const auto& test : tests)
    if (const RankBalance& of_ranks = test.bookkeeping.ranks; ranks::number() > 1 && of_ranks.mean > 0.0)
      text += fmt::format(
        "{}: longest over mean time of the ranks {:.2f}, had no cell moved {:.2f}; cells were dealt out "
        "anew {} times\n",
        test.name, of_ranks.longest / of_ranks.mean, of_ranks.longest_unmoved / of_ranks.mean, of_ranks.n_moves);
  for (const auto& remark : remarks)
    text += remark + "\n";
  return text;
}

/// What can be told before any work; returns what a user should know.
std::vector<std::string> check(const Input& input, const std::filesystem::path& file)
{
  const auto refuse = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", file.string(), what)); };
  const bool has_grains = input.sample.material == SampleMaterial::grains;
  const SampleGeometry geometry = input.sample.geometry;
  if (const unsigned int needed = dimension_of_volumes(geometry); has_grains && input.specimen.dimension != needed)
    refuse(fmt::format("Specimen/Dimension = {}: {}; set Dimension = {}", input.specimen.dimension,
                       needed == 2 ? "the volumes of a plane sample are of discs (those of plane strain of spheres)"
                                   : "the volumes of such a Sample/Geometry are of spheres",
                       needed));
  if (has_grains && input.specimen.specimen_file.empty() && input.specimen.shape != "periodic")
    refuse(fmt::format("Specimen/Shape = {}: the volume at a point needs Shape = periodic", input.specimen.shape));
  if (has_grains && !input.specimen.specimen_file.empty() && input.sample.n_realisations > 1)
    refuse("Sample/Realisations: a Specimen file is one realisation; set Realisations = 1");
  if (has_grains && input.specimen.joint_law != FlatJoint<2>::name)
    refuse(fmt::format("Specimen/Joint law = {}: the volume at a point needs Joint law = {}", input.specimen.joint_law,
                       FlatJoint<2>::name));
  if (!input.variants.entries.empty())
    refuse("Variants/Entry: a multiscale run has no variants; write an input for each");
  for (const TestKind& kind : input.test_list)
    if (const std::string objection = objection_to_finite_elements(kind); !objection.empty())
      refuse(objection);
  if (!input.reference_file.empty())
    read_reference(input.reference_file);

  try
    {
      reference_body(input);
      check_body(input, Body::sample);
    }
  catch (const InputError& error)
    {
      refuse(error.what());
    }
  if (!has_grains && input.sample.weak_seed != WeakSeed::none)
    refuse("Sample/Weak seed: weakens the bonds between grains; it needs Material = grains");
  if (!has_grains && !input.tests.stop_strain)
    refuse("Tests/Stop strain = none: without grains the sample does not soften, so a test would not end; give the "
           "strain at which it is to stop");
  if (input.sample.widened_past_peak && !input.tests.stop_strain && !input.tests.stop_stress_over_peak)
    refuse(
      "Sample/Control past the peak = lateral strain: the axial strain may go back, so that no multiple of that at "
      "the peak ends the test; give Tests/Stop stress over peak, or Stop strain");
  if (input.continuum.dilation_angle > input.continuum.friction_angle)
    refuse("Continuum/Dilation angle: must be at most Continuum/Friction angle");
  if (!has_grains && geometry != SampleGeometry::plane && input.continuum.poissons_ratio >= 0.5)
    refuse("Continuum/Poisson ratio: must be below 0.5 in space");
  if (input.sample.reduced_quadrature && input.sample.order != 2)
    refuse("Sample/Quadrature = reduced: needs Order = 2; elements of order 1 would deform without strain");
  // Before the mesh is made, which would take all memory.
  constexpr double most_cells = 1e6;
  const double n_across = input.sample.elements_across;
  if (const double n =
        (geometry == SampleGeometry::cylinder ? n_across * n_across : n_across) * input.sample.elements_along;
      input.sample.mesh_file.empty() && n > most_cells)
    refuse(fmt::format("Sample/Elements across = {}, Elements along = {}: some {:.0e} cells; more than {:.0e} are not "
                       "meshed",
                       input.sample.elements_across, input.sample.elements_along, n, most_cells));
  SampleSize size{};
  try
    {
      size = measure(input.sample);
    }
  catch (const InputError& error)
    {
      refuse(error.what());
    }
  if (const std::uint64_t most = n_cells(input.sample); ranks::number() > most)
    refuse(fmt::format("{} processes for a sample of {} cells: each needs one; start at most {}, and give them more "
                       "threads",
                       ranks::number(), most, most));

  // Elements larger than the volume would have to dissipate more than it holds; docs/theory.md §11.
  if (!has_grains || !input.specimen.specimen_file.empty())
    return {};
  const SampleParameters& sample = input.sample;
  const double width = input.specimen.width;
  const double volume = dimension_of_volumes(geometry) == 2 ? std::sqrt(width * input.specimen.height)
                                                            : std::cbrt(width * width * input.specimen.height);
  if (size.largest_element <= volume * (1.0 + 1e-9))
    return {};
  const std::string larger =
    fmt::format("elements of {:.1f} mm are larger than the volume of {:.1f} mm that softens for "
                "them",
                1e3 * size.largest_element, 1e3 * volume);
  if (!sample.mesh_file.empty())
    return {fmt::format("{}; mesh with elements of at most {:.1f} mm", larger, 1e3 * volume * sample.order)};
  const double across = geometry == SampleGeometry::axisymmetric ? 0.5 * size.width : size.width;
  return {fmt::format("{}; take at least Elements across = {}, Elements along = {}", larger,
                      unsigned(std::ceil(across / (volume * sample.order))),
                      unsigned(std::ceil(size.height / (volume * sample.order))))};
}

/// Volumes, tests and report of a run in its folder, from wherever it stands.
RunEnd go(const Run& run, std::vector<std::string> remarks)
{
  const auto& [folder, input_file, input, quiet] = run;
  Progress progress(quiet || !ranks::is_first());

  // Make the rock.
  const auto rocks = make_rocks(input, input_file, folder, progress);

  // Break it.
  std::vector<PlannedSample> planned;
  try
    {
      planned = plan(input, rocks);
    }
  catch (const InputError& error)
    {
      throw InputError(fmt::format("{}: {}", input_file.string(), error.what()));
    }
  ranks::first([&] { std::filesystem::create_directories(folder / "fields"); });
  std::vector<FinishedTest> tests;
  std::vector<BoardTest> shown;
  for (const PlannedSample& one : planned)
    shown.push_back({one.name, one.test, &input,
                     1.0 / (one.test.kind.sign > 0.0 ? input.sample.tension_step : input.sample.compression_step)});
  TestBoard board(progress, shown);
  for (const PlannedSample& one : planned)
    {
      if (ranks::any(interrupted()))
        break;
      const std::size_t k = tests.size();
      tests.push_back(run_test(one, input, folder, [&](const CurveSample* const row, const std::string& more) {
        row ? board.update(k, *row, more) : board.update(k, more);
      }));
      board.finish(k);
    }
  progress.finish(
    fmt::format("{} of {} done",
                std::count_if(tests.begin(), tests.end(), [](const FinishedTest& test) { return test.was_made(); }),
                planned.size()));

  const auto failed =
    std::find_if(tests.begin(), tests.end(), [](const FinishedTest& test) { return !test.record.failure.empty(); });
  if (failed != tests.end() &&
      std::all_of(tests.begin(), tests.end(), [](const FinishedTest& test) { return !test.record.failure.empty(); }))
    throw InputError(fmt::format("{}: {}", input_file.string(), failed->record.failure));

  // Report.
  const bool was_interrupted = ranks::any(interrupted());
  ranks::first([&] {
    const RunEnvelopes envelopes = fit_each_rock(tests);
    write_result_folder(provenance(input, input_file), tests, envelopes, folder);
    if (!input.reference_file.empty())
      std::filesystem::copy_file(input.reference_file, folder / result_file::reference,
                                 std::filesystem::copy_options::overwrite_existing);
    if (!tests.empty())
      for (auto& sentence : report_on({{folder}, {}, {}, folder, envelopes}))
        remarks.push_back(std::move(sentence));
    std::vector<SpecimenReport> bodies;
    for (const Rock& rock : rocks)
      append(bodies, rock.reports());
    append(remarks, beside_reference_body(input, bodies));
    const std::string text = describe_run(input, rocks, tests, envelopes, remarks);
    write_whole_file(folder / "log.txt", text);
    if (!quiet)
      print_result("\n{}\n", text);
    print_result("{}\n", folder.string());
  });
  return {was_interrupted, failed == tests.end() ? "" : fmt::format("{}: {}", failed->name, failed->record.failure)};
}

int run_on_all_ranks(const CommonOptions& options)
{
  if (options.extract)
    {
      if (ranks::number() > 1)
        throw InputError("--extract is the work of one process; start it without mpirun");
      return extract_volume(options.input, *options.extract, options.quiet);
    }
  std::vector<std::string> remarks;
  const RunCommand multiscale{"multiscale",
                              [&](const Input& input, const std::filesystem::path& file) {
                                remarks = check(input, file);
                                if (ranks::is_first())
                                  for (const auto& remark : remarks)
                                    fmt::print(stderr, "feldspar: {}: {}\n", file.string(), remark);
                              },
                              [&](const Run& run) { return go(run, remarks); },
                              {ranks::is_first(), ranks::first, ranks::of_first}};
  return run_command(multiscale, options);
}
} // namespace

int run_multiscale(const CommonOptions& options)
{
  // No limit of threads here, as deal.II's tutorials have it: it would leave the volumes one worker.
  int n_arguments = 0;
  char** no_arguments = nullptr;
  setenv("OMPI_MCA_btl_base_warn_component_unused", "0", 0);
  setenv("HWLOC_COMPONENTS", "-gl", 0); // which would connect to a display, and end with it
  int exit_code = 0;
  std::exception_ptr failure; // kept until MPI is down: it does not go down while an exception is under way
  {
    const dealii::Utilities::MPI::MPI_InitFinalize mpi(n_arguments, no_arguments);
    try
      {
        exit_code = ranks::guarded([&] { return run_on_all_ranks(options); });
      }
    catch (...)
      {
        failure = std::current_exception();
      }
  }
  if (failure)
    std::rethrow_exception(failure);
  return exit_code;
}
} // namespace feldspar
