#include "app/programme/specimen_source.h"

#include "app/input/joint_sections.h"
#include "app/input/parameter_table.h"
#include "app/input/variant_names.h"
#include "app/programme/genesis_effort.h"
#include "app/programme/run_board.h"
#include "app/programme/usual_ranges.h"
#include "app/run/interrupt.h"
#include "base/append.h"
#include "base/checksum/fingerprint.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "dem/rock/rock.h"
#include "dem/specimen/specimen_file.h"
#include "runs/jobs.h"
#include "runs/share_out.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace feldspar
{
namespace
{
/// The entries that genesis reads, and their values; of files the names alone, or their paths.
std::string rock(const Input& input, const bool with_paths)
{
  std::string text;
  for (const Parameter& parameter : parameter_table())
    if (parameter.flags.of_specimen && has_use_for(input, parameter))
      {
        const std::string value = parameter.write(input);
        text += fmt::format(
          "{} = {}\n", parameter.name(),
          with_paths || parameter.range != none_or_a_file ? value : std::filesystem::path(value).filename().string());
      }
  return text;
}

/// A name for the entries and the seed of a specimen, by which another one in its place is noticed.
std::string origin(const Input& input, const std::uint64_t seed)
{
  Fingerprint print;
  // Paths change, for a run that is resumed names files from the root; their contents are checked by its record.
  print.add(rock(input, false));
  print.add(seed);
  return fmt::format("{:016x}", print.value());
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
          return std::ranges::none_of(own, [&](const VariantSetting& other) {
            return other.entry == setting.entry && other.value == setting.value;
          });
        });
      by_number.push_back(fmt::format("variant_{}", users.front() + 1));
    }
  const bool any_without = std::ranges::any_of(shared, [](const auto& one) { return one.empty(); });
  return any_without || variants.front().input.variants.named_by_number ? by_number : names_in_files(shared);
}
} // namespace

RunPlan::RunPlan(const Input& input)
  : variants(feldspar::variants(input))
{
  std::vector<std::string> rocks;
  std::vector<std::vector<std::size_t>> of_rock;
  for (std::size_t v = 0; v < variants.size(); ++v)
    {
      const std::string wanted = rock(variants[v].input, true);
      const auto known = std::ranges::find(rocks, wanted);
      of_rock.resize(std::max(of_rock.size(), std::size_t(known - rocks.begin()) + 1));
      of_rock[std::size_t(known - rocks.begin())].push_back(v);
      if (known == rocks.end())
        rocks.push_back(wanted);
    }
  const auto names = names_of_rocks(variants, of_rock);
  for (std::size_t r = 0; r < of_rock.size(); ++r)
    for (const std::uint64_t seed : variants[of_rock[r].front()].input.seeds)
      {
        std::string name = "specimen";
        if (of_rock.size() > 1)
          name += '_' + names[r];
        if (variants[of_rock[r].front()].input.seeds.size() > 1)
          name += fmt::format("_seed_{}", seed);
        orders.push_back({of_rock[r], seed, name});
      }
}

std::vector<std::pair<std::size_t, std::size_t>> RunPlan::parts() const
{
  std::vector<std::pair<std::size_t, std::size_t>> all;
  for (std::size_t v = 0; v < variants.size(); ++v)
    for (std::size_t s = 0; s < orders.size(); ++s)
      if (contains(orders[s].variants, v))
        all.emplace_back(v, s);
  return all;
}

