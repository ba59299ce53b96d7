#include "app/calibration/problem.h"

#include "app/programme/checks.h"
#include "base/input_error.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/surroundings.h"

#include <utility>

namespace feldspar::calibration
{
Problem problem_of(const Input& input)
{
  Problem problem;
  problem.reference = read_reference(input.reference_file, test_kinds());
  problem.responses = responses(test_cases(input.test_list, input.confinements), input.calibration);
  problem.targets = targets(problem.responses, problem.reference, input.calibration);
  problem.unknowns = unknowns(input.calibration);
  for (const Target& target : problem.targets)
    {
      problem.has_modulus |= problem.response_of(target).scale == ResponseScale::modulus;
      problem.has_strength |= problem.response_of(target).scale == ResponseScale::strength;
    }
  return problem;
}

std::optional<double> target_of(const Problem& problem, const ResponseScale scale)
{
  for (const Target& target : problem.targets)
    if (problem.response_of(target).scale == scale)
      return target.value;
  return std::nullopt;
}

namespace
{
/// A scale to begin with, of flat joints as they usually are: σ_t is some 0.45 of the bonds' strength, UCS some 7 times.
double first_bond_strength(const Problem& problem, const double otherwise)
{
  for (const auto& [name, share] : {std::pair("tensile_strength", 0.45), std::pair("brazilian_strength", 0.45),
                                    std::pair("uniaxial_compressive_strength", 7.0)})
    for (const Target& target : problem.targets)
      if (problem.response_of(target).name == name)
        return target.value / share;
  return otherwise;
}

void check(const Input& input)
{
  const SpecimenParameters& specimen = input.specimen;
  if (specimen.joint_law != "flat joint")
    throw InputError("Specimen/Joint law = {}: only the flat joint is calibrated", specimen.joint_law);
  if (!specimen.specimen_file.empty() || !specimen.packing_file.empty())
    throw InputError("Specimen: a calibration makes its own packings; name no Packing file and no Specimen file");
  if (input.minerals.form_of_rock() != MineralGrainForm::breakable)
    throw InputError("Minerals/Grains: a calibration is of breakable mineral grains; set Grains = breakable");
  if (input.minerals.map)
    throw InputError(
      "Minerals/Map: shows one body, and a calibration packs several; give shares and sizes in Minerals/Table");
  if (input.clumps.diameter)
    throw InputError("Clumps: a calibration is of grains that move each for itself; take the section out");
  if (!input.flaws.all().empty())
    throw InputError("Flaws: a calibration is of the intact rock; take the section out");
  if (!input.variants.entries.empty())
    throw InputError(
      "Variants/Entry: a calibration has no variants; the bounds of its unknowns are in section Calibration");
  if (input.tests.of<ConfinementParameters>().intermediate_stress)
    throw InputError(
      "Tests/Intermediate stress: a calibration presses its specimens alike from all sides; take the entry out");
  if (input.seeds.size() > 1)
    throw InputError("Seeds/Seeds: a calibration numbers its packings itself, from one seed on; give that one");
  check_specimen_and_tests(input);
  if (input.reference_file.empty())
    throw InputError("Report/Reference file: is needed; it has the laboratory's figures that are to be reached");
}

/// Problems that no fit can solve; a reference file that does not serve is reported by its own name.
void check_problem(const Problem& problem, const CalibrationParameters& wanted)
{
  if (problem.unknowns.empty())
    throw InputError("Calibration: all its ratios are fixed; give bounds to one of them at least");
  // A trend, and something left to tell its error by.
  if (const std::size_t least = problem.unknowns.size() + 3; wanted.n_points < least)
    throw InputError("Calibration/Design points = {}: must be at least {} for {} unknown ratios", wanted.n_points,
                     least, problem.unknowns.size());
}
} // namespace

MicroParameters first_guess(const Problem& problem, const MicroParameters& fixed)
{
  MicroParameters guess = fixed;
  if (const auto modulus = target_of(problem, ResponseScale::modulus))
    guess.modulus = *modulus / 0.8;
  if (problem.has_strength)
    guess.bond_tensile_strength = first_bond_strength(problem, fixed.bond_tensile_strength);
  return guess;
}

void check_poissons_ratio(const Problem& problem, const CalibrationParameters& wanted, const ElasticTable& elastic)
{
  const auto target = target_of(problem, ResponseScale::none);
  if (!target || wanted.poissons_ratio != ElasticFigure::initial)
    return; // cracks raise the secant: the design will tell
  const auto& [least, largest] = elastic.range();
  // Specimens between walls differ from cells by some hundredths.
  constexpr double of_walls = 0.03;
  if (*target < least.poissons_ratio - of_walls || *target > largest.poissons_ratio + of_walls)
    throw InputError("an initial Poisson's ratio of {:.3f} cannot be reached: the intact rock has {:.3f} to "
                     "{:.3f} between the bounds of section Calibration; widen those of Stiffness ratio or "
                     "Installation gap ratio, or correct the reference file",
                     *target, least.poissons_ratio, largest.poissons_ratio);
}

void check_input(const Input& input, const std::filesystem::path& input_file)
{
  with_name_of(input_file, [&] { check(input); });
  const Problem problem = problem_of(input);
  with_name_of(input_file, [&] { check_problem(problem, input.calibration); });
}
} // namespace feldspar::calibration
