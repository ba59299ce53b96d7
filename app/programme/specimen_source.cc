#include "app/programme/specimen_source.h"

#include "app/input/joint_sections.h"
#include "app/input/parameter_table.h"
#include "app/input/variant_names.h"
#include "app/programme/genesis_effort.h"
#include "app/programme/run_board.h"
#include "app/programme/usual_ranges.h"
#include "app/run/interrupt.h"
#include "base/input_error.h"
#include "dem/rock/rock.h"
#include "dem/specimen/specimen_file.h"
#include "runs/jobs.h"
#include "runs/share_out.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

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

/// Names of rocks, each by the values that all variants on it share.
std::vector<std::string> names_of_rocks(const std::vector<Variant>& variants,
                                        const std::vector<std::vector<std::size_t>>& of_rock)
{
  std::vector<std::vector<VariantSetting>> shared;
  std::vector<std::string> by_number;
  for (const auto& users : of_rock)
    {
      shared.push_back(variants[users.front()].settings);
      for (const std::size_t user : users)
        std::erase_if(shared.back(), [&](const VariantSetting& setting) {
          const auto& own = variants[user].settings;
          return std::none_of(own.begin(), own.end(), [&](const VariantSetting& other) {
            return other.entry == setting.entry && other.value == setting.value;
          });
        });
      by_number.push_back(fmt::format("variant_{}", users.front() + 1));
    }
  const bool any_without = std::any_of(shared.begin(), shared.end(), [](const auto& one) { return one.empty(); });
  return any_without || variants.front().input.variants.named_by_number ? by_number : names_in_files(shared);
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
  const auto names = names_of_rocks(variants, of_rock);
  for (std::size_t r = 0; r < of_rock.size(); ++r)
    for (const std::uint64_t seed : variants[of_rock[r].front()].input.seeds)
      {
        const auto& users = of_rock[r];
        std::string name = "specimen";
        if (of_rock.size() > 1)
          name += '_' + names[r];
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
  if (const std::string effort = describe_effort(variants, orders); !effort.empty())
    progress.remark(effort);
  for (const std::string& sentence : unusual_values(variants))
    progress.remark(sentence);
  if (const std::string& left_out = variants.front().input.flaws.left_out; !left_out.empty())
    progress.remark(left_out);
  if (const auto& settled = variants.front().input.settled_by_file; !settled.empty())
    progress.remark(fmt::format("the specimen is that of {};\nthese entries have no effect on it: {}",
                                variants.front().input.specimen.specimen_file, fmt::join(settled, ", ")));
  std::vector<Specimen<dim>> specimens(orders.size());
  const auto input_of = [&](const SpecimenOrder& order) -> const Input& {
    return variants[order.variants.front()].input;
  };
  std::vector<BoardPart> parts;
  for (const SpecimenOrder& order : orders)
    parts.push_back({order.name, expected_effort(input_of(order).specimen).seconds});
  RunBoard board(progress, "genesis", std::move(parts));
  for_each_job(orders.size(), [&](const std::size_t k) {
    const Input& input = input_of(orders[k]);
    const double expected_steps = expected_effort(input.specimen).n_steps;
    std::uint64_t n_steps = 0;
    const auto step = [&] {
      end_if_interrupted();
      constexpr std::uint64_t steps_between_checks = 100;
      constexpr double beyond = 1.2; // of one that takes longer than expected
      if (++n_steps % steps_between_checks == 0)
        board.advanced(k, {nullptr, double(n_steps) / std::max({expected_steps, beyond * double(n_steps), 1.0})});
    };
    const auto file = folder / (orders[k].name + ".h5");
    if (std::filesystem::exists(file))
      try
        {
          specimens[k] = read_specimen<dim>(file, end_if_interrupted);
          board.ended(k);
          return;
        }
      catch (const InputError& error)
        {
          board.say(fmt::format("{}; making it anew", error.what()));
        }
    specimens[k] = make_rock<dim>(rock_of(input), orders[k].seed, step, end_if_interrupted);
    write_specimen(specimens[k], file);
    board.ended(k);
  });
  progress.finish(fmt::format("{} specimen(s) of {} grains", specimens.size(), specimens.front().grains.size()));
  return specimens;
}

template <int dim>
void share_out_specimens(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                         const std::filesystem::path& folder, Progress& progress)
{
  together_or_interrupted([&] {
    if (const auto own = share_of_this_process(orders); !own.empty())
      provide_specimens<dim>(variants, own, folder, progress);
  });
}

std::string describe(const SpecimenReport& report)
{
  const std::string smooth = report.n_smooth_joints == 0
                               ? ""
                               : fmt::format("  smooth ones among them                 {}\n", report.n_smooth_joints);
  const std::string clumps =
    report.n_clumps == 0 ? "" : fmt::format("rigid groups of grains                   {}\n", report.n_clumps);
  const std::string coring =
    report.n_cut_joints == 0
      ? ""
      : fmt::format("cored: joints cut / grains removed       {} / {}\n", report.n_cut_joints, report.n_removed_grains);
  const std::string core = // a small specimen has no such grains
    std::isfinite(report.coordination_number_core) ? fmt::format("{:.3f}", report.coordination_number_core) : "-";
  return fmt::format("grains                                   {}\n{}"
                     "joints                                   {}\n{}"
                     "coordination number                      {:.3f}\n"
                     "  of grains 3 diameters from the walls   {}\n"
                     "installation gap over mean radius        {:.4f}\n"
                     "porosity                                 {:.4f}\n"
                     "overlap over mean radius, mean / largest {:.2e} / {:.2e}\n"
                     "width over mean grain diameter           {:.1f}\n"
                     "radii scaled by                          {:.4f}\n{}",
                     report.n_grains, clumps, report.n_joints, smooth, report.coordination_number, core,
                     report.installation_gap_ratio, report.porosity, report.mean_overlap_ratio,
                     report.largest_overlap_ratio, report.resolution, report.radius_multiplier, coring);
}

template <int dim>
std::string describe(const std::vector<Flaw<dim>>& flaws)
{
  // A joint set has many traces: kinds in the order in which they come first.
  struct Sum
  {
    std::string name;
    bool open;
    std::uint64_t n;
    std::uint64_t n_grains;
    std::uint64_t n_joints;
  };
  std::vector<Sum> sums;
  for (const auto& flaw : flaws)
    {
      auto sum = std::find_if(sums.begin(), sums.end(), [&](const Sum& one) { return one.name == flaw.name; });
      if (sum == sums.end())
        sum = sums.insert(sums.end(), {flaw.name, flaw.open, 0, 0, 0});
      ++sum->n;
      sum->n_grains += flaw.n_grains;
      sum->n_joints += flaw.n_joints;
    }
  std::string text;
  for (const Sum& sum : sums)
    text += sum.open
              ? fmt::format("{} × {}: {} grains and {} joints taken out\n", sum.n, sum.name, sum.n_grains, sum.n_joints)
              : fmt::format("{} × {}: {} joints unbonded or smooth\n", sum.n, sum.name, sum.n_joints);
  return text;
}

template void share_out_specimens<2>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                     const std::filesystem::path&, Progress&);
template void share_out_specimens<3>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                     const std::filesystem::path&, Progress&);
template std::string describe<2>(const std::vector<Flaw<2>>&);
template std::string describe<3>(const std::vector<Flaw<3>>&);
template std::vector<Specimen<3>> provide_specimens<3>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                                       const std::filesystem::path&, Progress&);
template std::vector<Specimen<2>> provide_specimens<2>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                                       const std::filesystem::path&, Progress&);
} // namespace feldspar
