#pragma once

#include "dem/laws/joint_laws.h"
#include "dem/laws/parameters.h"
#include "dem/specimen/parameters.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <functional>

namespace feldspar
{
/// Makes a specimen: packs grains to the wanted stress or reads a packing, then installs joints; docs/theory.md
/// §3. The seed fixes every bit. Throws InputError where the wanted specimen cannot be made.
/// `check` is called at every step of the packing, `check_within` within steps and between all parts of genesis too, which
/// take seconds for millions of grains. Both may throw to end it.
template <int dim>
Specimen<dim> make_specimen(
  const SpecimenParameters& wanted, const JointParameters& joint, const ParticleContactParameters& particle_contact,
  std::uint64_t seed, const std::function<void()>& check = [] {}, const std::function<void()>& check_within = [] {});

/// Joints of the law that the parameters are of, stress free, between the grains of a specimen that has none; fills in
/// its report. `bonds`: exactly these pairs get one; empty: those that come near enough. `check` as of pairs_within().
template <int dim>
void install_joints(
  Specimen<dim>& specimen, const JointParameters& joint, const std::vector<GrainPair>& bonds = {},
  const std::function<void()>& check = [] {});
} // namespace feldspar
