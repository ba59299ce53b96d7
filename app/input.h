#pragma once

#include "dem/lab_results.h"
#include "dem/parameters.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// The pair of grains of `feldspar contact`.
struct ContactParameters
{
  double radius_1 = 1e-3; ///< [m]
  double radius_2 = 1e-3; ///< [m]
  std::string path_file;  ///< CSV of the displacements
};

/// All that an input file says. A default-constructed value is what an empty file means.
struct Input
{
  std::filesystem::path folder; ///< relative paths of the input are relative to this
  SpecimenParameters specimen;
  FlatJointParameters flat_joint{.installation_gap_ratio = std::nullopt, .coordination_number = 4.2};
  ParticleContactParameters particle_contact;
  DynamicsParameters dynamics;
  std::vector<TestKind> test_list{TestKind::direct_tension, TestKind::uniaxial_compression};
  TestParameters tests;
  std::vector<std::uint64_t> seeds{1};
  ContactParameters contact;
  std::string reference_file; ///< figures of the rock that results are set beside; empty: none
};

/// Reads and checks a .prm or .json file. A mistake in it throws InputError, one line with file, line and entry.
Input read_input(const std::filesystem::path& file);
} // namespace feldspar
