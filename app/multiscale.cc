#include "app/commands.h"
#include "app/input.h"
#include "app/interrupt.h"
#include "app/output_folder.h"
#include "app/progress.h"
#include "app/provenance.h"
#include "app/report_command.h"
#include "app/run_record.h"
#include "app/specimen_source.h"
#include "coupling/sample_test.h"
#include "dem/input_error.h"
#include "report/comparison.h"
#include "report/reference.h"
#include "report/result_folder.h"
#include "report/strength_data.h"
#include "report/strength_envelopes.h"
#include "report/text_file.h"

#include <deal.II/base/mpi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

/// `feldspar multiscale`: laboratory tests on a mesh of finite elements with a representative volume at every point.
namespace feldspar
{
namespace
{
/// The volumes that one seed's samples share.
struct Rock
{
  std::uint64_t seed;
  std::vector<std::shared_ptr<const Network<2>>> realisations; ///< shared by all points that got one
  SpecimenReport report;                                       ///< of the first
};

std::vector<std::uint64_t> packing_seeds(const Input& input)
{
  std::vector<std::uint64_t> seeds;
  for (const std::uint64_t seed : input.seeds)
    for (std::uint64_t k = 0; k < input.sample.n_realisations; ++k)
      seeds.push_back(seed * input.sample.n_realisations + k);
  return seeds;
}

std::vector<Rock> make_rock(const Input& input, const std::filesystem::path& input_file,
                            const std::filesystem::path& folder, Progress& progress)
{
  Input of_packings = input;
  of_packings.seeds = packing_seeds(input);
  const std::vector<Variant> one{{"", of_packings}};
  const auto orders = specimen_orders(one);
  std::filesystem::create_directories(folder / "volumes");
  const auto specimens = provide_specimens<2>(one, orders, folder / "volumes", progress);
  std::vector<Rock> rocks;
  for (std::size_t k = 0; k < specimens.size(); ++k)
    {
      if (!specimens[k].periodic)
        throw InputError(fmt::format("{}: Specimen/Specimen file: is a specimen between walls; the volume at a point "
                                     "needs a periodic cell (feldspar lab takes walls)",
                                     input_file.string()));
      if (k % input.sample.n_realisations == 0)
        rocks.push_back({input.seeds[rocks.size()], {}, specimens[k].report});
      rocks.back().realisations.push_back(std::make_shared<const Network<2>>(specimens[k]));
    }
  return rocks;
}

struct PlannedSample
{
  TestCase test;
  const Rock* rock;
  std::string group;
  std::string name;
};

std::vector<PlannedSample> plan(const Input& input, const std::vector<Rock>& rocks)
{
  std::vector<PlannedSample> planned;
  for (const Rock& rock : rocks)
    {
      const auto add = [&](const TestCase& test, const std::string& group) {
        planned.push_back({test, &rock, group, fmt::format("{}_seed_{}", group, rock.seed)});
      };
      for (const TestKind kind : input.test_list)
        if (kind == TestKind::triaxial_compression)
          for (const double pressure : input.confinements)
            add({kind, pressure}, fmt::format("{}_{}_MPa", name(kind), pressure / 1e6));
        else
          add({kind}, name(kind));
    }
  return planned;
}

/// One test from its seating to its end, or to Ctrl-C.
FinishedTest run(const PlannedSample& planned, const Input& input, const std::filesystem::path& folder,
                 const std::function<void(const std::string&)>& show, std::vector<std::string>& remarks)
{
  SampleTest test(planned.test, input.sample, input.tests, input.equilibrium, planned.rock->realisations,
                  planned.rock->report, planned.rock->seed);
  const double sign = laboratory_sign(planned.test.kind);
  double next_strain_drawn = 0.0;
  const auto draw = [&](const SampleStanding& standing) {
    if (interrupted())
      throw Interrupted();
    std::string where;
    if (standing.n_newton_iterations + standing.n_cascades > 0)
      where =
        fmt::format(", {} iterations and {} cascades in this step", standing.n_newton_iterations, standing.n_cascades);
    show(where);
  };
  bool was_interrupted = false;
  try
    {
      while (!test.has_ended())
        {
          test.advance(draw);
          const CurveSample& row = test.last_row();
          const SampleStanding standing = test.standing();
          show(fmt::format(": {:.4f} %, {:.1f} MPa, {} broken segments, {:.0f} % of the points damaged",
                           100.0 * sign * row.axial_strain, sign * row.axial_stress / 1e6,
                           row.n_tension_cracks + row.n_shear_cracks,
                           100.0 * double(standing.n_damaged_points) / double(standing.n_points)));
          constexpr double strain_between_fields = 2.5e-4;
          if (sign * row.axial_strain >= next_strain_drawn || test.has_ended())
            {
              test.write_fields(folder / "fields", planned.name);
              next_strain_drawn +=
                planned.test.kind == TestKind::direct_tension ? 0.1 * strain_between_fields : strain_between_fields;
            }
        }
    }
  catch (const Interrupted&)
    {
      was_interrupted = true;
    }
  if (!test.ended_because().empty())
    remarks.push_back(fmt::format("{}: {}", planned.name, test.ended_because()));
  FinishedTest finished;
  finished.record = test.finish(was_interrupted);
  finished.group = planned.group;
  finished.name = planned.name;
  finished.results = evaluate(finished.record);
  return finished;
}

std::string describe_run(const Input& input, const std::vector<Rock>& rocks, const std::vector<FinishedTest>& tests,
                         const std::vector<std::string>& remarks)
{
  std::string text;
  for (const Rock& rock : rocks)
    text += fmt::format("The first of {} volumes of seed {}\n{}\n", rock.realisations.size(), rock.seed,
                        describe(rock.report));
  std::optional<Reference> reference;
  if (!input.reference_file.empty())
    reference = read_reference(input.reference_file);
  text += as_text(compare(tests, reference)) + "\n";
  if (const StrengthData data = strength_data(tests); data.points.size() > 1)
    text += as_text(fit_strength_envelopes(data)) + "\n";
  for (const auto& test : tests)
    if (!test.results.peak_stress.value)
      text += fmt::format("{}: {}\n", test.name, test.results.peak_stress.reason);
  for (const auto& remark : remarks)
    text += remark + "\n";
  return text;
}

/// What can be told before any work; returns what a user should know.
std::vector<std::string> check(const Input& input, const std::filesystem::path& file)
{
  const auto refuse = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", file.string(), what)); };
  if (input.specimen.dimension != 2)
    refuse("Specimen/Dimension = 3: the plane sample takes volumes in the plane; set Dimension = 2");
  if (input.specimen.specimen_file.empty() && input.specimen.shape != "periodic")
    refuse(fmt::format("Specimen/Shape = {}: the volume at a point needs Shape = periodic", input.specimen.shape));
  if (!input.variant_entry.empty())
    refuse("Variants/Entry: a multiscale run has no variants; write an input for each");
  if (std::find(input.test_list.begin(), input.test_list.end(), TestKind::brazilian) != input.test_list.end())
    refuse("Tests/List: brazilian: the sample is a rectangle; it makes direct_tension, uniaxial_compression and "
           "triaxial_compression");
  if (!input.reference_file.empty())
    read_reference(input.reference_file);

  // physics.md §7: elements larger than the volume would have to dissipate more than it holds.
  const double volume = std::sqrt(input.specimen.width * input.specimen.height);
  const SampleParameters& sample = input.sample;
  const double element =
    std::sqrt(sample.width * sample.height / (sample.elements_across * sample.elements_along)) / sample.order;
  if (element > volume * (1.0 + 1e-9))
    return {fmt::format("elements of {:.1f} mm are larger than the volume of {:.1f} mm that softens for them; take at "
                        "least Elements across = {}, Elements along = {}",
                        1e3 * element, 1e3 * volume, unsigned(std::ceil(sample.width / (volume * sample.order))),
                        unsigned(std::ceil(sample.height / (volume * sample.order))))};
  return {};
}

int run_in(const std::filesystem::path& folder, const Input& input, const std::filesystem::path& input_file,
           const bool quiet, std::vector<std::string> remarks)
{
  Progress progress(quiet);
  watch_for_interrupt();

  // Make the rock.
  const auto rocks = make_rock(input, input_file, folder, progress);

  // Break it.
  const auto planned = plan(input, rocks);
  std::filesystem::create_directories(folder / "fields");
  std::vector<FinishedTest> tests;
  progress.start("tests");
  for (const PlannedSample& one : planned)
    {
      if (interrupted())
        break;
      std::string last;
      tests.push_back(run(
        one, input, folder,
        [&](const std::string& text) {
          const bool is_row = text.starts_with(':');
          if (is_row)
            last = text;
          progress.update(
            std::numeric_limits<double>::quiet_NaN(),
            fmt::format("{} of {} done; {}{}{}", tests.size(), planned.size(), one.name, last, is_row ? "" : text));
        },
        remarks));
    }
  progress.finish(fmt::format("{} of {} done", tests.size(), planned.size()));

  // Report.
  write_result_folder(provenance(input, input_file), tests, folder);
  if (!input.reference_file.empty())
    std::filesystem::copy_file(input.reference_file, folder / result_file::reference,
                               std::filesystem::copy_options::overwrite_existing);
  if (!tests.empty())
    for (auto& sentence : report_on({{folder}, {}, {}, folder}))
      remarks.push_back(std::move(sentence));
  const std::string text = describe_run(input, rocks, tests, remarks);
  write_text_file(folder / "log.txt", text);
  if (!quiet)
    fmt::print("\n{}\n", text);
  fmt::print("{}\n", folder.string());
  if (interrupted())
    {
      fmt::print(stderr, "feldspar: interrupted; what was finished is there, the rest has to be run anew\n");
      return exit_code::interrupted;
    }
  mark_complete(folder);
  return 0;
}
} // namespace

int run_multiscale(const CommonOptions& options)
{
  // No limit of threads here, as deal.II's tutorials have it: it would leave the volumes one worker.
  int n_arguments = 0;
  char** no_arguments = nullptr;
  setenv("OMPI_MCA_btl_base_warn_component_unused", "0", 0);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_arguments, no_arguments);

  const Input input = read_input(options.input);
  const auto remarks = check(input, options.input);
  for (const auto& remark : remarks)
    fmt::print(stderr, "feldspar: {}: {}\n", options.input.string(), remark);
  const OutputFolder folder(options.output, options.input, options.force);
  remove_run(folder.path());
  write_run_record("multiscale", options.input, folder.path());
  try
    {
      return run_in(folder.path(), input, options.input, options.quiet, remarks);
    }
  catch (const InputError&)
    {
      remove_run(folder.path()); // a mistake leaves nothing
      throw;
    }
}
} // namespace feldspar
