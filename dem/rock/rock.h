#pragma once

#include "dem/flaws/clumps.h"
#include "dem/flaws/mineral_grains.h"
#include "dem/flaws/shapes.h"
#include "dem/laws/joint_laws.h"
#include "dem/laws/parameters.h"
#include "dem/minerals/parameters.h"
#include "dem/specimen/parameters.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace feldspar
{
/// Grains, joints and all that is put into them.
struct RockParameters
{
  SpecimenParameters specimen;
  JointParameters joint;
  ParticleContactParameters particle_contact;
  MineralParameters minerals;
  std::vector<Shape> flaws;
  SmoothJointParameters smooth_joint; ///< of flaws and mineral grains
  MineralGrainParameters mineral_grains;
  ClumpParameters clumps;
};

/// Makes the specimen of a rock, or reads that of `rock.specimen.specimen_file`, with its minerals, flaws, mineral grains and clumps.
/// The seed fixes every bit. Throws InputError where they cannot be fulfilled. `check` and `check_within` as of make_specimen().
template <int dim>
Specimen<dim> make_rock(
  const RockParameters& rock, std::uint64_t seed, const std::function<void()>& check = [] {},
  const std::function<void()>& check_within = [] {});
} // namespace feldspar
