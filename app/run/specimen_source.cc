#include "app/run/specimen_source.h"

#include "app/input/joint_sections.h"
#include "app/input/parameter_table.h"
#include "app/run/interrupt.h"
#include "app/run/jobs.h"
#include "app/run/memory.h"
#include "base/input_error.h"
#include "dem/genesis/genesis.h"
#include "dem/specimen/specimen_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <variant>

namespace feldspar
{
namespace
{
/// The entries that genesis reads, and their values.
std::string rock(const Input& input)
{
  std::string text;
  for (const Parameter& parameter : parameter_table())
    if (parameter.flags.of_specimen && has_use_for(input, parameter))
      text += fmt::format("{} = {}\n", parameter.name(), parameter.write(input));
  return text;
}

/// A specimen out of a file brings its own joint law, which must be the one that the input speaks of.
template <int dim>
Specimen<dim> read_finished_specimen(const SpecimenParameters& wanted)
{
  auto specimen = read_specimen<dim>(wanted.specimen_file);
  const auto law = std::visit([](const auto& known) { return known.name; }, specimen.joints.law);
  if (law != wanted.joint_law)
    throw InputError(fmt::format("Specimen/Joint law = {}: the joints of {} are of the law {}", wanted.joint_law,
                                 wanted.specimen_file, law));
  return specimen;
}
} // namespace

std::vector<SpecimenOrder> specimen_orders(const std::vector<Variant>& variants)
{
  std::vector<std::string> rocks;
  std::vector<std::vector<std::size_t>> of_rock;
  for (std::size_t v = 0; v < variants.size(); ++v)
    {
      const std::string wanted = rock(variants[v].input);
      const auto known = std::find(rocks.begin(), rocks.end(), wanted);
      if (known != rocks.end())
        of_rock[std::size_t(known - rocks.begin())].push_back(v);
      else
        {
          rocks.push_back(wanted);
          of_rock.push_back({v});
        }
    }

  std::vector<SpecimenOrder> orders;
  for (const auto& users : of_rock)
    for (const std::uint64_t seed : variants[users.front()].input.seeds)
      {
        std::string name = "specimen";
        if (of_rock.size() > 1)
          name += fmt::format("_variant_{}", users.front() + 1);
        if (variants[users.front()].input.seeds.size() > 1)
          name += fmt::format("_seed_{}", seed);
        orders.push_back({users, seed, name});
      }
  return orders;
}

template <int dim>
std::vector<Specimen<dim>> provide_specimens(const std::vector<Variant>& variants,
                                             const std::vector<SpecimenOrder>& orders,
                                             const std::filesystem::path& folder, Progress& progress)
{
  check_memory(variants, orders);
  std::vector<Specimen<dim>> specimens(orders.size());
  std::vector<double> done(orders.size(), 0.0);
  std::mutex showing;
  progress.start("genesis");
  for_each_job(orders.size(), [&](const std::size_t k) {
    const auto monitor = [&](std::string_view, const double fraction) {
      end_if_interrupted();
      const std::lock_guard lock(showing);
      done[k] = fraction;
      double sum = 0.0;
      for (const double share : done)
        sum += share / double(done.size());
      progress.update(sum, fmt::format("{} specimen(s)", done.size()));
    };
    const Input& input = variants[orders[k].variants.front()].input;
    const auto file = folder / (orders[k].name + ".h5");
    if (std::filesystem::exists(file))
      try
        {
          specimens[k] = read_specimen<dim>(file);
          return;
        }
      catch (const InputError& error)
        {
          fmt::print(stderr, "feldspar: {}; making it anew\n", error.what());
        }
    specimens[k] = input.specimen.specimen_file.empty()
                     ? make_specimen<dim>(input.specimen, joint_parameters(input), input.particle_contact,
                                          orders[k].seed, monitor, end_if_interrupted)
                     : read_finished_specimen<dim>(input.specimen);
    write_specimen(specimens[k], file);
  });
  progress.finish(fmt::format("{} specimen(s) of {} grains", specimens.size(), specimens.front().grains.size()));
  return specimens;
}

std::string describe(const SpecimenReport& report)
{
  return fmt::format("grains                                   {}\n"
                     "joints                                   {}\n"
                     "coordination number                      {:.3f}\n"
                     "  of grains 3 diameters from the walls   {:.3f}\n"
                     "installation gap over mean radius        {:.4f}\n"
                     "porosity                                 {:.4f}\n"
                     "overlap over mean radius, mean / largest {:.2e} / {:.2e}\n"
                     "width over mean grain diameter           {:.1f}\n"
                     "radii scaled by                          {:.4f}\n",
                     report.n_grains, report.n_joints, report.coordination_number, report.coordination_number_core,
                     report.installation_gap_ratio, report.porosity, report.mean_overlap_ratio,
                     report.largest_overlap_ratio, report.resolution, report.radius_multiplier);
}

template std::vector<Specimen<3>> provide_specimens<3>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                                       const std::filesystem::path&, Progress&);
template std::vector<Specimen<2>> provide_specimens<2>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                                       const std::filesystem::path&, Progress&);
} // namespace feldspar
