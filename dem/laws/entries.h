#pragma once

#include "base/entries.h"
#include "dem/laws/parameters.h"

#include <vector>

/// The entries of contacts.
namespace feldspar
{
/// `entries` of a joint law, and behind them those that say which pairs get a joint and which joints a bond.
template <typename P>
std::vector<Entry<P>> and_installation(std::vector<Entry<P>> entries, const EntryFlags& of_rock,
                                       const EntryFlags& basic)
{
  // Other grains lie over a gap of a mean radius.
  for (
    const Entry<P>& entry :
    {entry::optional_number<P>("Installation gap ratio", &P::installation_gap_ratio, ranges::fraction,
                               "largest gap that gets a joint, over the mean radius; none where Coordination number is "
                               "given",
                               basic),
     entry::optional_number<P>(
       "Coordination number", &P::coordination_number, ranges::above_zero,
       "mean number of joints of a grain, instead of Installation gap ratio, which follows from it. Walls take joints: "
       "with one number small, walled and periodic bodies are different rocks",
       basic),
     entry::number<P>("Gapped fraction", &P::gapped_fraction, ranges::fraction,
                      "share of the joints without bonds and with an initial gap", of_rock),
     entry::number<P>("Slit fraction", &P::slit_fraction, ranges::fraction,
                      "share of the joints without bonds whose faces touch; with Gapped fraction at most 1", of_rock),
     entry::quantity<P>("Initial gap", &P::initial_gap, Measure::length, "mm", ranges::from_zero,
                        "of the gapped joints", of_rock)})
    entries.push_back(entry);
  return entries;
}

template <typename P>
Entry<P> strength_distribution_entry(const EntryFlags& of_rock)
{
  return entry::choice<P, StrengthDistribution>(
    "Strength distribution", &P::strength_distribution,
    {{"normal", StrengthDistribution::normal}, {"Weibull", StrengthDistribution::weibull}},
    "of the bonds, by their means and standard deviations. Weibull: its modulus follows from these, 5 for a standard "
    "deviation of 0.229 of the mean, 10 for 0.120, 20 for 0.062",
    of_rock);
}

/// The entries of the flat joint, and of laws with the same faces.
template <typename P>
std::vector<Entry<P>> flat_joint_entries()
{
  const EntryFlags of_rock{.varies = true, .of_specimen = true};
  const EntryFlags basic{.varies = true, .of_specimen = true, .basic = true};
  const EntryFlags in_plane{.varies = true,
                            .of_specimen = true,
                            .bodies = {Body::plane_box, Body::sample},
                            .needs =
                              "divides a face between discs; of spheres (Dimension = 3) it is Rings and Sectors"};
  const EntryFlags in_space{.varies = true,
                            .of_specimen = true,
                            .bodies = {Body::box, Body::cylinder, Body::sample},
                            .needs = "divides a face between spheres (Dimension = 3); of discs it is Segments"};
  const std::vector<Entry<P>> entries{
    entry::integer<P>("Segments", &P::n_segments, {'[', 1.0, 32.0, ']'},
                      "of a face in two dimensions, each of which breaks by itself", in_plane),
    entry::integer<P>("Rings", &P::n_rings, {'[', 1.0, 16.0, ']'}, "of a face in three dimensions, of equal width",
                      in_space),
    entry::integer<P>("Sectors", &P::n_sectors, {'[', 3.0, 32.0, ']'},
                      "of each ring, of equal angle; each of Rings x Sectors elements breaks by itself", in_space),
    entry::quantity<P>("Modulus", &P::modulus, Measure::stress, "GPa", ranges::above_zero,
                       "E; the normal stiffness is E over the sum of both radii", basic),
    entry::number<P>("Stiffness ratio", &P::stiffness_ratio, ranges::above_zero, "normal over shear stiffness", basic),
    entry::number<P>("Friction", &P::friction, ranges::from_zero, "coefficient, of broken segments", basic),
    entry::number<P>("Radius multiplier", &P::radius_multiplier, ranges::above_zero,
                     "half length of the face over the radius of the smaller grain", of_rock),
    entry::quantity<P>("Bond tensile strength", &P::bond_tensile_strength, Measure::stress, "MPa", ranges::from_zero,
                       "mean; a segment breaks in tension beyond it", basic),
    entry::quantity<P>("Bond tensile strength standard deviation", &P::bond_tensile_strength_deviation, Measure::stress,
                       "MPa", ranges::from_zero, "of the distribution; a normal one is redrawn while negative", basic),
    entry::quantity<P>("Bond cohesion", &P::bond_cohesion, Measure::stress, "MPa", ranges::from_zero,
                       "mean; shear strength of a bond without normal stress", basic),
    entry::quantity<P>("Bond cohesion standard deviation", &P::bond_cohesion_deviation, Measure::stress, "MPa",
                       ranges::from_zero, "of the distribution; a normal one is redrawn while negative", basic),
    entry::quantity<P>("Bond friction angle", &P::bond_friction_angle, Measure::angle, "deg", {'[', 0.0, 90.0, ')'},
                       "by which compression adds to the shear strength of a bond", basic),
    strength_distribution_entry<P>(of_rock),
    entry::choice<P, StrengthDraw>(
      "Strength draw", &P::strength_draw,
      {{"per segment", StrengthDraw::per_segment}, {"per contact", StrengthDraw::per_contact}},
      "whether the segments of a face draw their strengths one by one or together", of_rock)};
  return and_installation(entries, of_rock, basic);
}

// The entries of each joint law, by the type of its parameters; its section has the name of the law.

inline std::vector<Entry<FlatJointParameters>> joint_entries(const FlatJointParameters&)
{
  return flat_joint_entries<FlatJointParameters>();
}

inline std::vector<Entry<SofteningFlatJointParameters>> joint_entries(const SofteningFlatJointParameters&)
{
  using P = SofteningFlatJointParameters;
  std::vector<Entry<P>> entries = flat_joint_entries<P>();
  for (Entry<P>& entry : entries)
    {
      entry.flags.basic = false;
      if (entry.name == "Bond tensile strength")
        entry.meaning = "mean; beyond it the stress of a segment falls as Softening opening says";
      else if (entry.name == "Friction")
        entry.meaning = "coefficient, of segments that are broken or soften in shear";
    }
  entries.push_back(entry::quantity("Softening opening", &P::softening_opening, Measure::length, "um",
                                    Range{'[', 0.0, 1e6, ']'}, // a metre: no bond is as long
                                    "over which the stress of a bond falls along a straight line from its strength to "
                                    "zero, in tension and in shear",
                                    {.varies = true, .of_specimen = true}));
  return entries;
}

inline std::vector<Entry<ParallelBondParameters>> joint_entries(const ParallelBondParameters&)
{
  using P = ParallelBondParameters;
  const EntryFlags of_rock{.varies = true, .of_specimen = true};
  const std::vector<Entry<P>> entries{
    entry::quantity("Modulus", &P::modulus, Measure::stress, "GPa", ranges::above_zero,
                    "of the bond; its normal stiffness is this over the sum of both radii, beside that of the linear "
                    "contact, section Particle contact",
                    of_rock),
    entry::number("Stiffness ratio", &P::stiffness_ratio, ranges::above_zero, "normal over shear stiffness of the bond",
                  of_rock),
    entry::number("Radius multiplier", &P::radius_multiplier, ranges::above_zero,
                  "half length of the bond over the radius of the smaller grain", of_rock),
    entry::number("Moment contribution", &P::moment_contribution, ranges::fraction,
                  "share of the stress by bending and twist that counts for breaking", of_rock),
    entry::quantity("Tensile strength", &P::bond_tensile_strength, Measure::stress, "MPa", ranges::from_zero,
                    "mean; a bond breaks in tension beyond it", of_rock),
    entry::quantity("Tensile strength standard deviation", &P::bond_tensile_strength_deviation, Measure::stress, "MPa",
                    ranges::from_zero, "of the distribution; a normal one is redrawn while negative", of_rock),
    entry::quantity("Cohesion", &P::bond_cohesion, Measure::stress, "MPa", ranges::from_zero,
                    "mean; shear strength of a bond without normal force", of_rock),
    entry::quantity("Cohesion standard deviation", &P::bond_cohesion_deviation, Measure::stress, "MPa",
                    ranges::from_zero, "of the distribution; a normal one is redrawn while negative", of_rock),
    entry::quantity("Friction angle", &P::bond_friction_angle, Measure::angle, "deg", {'[', 0.0, 90.0, ')'},
                    "by which compression adds to the shear strength of a bond", of_rock),
    strength_distribution_entry<P>(of_rock)};
  return and_installation(entries, of_rock, of_rock);
}

/// The entries of section Smooth joint.
inline std::vector<Entry<SmoothJointParameters>> smooth_joint_entries()
{
  using P = SmoothJointParameters;
  const EntryFlags of_rock{.varies = true, .of_specimen = true};
  return {
    entry::quantity("Normal stiffness", &P::normal_stiffness, Measure::stiffness, "GPa/mm", ranges::above_zero,
                    "normal stress over what the sides close", of_rock),
    entry::quantity("Shear stiffness", &P::shear_stiffness, Measure::stiffness, "GPa/mm", ranges::above_zero,
                    "shear stress over the way along the plane", of_rock),
    entry::number("Friction", &P::friction, ranges::from_zero, "coefficient, of sides without a bond", of_rock),
    entry::quantity("Dilation angle", &P::dilation_angle, Measure::angle, "deg", {'[', 0.0, 90.0, ')'},
                    "by which sides that slide move apart; at most the angle of the friction", of_rock),
    entry::quantity("Tensile strength", &P::tensile_strength, Measure::stress, "MPa", ranges::from_zero,
                    "of the bond at the boundaries of mineral grains; flaws have the strengths that their own words "
                    "give, and none without",
                    of_rock),
    entry::quantity("Cohesion", &P::cohesion, Measure::stress, "MPa", ranges::from_zero,
                    "of the same: shear strength without normal stress", of_rock),
    entry::optional_quantity("Friction angle", &P::friction_angle, Measure::angle, "deg", {'[', 0.0, 90.0, ')'},
                             "of the same: by which compression adds to the shear strength; none: that of the friction",
                             of_rock)};
}

/// The entries of section Particle contact.
inline std::vector<Entry<ParticleContactParameters>> particle_contact_entries()
{
  using P = ParticleContactParameters;
  const EntryFlags basic{.varies = true, .of_specimen = true, .basic = true};
  return {
    entry::quantity("Modulus", &P::modulus, Measure::stress, "GPa", ranges::above_zero,
                    "of grains that touch without a face, of the contact beside a parallel bond, and of the packing",
                    basic),
    entry::number("Stiffness ratio", &P::stiffness_ratio, ranges::above_zero, "normal over shear stiffness", basic),
    entry::number("Friction", &P::friction, ranges::from_zero, "coefficient", basic)};
}
} // namespace feldspar
