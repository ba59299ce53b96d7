#pragma once

#include "coupling/rve/parameters.h"
#include "coupling/sample/sample_parameters.h"
#include "dem/dynamics/parameters.h"
#include "dem/flaws/shapes.h"
#include "dem/lab/parameters.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/laws/parameters.h"
#include "dem/specimen/parameters.h"
#include "results/kinds.h"

#include <cstdint>
#include <filesystem>
#include <optional>
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

/// How a volume is led along its path.
enum class PathSolver
{
  event_by_event,
  explicit_dynamics
};

/// The path of `feldspar rve`.
struct StrainPathParameters
{
  std::string path_file;                        ///< CSV of points; empty: a direction
  std::vector<std::optional<double>> direction; ///< of the strain, tensor shear; none: free, at its confinement
  double size = 1e-3;                           ///< of the strain at the end, over the direction
  double confining_pressure = 0.0;              ///< compression positive [Pa]
  double largest_step = 1e-5;                   ///< of any component of the strain
  PathSolver solver = PathSolver::event_by_event;
  unsigned int steps_per_millistrain = 100000; ///< of explicit dynamics
};

/// All that an input file says. A default-constructed value is what an empty file means.
struct Input
{
  std::filesystem::path folder; ///< relative paths of the input are relative to this
  SpecimenParameters specimen;
  FlawParameters flaws;
  FlatJointParameters flat_joint{.installation_gap_ratio = std::nullopt, .coordination_number = 4.2};
  ParallelBondParameters parallel_bond{.installation_gap_ratio = std::nullopt, .coordination_number = 4.2};
  ParticleContactParameters particle_contact;
  DynamicsParameters dynamics;
  std::vector<TestKind> test_list{direct_tension.kind, uniaxial_compression.kind};
  TestParameters tests;
  std::vector<double> confinements{5e6, 10e6, 20e6, 30e6, 40e6, 50e6, 60e6}; ///< of tests that take one [Pa]
  std::uint64_t steps_between_checkpoints = 20000;
  std::vector<std::uint64_t> seeds{1};
  std::string variant_entry;               ///< Section/Entry; empty: no variants
  std::vector<std::string> variant_values; ///< as they would stand in an input file
  ContactParameters contact;
  StrainPathParameters strain_path;
  EquilibriumParameters equilibrium;
  SampleParameters sample;
  ContinuumParameters continuum;
  std::string reference_file; ///< figures of the rock that results are set beside; empty: none
};

/// The same input but for one entry.
struct Variant
{
  std::string label; ///< Section/Entry = value; empty where there are no variants
  Input input;
};

/// Reads and checks a .prm or .json file. A mistake in it throws InputError, one line with file, line and entry.
/// folder: what relative paths in it are relative to; its own folder if empty. settings: Section/Entry = value each, in
/// place of what the file says.
Input read_input(const std::filesystem::path& file, const std::filesystem::path& folder = {},
                 const std::vector<std::string>& settings = {});

/// How many grains genesis will pack.
double expected_grains(const SpecimenParameters& specimen);

/// One for each value of the variants' entry, or the input itself.
std::vector<Variant> variants(const Input& input);
} // namespace feldspar
