#include "app/commands/check_input.h"

#include "app/calibration/input_check.h"
#include "app/commands/commands.h"
#include "app/programme/checks.h"
#include "app/programme/genesis_effort.h"
#include "app/programme/specimen_source.h"
#include "app/programme/test_effort.h"
#include "app/programme/usual_ranges.h"
#include "app/run/launched.h"
#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "coupling/rve/rve_file.h"
#include "dem/lab/protocols/protocols.h"
#include "results/folder/reference.h"

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
template <typename Look>
void with_specimen_of_file(const Input& input, const Look& look)
{
  if (input.specimen.specimen_file.empty())
    return;
  if (input.specimen.dimension == 2)
    look(specimen_of_file<2>(input));
  else
    look(specimen_of_file<3>(input));
}

Remarks check_lab(const Input& input, const std::filesystem::path& file)
{
  check_laboratory_input(input, file);
  const auto all_variants = variants(input);
  check_memory_of_tests(all_variants, specimen_orders(all_variants));
  with_specimen_of_file(
    input, [&](const auto& specimen) { with_name_of(file, [&] { check_specimen_of_file(input, specimen); }); });
  return {};
}

Remarks check_multiscale(const Input& input, const std::filesystem::path& file)
{
  check_sample_entries(input, file);
  Remarks remarks;
  with_mpi([&] { // takes a second to come up
    remarks = check_sample_input(input, file);
    return 0;
  });
  if (input.sample.has_grains())
    with_specimen_of_file(input, [&]<int dim>(const Specimen<dim>& specimen) {
      with_name_of(file, [&] {
        check_cell(specimen, "the RVE at a point");
        check_intact(input, Network<dim>(specimen));
      });
    });
  return remarks;
}

Remarks check_rve(const Input& input, const std::filesystem::path& file)
{
  check_rve_input(input, file);
  const auto all_variants = variants(input);
  check_memory(all_variants, specimen_orders(all_variants));
  with_specimen_of_file(input, [&]<int dim>(const Specimen<dim>& specimen) {
    with_name_of(file, [&] { check_cell(specimen, "a representative volume"); });
    if (read_rve_state(input.specimen.specimen_file, Network<dim>(specimen)))
      check_rve_out_of_sample(input);
  });
  return {};
}

Remarks check_calibrate(const Input& input, const std::filesystem::path& file)
{
  calibration::check_input(input, file);
  return {};
}

Remarks check_specimen(const Input& input, const std::filesystem::path& /*file*/)
{
  const auto all_variants = variants(input);
  check_memory(all_variants, specimen_orders(all_variants));
  with_specimen_of_file(input, [](const auto&) {});
  return {};
}

Remarks check_contact(const Input& input, const std::filesystem::path& file)
{
  contact_response(input, file);
  return {};
}

struct CommandCheck
{
  std::string_view command;
  bool tests_rock;
  Remarks (*check)(const Input& input, const std::filesystem::path& file); ///< throws InputError
};

constexpr std::array checks{CommandCheck{"lab", true, check_lab},
                            CommandCheck{"rve", true, check_rve},
                            CommandCheck{"multiscale", true, check_multiscale},
                            CommandCheck{"calibrate", true, check_calibrate},
                            CommandCheck{"specimen", false, check_specimen},
                            CommandCheck{"contact", true, check_contact}};

/// Of every command, on one input.
void check_for_all(const Input& input, const std::filesystem::path& file)
{
  const std::string beginning = file.string() + ": ";
  std::vector<std::string_view> takers;
  std::string lines;
  bool any_tests_rock = false;
  for (const CommandCheck& one : checks)
    if (one.command == "contact" && input.contact.path_file.empty())
      continue; // nobody means it so
    else
      try
        {
          for (const std::string& remark : one.check(input, file))
            lines += fmt::format("  for feldspar {}: {}\n", one.command, remark);
          takers.push_back(one.command);
          any_tests_rock |= one.tests_rock;
        }
      catch (const InputError& error)
        {
          const std::string_view why = error.what();
          lines += fmt::format("  not for feldspar {}: {}\n", one.command,
                               why.starts_with(beginning) ? why.substr(beginning.size()) : why);
        }
  if (takers.empty())
    print_result("{}: refused\n{}", file.string(), lines);
  else
    print_result("{}: OK for feldspar {}\n{}", file.string(), fmt::join(takers, ", "), lines);
  if (!any_tests_rock)
    throw InputError(fmt::format("{}: no command that tests rock takes it; the reasons stand above", file.string()));
}
} // namespace

std::vector<std::string> commands_with_input()
{
  std::vector<std::string> names;
  for (const CommandCheck& one : checks)
    names.emplace_back(one.command);
  return names;
}

void check_input(const std::filesystem::path& file, const std::vector<std::string>& settings,
                 const std::string& command)
{
  const Input input = read_input(file, {}, settings);
  if (!input.reference_file.empty())
    read_reference(input.reference_file, test_kinds()); // one that does not serve is wrong for all
  const Remarks unusual = unusual_values(variants(input));
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
  const auto wanted =
    std::find_if(checks.begin(), checks.end(), [&](const CommandCheck& one) { return one.command == command; });
  const Remarks remarks = wanted->check(input, file);
  print_result("{}: OK for feldspar {}\n", file.string(), command);
  print_remarks(remarks);
  print_remarks(unusual);
}
} // namespace feldspar
