#pragma once

#include "app/input/input.h"
#include "calibration/elastic_table.h"
#include "calibration/responses.h"
#include "calibration/unknowns.h"
#include "results/folder/reference.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace feldspar::calibration
{
/// The targets of a calibration and its unknowns, by the input and its reference file.
struct Problem
{
  Reference reference;
  std::vector<Response> responses;
  std::vector<Target> targets;
  std::vector<Unknown> unknowns;
  bool has_modulus = false;  ///< a target tells the scale of stiffness
  bool has_strength = false; ///< one tells the scale of strength

  const Response& response_of(const Target& target) const { return responses[target.response]; }
};

/// Throws InputError where the reference file does not serve.
Problem problem_of(const Input& input);

/// The target of a scale, the first if there are several [SI].
std::optional<double> target_of(const Problem& problem, ResponseScale scale);

/// `fixed` with the scales of the targets: a rough one of stiffness, cells having some 0.8 of the modulus of their joints.
MicroParameters first_guess(const Problem& problem, const MicroParameters& fixed);

/// Refuses a Poisson's ratio that the intact rock cannot have, before anything is broken.
void check_poissons_ratio(const Problem& problem, const CalibrationParameters& wanted, const ElasticTable& elastic);

/// Refuses what `feldspar calibrate` cannot run, before any work; throws InputError. It needs no statistics, so that the
/// program without them can ask it too.
void check_input(const Input& input, const std::filesystem::path& input_file);
} // namespace feldspar::calibration