template <int dim>
std::vector<Specimen<dim>> provide_specimens(const RunPlan& plan, const std::set<std::size_t>& numbers,
                                             const std::filesystem::path& folder, Progress& progress)
{
  std::vector<Specimen<dim>> specimens(plan.orders.size());
  if (numbers.empty())
    return specimens;
  std::vector<SpecimenOrder> orders;
  std::vector<BoardPart> parts;
  for (const std::size_t k : numbers)
    {
      orders.push_back(plan.orders[k]);
      parts.push_back({orders.back().name, expected_effort(plan.input_of(orders.back()).specimen).seconds});
    }
  const Input& first = plan.variants.front().input;
  std::vector<SpecimenOrder> made;
  std::ranges::copy_if(orders, std::back_inserter(made), [&](const SpecimenOrder& order) {
    return plan.input_of(order).specimen.specimen_file.empty() &&
           !std::filesystem::exists(folder / (order.name + ".h5"));
  });
  check_memory(plan, made);
  std::vector<std::string> remarks{describe_effort(plan, made)};
  append(remarks, unusual_values(plan.variants));
  remarks.push_back(first.flaws.left_out);
  if (!first.settled_by_file.empty())
    remarks.push_back(fmt::format("the specimen is that of {};\nthese entries have no effect on it: {}",
                                  first.specimen.specimen_file, fmt::join(first.settled_by_file, ", ")));
  for (const std::string& remark : remarks)
    if (!remark.empty())
      progress.remark(remark);
  RunBoard board(progress, "genesis", parts);
  for_each_job(orders.size(), [&](const std::size_t job) {
    const Input& input = plan.input_of(orders[job]);
    Specimen<dim>& specimen = specimens[*std::next(numbers.begin(), std::ptrdiff_t(job))];
    const double expected_steps = expected_effort(input.specimen).n_steps;
    std::uint64_t n_steps = 0;
    const auto step = [&] {
      end_if_interrupted();
      constexpr std::uint64_t steps_between_checks = 100;
      constexpr double beyond = 1.2; // of one that takes longer than expected
      if (++n_steps % steps_between_checks == 0)
        board.advanced(job, {nullptr, double(n_steps) / std::max({expected_steps, beyond * double(n_steps), 1.0})});
    };
    const auto file = folder / (orders[job].name + ".h5");
    const std::string made_of = origin(input, orders[job].seed);
    if (std::filesystem::exists(file))
      try
        {
          if (const std::string of_file = head_of_specimen(file, end_if_interrupted).made_of;
              !of_file.empty() && of_file != made_of)
            throw InputError("{}: not the specimen of this run", file.string());
          specimen = read_specimen<dim>(file, end_if_interrupted);
          board.ended(job);
          return;
        }
      catch (const InputError& error)
        {
          board.goes_back(fmt::format("{}; making it anew", error.what()));
        }
    specimen = make_rock<dim>(rock_of(input), orders[job].seed, step, end_if_interrupted);
    write_specimen(specimen, file, made_of);
    board.ended(job);
  });
  progress.finish(fmt::format("{} specimen(s) of {} grains", orders.size(), specimens[*numbers.begin()].grains.size()));
  return specimens;
}

template <int dim>
void share_out_specimens(const RunPlan& plan, const std::filesystem::path& folder, Progress& progress)
{
  together_or_interrupted([&] {
    std::set<std::size_t> own;
    for (std::size_t k = ranks::mine(); k < plan.orders.size(); k += ranks::number())
      own.insert(k);
    provide_specimens<dim>(plan, own, folder, progress);
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
      auto sum = std::ranges::find(sums, flaw.name, &Sum::name);
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

template void share_out_specimens<2>(const RunPlan&, const std::filesystem::path&, Progress&);
template void share_out_specimens<3>(const RunPlan&, const std::filesystem::path&, Progress&);
template std::string describe<2>(const std::vector<Flaw<2>>&);
template std::string describe<3>(const std::vector<Flaw<3>>&);
template std::vector<Specimen<2>> provide_specimens<2>(const RunPlan&, const std::set<std::size_t>&,
                                                       const std::filesystem::path&, Progress&);
template std::vector<Specimen<3>> provide_specimens<3>(const RunPlan&, const std::set<std::size_t>&,
                                                       const std::filesystem::path&, Progress&);
} // namespace feldspar
