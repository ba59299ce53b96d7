#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/input/strain_path.h"
#include "app/programme/checks.h"
#include "app/programme/reference_body.h"
#include "app/programme/run_board.h"
#include "app/programme/run_report.h"
#include "app/programme/rve_results.h"
#include "app/programme/specimen_source.h"
#include "app/run/interrupt.h"
#include "app/run/provenance.h"
#include "app/run/run_record.h"
#include "base/mapped.h"
#include "coupling/rve/homogenisation.h"
#include "coupling/rve/rve_file.h"
#include "dem/minerals/minerals.h"
#include "runs/paths.h"
#include "runs/share_out.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

/// `feldspar rve`: representative volumes along a path of strain or stress, one for each seed.
namespace feldspar
{
namespace
{
/// From x towards y, in space from z towards x.
template <int dim>
Tensor<dim> turn_of_cell(const double angle)
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, Vector<3>::UnitY()).toRotationMatrix();
}

/// The paths of an input, by variants and specimens.
template <int dim>
std::vector<PathOrder<dim>> plan_paths(const Input& input, const RunPlan& plan)
{
  const auto part = [](const std::string& name) { return name.empty() ? name : '_' + name; };
  const auto path = [&](const Variant& variant, const std::size_t s) -> PathOrder<dim> {
    const Input& of = variant.input;
    const std::string name = "rve" + part(variant.name_in_files) +
                             (input.seeds.size() > 1 ? fmt::format("_seed_{}", plan.orders[s].seed) : std::string());
    PathOrder<dim> order{s,
                         name,
                         variant.label,
                         variant.settings,
                         run_identity(of, name),
                         turn_of_cell<dim>(of.strain_path.cell_angle),
                         of.boundary,
                         path_legs<dim>(of.strain_path),
                         PathParameters{.largest_step = of.strain_path.largest_step, .equilibrium = of.equilibrium}};
    if (of.strain_path.solver == PathSolver::explicit_dynamics)
      order.solver = ExplicitParameters{.largest_step = of.strain_path.largest_step,
                                        .steps_per_millistrain = of.strain_path.steps_per_millistrain,
                                        .dynamics = of.dynamics};
    if (!of.specimen.specimen_file.empty())
      order.start = [&of](const Network<dim>& network) { // an RVE out of a sample goes on from where it stands there
        auto start = read_rve_state(of.specimen.specimen_file, network);
        if (start)
          check_rve_out_of_sample(of);
        return start;
      };
    return order;
  };
  std::vector<PathOrder<dim>> paths;
  for (const auto& [v, s] : plan.parts())
    paths.push_back(path(plan.variants[v], s));
  return paths;
}

template <int dim>
std::vector<FinishedRve<dim>> run_paths_on_board(const std::vector<PathOrder<dim>>& paths,
                                                 const std::vector<Specimen<dim>>& specimens,
                                                 const std::filesystem::path& folder, Progress& progress)
{
  const auto parts = mapped<BoardPart>(paths, [&](const auto& path) { return BoardPart{path.name}; });
  RunBoard board(progress, "paths", parts);
  auto rves = run_paths(paths, specimens, folder, board);
  progress.finish(fmt::format("{} RVE(s)", rves.size()));
  return rves;
}

/// Each process makes its share of the cells, and then of the paths.
template <int dim>
void share_out_paths(const Run& run, Progress& progress)
{
  const RunPlan plan(run.input);
  share_out_specimens<dim>(plan, run.folder, progress);
  together_or_interrupted([&] {
    auto paths = share_of_this_process(plan_paths<dim>(run.input, plan));
    const auto specimens = provide_specimens_of<dim>(paths, plan, run.folder, progress);
    std::erase_if(paths, [&](const auto& path) { return !specimens[path.specimen].is_periodic(); });
    if (!paths.empty())
      run_paths_on_board(paths, specimens, run.folder, progress);
    end_if_interrupted();
  });
}

/// The bounds on the stiffness of a rock of minerals, each of which alone is as stiff as the same packing without their contrast,
/// times its ratio; none of another rock.
template <int dim>
std::optional<MixtureBounds> mixture_bounds_of(const Input& input, const Specimen<dim>& specimen)
{
  if (input.minerals.minerals.empty())
    return std::nullopt;
  const Network<dim> network(with_one_stiffness(specimen, input.minerals));
  const auto constants = isotropic_constants<dim>(network.intact_stiffness());
  std::vector<PhaseModuli> phases;
  const auto shares = shares_of_minerals(specimen);
  for (std::size_t k = 0; k < shares.size(); ++k)
    {
      const double ratio = input.minerals.minerals[k].within.stiffness;
      phases.push_back({shares[k].share, ratio * constants.bulk_modulus, ratio * constants.shear_modulus});
    }
  return mixture_bounds<dim>(phases);
}

template <int dim>
RunEnd strain_alone(const Run& run, Progress& progress)
{
  const Input& input = run.input;

  // Make the rock.
  const RunPlan plan(input);
  const auto specimens = provide_specimens<dim>(plan, run.folder, progress);
  with_name_of(run.input_file, [&] {
    for (const auto& specimen : specimens)
      check_cell(specimen.shape, "a representative volume");
  });

  // Strain it.
  const auto paths = plan_paths<dim>(input, plan);
  auto rves = run_paths_on_board(paths, specimens, run.folder, progress);
  for (std::size_t k = 0; k < rves.size(); ++k)
    {
      const SpecimenOrder& order = plan.orders[paths[k].specimen];
      rves[k].mixture = mixture_bounds_of(plan.input_of(order), specimens[paths[k].specimen]);
    }

  // Report.
  const bool was_interrupted = interrupted();
  write_results(provenance(input, run.input_file), rves, run.folder);
  std::string text;
  for (const auto& rve : rves)
    text += describe(rve) + "\n";
  const auto bodies = mapped<SpecimenReport>(specimens, [](const auto& specimen) { return specimen.report; });
  for (const std::string& line : beside_reference_body(input, bodies))
    text += line + "\n";
  write_log(run.folder, text, run.quiet);
  return {was_interrupted, failures(rves)};
}
} // namespace

int run_rve(const CommonOptions& options)
{
  return run_shared("rve", check_rve_input, {share_out_paths<2>, strain_alone<2>},
                    {share_out_paths<3>, strain_alone<3>}, options);
}
} // namespace feldspar
