#include "app/calibration/problem.h"

#include "base/input_error.h"
#include "dem/lab/protocols/protocols.h"

#include <fmt/format.h>

#include <string>
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
    throw InputError(
      fmt::format("an initial Poisson's ratio of {:.3f} cannot be reached: the intact rock has {:.3f} to "
                  "{:.3f} between the bounds of section Calibration; widen those of Stiffness ratio or "
                  "Installation gap ratio, or correct the reference file",
                  *target, least.poissons_ratio, largest.poissons_ratio));
}
} // namespace feldspar::calibration
