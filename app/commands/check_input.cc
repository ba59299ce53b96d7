#include "app/calibration/problem.h"
#include "app/commands/commands.h"
#include "app/input/joint_sections.h"
#include "app/processes/mpi_session.h"
#include "app/programme/checks.h"
#include "app/programme/genesis_effort.h"
#include "app/programme/laboratory_effort.h"
#include "app/programme/sample_checks.h"
#include "app/programme/specimen_source.h"
#include "app/programme/usual_ranges.h"
#include "app/run/interrupt.h"
#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "coupling/rve/rve_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace feldspar
{
namespace
{
using Remarks = std::vector<std::string>;

/// Looks at the specimen that a specimen file brings, in its dimension; at nothing where there is no such file.
template <typename Use>
void with_specimen_of_file(const Input& input, const Use& use)
{
  if (input.specimen.specimen_file.empty())
    return;
  if (input.specimen.dimension == 2)
    use(make_rock<2>(rock_of(input), 0, end_if_interrupted, end_if_interrupted));
  else
    use(make_rock<3>(rock_of(input), 0, end_if_interrupted, end_if_interrupted));
}

Remarks check_lab(const Input& input, const std::filesystem::path& file)
{
  check_laboratory_input(input, file);
  check_memory_of_tests(RunPlan(input));
  with_specimen_of_file(
    input, [&](const auto& specimen) { with_name_of(file, [&] { check_specimen_of_file(input, specimen.shape); }); });
  return entries_without_effect(variants(input));
}

Remarks check_multiscale(const Input& input, const std::filesystem::path& file)
{
  check_sample_entries(input, file);
  Remarks remarks;
  const auto with_mesh = [&] {
    remarks = check_sample_input(input, file);
    return 0;
  };
  with_mpi(with_mesh, mpi_and_finite_elements); // takes a second to come up
  if (input.sample.has_grains())
    with_specimen_of_file(input, [&]<int dim>(const Specimen<dim>& specimen) {
      with_name_of(file, [&] {
        check_cell(specimen.shape, "the RVE at a point");
        check_intact(input, Network<dim>(specimen));
      });
    });
  return remarks;
}

Remarks check_rve(const Input& input, const std::filesystem::path& file)
{
  check_rve_input(input, file);
  const RunPlan plan(input);
  check_memory(plan, plan.orders);
  with_specimen_of_file(input, [&]<int dim>(const Specimen<dim>& specimen) {
    with_name_of(file, [&] { check_cell(specimen.shape, "a representative volume"); });
    if (read_rve_state(input.specimen.specimen_file, Network<dim>(specimen)))
      check_rve_out_of_sample(input);
  });
  return {};
}

Remarks check_specimen(const Input& input, const std::filesystem::path& /*file*/)
{
  const RunPlan plan(input);
  check_memory(plan, plan.orders);
  with_specimen_of_file(input, [](const auto&) {});
  return {};
}

/// The same without remarks.
template <auto check>
Remarks check_only(const Input& input, const std::filesystem::path& file)
{
  check(input, file);
  return {};
}

/// Throws InputError.
struct Check
{
  std::string_view command;
  Remarks (*of)(const Input& input, const std::filesystem::path& file);
};

/// Checks of commands_with_input, in the same order.
constexpr std::array checks{Check{"lab", check_lab},
                            Check{"rve", check_rve},
                            Check{"multiscale", check_multiscale},
                            Check{"calibrate", check_only<calibration::check_input>},
                            Check{"specimen", check_specimen},
                            Check{"contact", check_only<contact_response>}};
static_assert(std::equal(checks.begin(), checks.end(), commands_with_input.begin(), commands_with_input.end(),
                         [](const Check& check, const CommandWithInput& command) {
                           return check.command == command.name;
                         }));

/// Checks one input for every command.
void check_for_all(const Input& input, const std::filesystem::path& file)
{
  const std::string beginning = file.string() + ": ";
  std::vector<std::string_view> takers;
  std::string lines;
  bool any_tests_rock = false;
  for (std::size_t k = 0; k < checks.size(); ++k)
    if (const CommandWithInput& command = commands_with_input[k];
        command.name == "contact" && input.contact.path_file.empty())
      continue; // nobody means it so
    else
      try
        {
          for (const std::string& remark : checks[k].of(input, file))
            lines += fmt::format("  for feldspar {}: {}\n", command.name, remark);
          takers.push_back(command.name);
          any_tests_rock |= command.tests_rock;
        }
      catch (const InputError& error)
        {
          const std::string_view why = error.what();
          lines += fmt::format("  not for feldspar {}: {}\n", command.name,
                               why.starts_with(beginning) ? why.substr(beginning.size()) : why);
        }
  if (takers.empty())
    print_result("{}: refused\n{}", file.string(), lines);
  else
    print_result("{}: OK for feldspar {}\n{}", file.string(), fmt::join(takers, ", "), lines);
  if (!any_tests_rock)
    throw InputError("{}: no command that tests rock takes it; the reasons stand above", file.string());
}
} // namespace

void check_input(const std::filesystem::path& file, const std::vector<std::string>& settings,
                 const std::string& command)
{
  const Input input = read_input(file, {}, settings);
  reference_of(input); // one that does not serve is wrong for all
  Remarks unusual = unusual_values(variants(input));
  if (!input.flaws.left_out.empty())
    unusual.push_back(input.flaws.left_out);
  const auto print_remarks = [](const Remarks& remarks) {
    for (const std::string& remark : remarks)
      print_result("  {}\n", remark);
  };
  if (command.empty())
    {
      check_for_all(input, file);
      print_remarks(unusual);
      return;
    }
  const auto wanted = std::ranges::find(commands_with_input, command, &CommandWithInput::name);
  const Remarks remarks = checks[std::size_t(wanted - commands_with_input.begin())].of(input, file);
  print_result("{}: OK for feldspar {}\n", file.string(), command);
  print_remarks(remarks);
  print_remarks(unusual);
}
} // namespace feldspar
