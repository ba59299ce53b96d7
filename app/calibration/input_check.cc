#include "app/calibration/input_check.h"

#include "app/calibration/problem.h"
#include "app/programme/checks.h"
#include "base/input_error.h"
#include "dem/lab/surroundings.h"

#include <fmt/format.h>

#include <string>

namespace feldspar::calibration
{
namespace
{
void check(const Input& input)
{
  const auto refuse = [&](const std::string& what) { throw InputError(what); };
  const SpecimenParameters& specimen = input.specimen;
  if (specimen.joint_law != "flat joint")
    refuse(fmt::format("Specimen/Joint law = {}: only the flat joint is calibrated", specimen.joint_law));
  if (!specimen.specimen_file.empty() || !specimen.packing_file.empty())
    refuse("Specimen: a calibration makes its own packings; name no Packing file and no Specimen file");
  if (input.clumps.diameter)
    refuse("Clumps: a calibration is of grains that move each for itself; take the section out");
  if (!input.flaws.all().empty())
    refuse("Flaws: a calibration is of the intact rock; take the section out");
  if (!input.variants.entries.empty())
    refuse("Variants/Entry: a calibration has no variants; the bounds of its unknowns are in section Calibration");
  if (input.tests.of<ConfinementParameters>().intermediate_stress)
    refuse("Tests/Intermediate stress: a calibration presses its specimens alike from all sides; take the entry out");
  if (input.seeds.size() > 1)
    refuse("Seeds/Seeds: a calibration numbers its packings itself, from one seed on; give that one");
  check_specimen_and_tests(input);
  if (input.reference_file.empty())
    refuse("Report/Reference file: is needed; it has the laboratory's figures that are to be reached");
}

/// Problems that no fit can solve; a reference file that does not serve is reported by its own name.
void check_problem(const Problem& problem, const CalibrationParameters& wanted)
{
  if (problem.unknowns.empty())
    throw InputError("Calibration: all its ratios are fixed; give bounds to one of them at least");
  // A trend, and something left to tell its error by.
  if (const std::size_t least = problem.unknowns.size() + 3; wanted.n_points < least)
    throw InputError(fmt::format("Calibration/Design points = {}: must be at least {} for {} unknown ratios",
                                 wanted.n_points, least, problem.unknowns.size()));
}

} // namespace

void check_input(const Input& input, const std::filesystem::path& input_file)
{
  with_name_of(input_file, [&] { check(input); });
  const Problem problem = problem_of(input);
  with_name_of(input_file, [&] { check_problem(problem, input.calibration); });
}
} // namespace feldspar::calibration
