#pragma once

#include "calibration/parameters.h"
#include "coupling/network/boundary.h"
#include "coupling/rve/parameters.h"
#include "coupling/sample/continua/parameters.h"
#include "coupling/sample/sample_parameters.h"
#include "dem/dynamics/parameters.h"
#include "dem/flaws/clumps.h"
#include "dem/flaws/mineral_grains.h"
#include "dem/flaws/shapes.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/laws/joint_laws.h"
#include "dem/minerals/parameters.h"
#include "dem/specimen/parameters.h"
#include "laboratory/kinds.h"
#include "laboratory/parameters.h"
#include "results/variant_setting.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
class GivenEntries;

/// The pair of grains of `feldspar contact`.
struct ContactParameters
{
  double radius_1 = 1e-3; ///< [m]
  double radius_2 = 1e-3; ///< [m]
  std::string path_file;  ///< CSV of the displacements
};

/// Method by which an RVE follows its path.
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
  double cell_angle = 0.0;                      ///< by which the cell is turned before its path begins [rad]
  PathSolver solver = PathSolver::event_by_event;
  unsigned int steps_per_millistrain = 100000; ///< of explicit dynamics
};

/// Entries that take several values in one run.
struct VariantParameters
{
  std::vector<std::string> entries;             ///< Section/Entry; none: no variants
  std::vector<std::vector<std::string>> values; ///< of each entry, as they would stand in an input file
  bool in_step =
    false;           ///< the first values of all entries, then the second, ...; else each value with each of the others
  std::string table; ///< a CSV file that has them instead: a column an entry, a row a variant; empty: none
  std::vector<std::string> labels; ///< of the rows of a table, where it has a column of them
  bool named_by_number = false;    ///< in files, as those of runs that were begun before names had values
};

/// Texts of the user for the head of a report; empty where there are none.
struct ReportLabels
{
  std::string title;
  std::string client;
  std::string specimen;
  std::string author;
  std::string date; ///< as it was written: no clock
};

/// The choice whether all processes of a run compute a body together; else each makes tests of its own.
enum class SharedBody
{
  by_size, ///< a large one
  always,
  never
};

/// All that an input file says. A default-constructed value is what an empty file means.
struct Input
{
  std::filesystem::path folder; ///< relative paths of the input are relative to this

  /// A file that the input names. The way to it may lead through a folder that has been renamed since: ../rock.json of a run
  /// that is resumed needs only the folder above.
  std::filesystem::path file_named(std::string_view name) const;

  SpecimenParameters specimen;
  MineralParameters minerals;
  FlawParameters flaws;
  JointLaws::AllParameters joints; ///< of each joint law, from the section of its name
  ParticleContactParameters particle_contact;
  SmoothJointParameters smooth_joint;
  MineralGrainParameters mineral_grains;
  ClumpParameters clumps;
  DynamicsParameters dynamics;
  std::vector<TestKind> test_list{direct_tension.kind, uniaxial_compression.kind};
  TestParameters tests;
  std::vector<double> confinements{5e6, 10e6, 20e6, 30e6, 40e6, 50e6, 60e6}; ///< of tests that take one [Pa]
  std::uint64_t steps_between_checkpoints = 20000;
  SharedBody shared_body = SharedBody::by_size;
  std::vector<std::uint64_t> seeds{1};
  VariantParameters variants;
  std::vector<std::string> settled_by_file; ///< entries that are given beside a specimen file, which settles them
  ContactParameters contact;
  StrainPathParameters strain_path;
  EquilibriumParameters equilibrium;
  Boundary boundary; ///< of representative volumes
  SampleParameters sample;
  VariantParameters rocks; ///< of the groups of cells that sample.rocks_file names
  ContinuumParameters continuum;
  CalibrationParameters calibration;
  ReportLabels report_labels;
  std::string reference_file;    ///< figures of the rock that results are set beside; empty: none
  std::string reference_results; ///< summary.json of tests on another body of the same rock; empty: none
};

/// The same input but for some entries.
struct Variant
{
  std::string label; ///< Section/Entry = value, for each entry; empty where there are no variants
  Input input;
  std::vector<VariantSetting> settings = {}; ///< what differs, entry by entry
  std::string name_in_files = {};            ///< tells it from the others; empty where there are no others
};

/// Reads and checks a .prm or .json file. A mistake in it throws InputError, one line with file, line and entry.
/// folder: what relative paths in it are relative to; its own folder if empty. settings: Section/Entry = value each, in
/// place of what the file says.
Input read_input(const std::filesystem::path& file, const std::filesystem::path& folder = {},
                 const std::vector<std::string>& settings = {});
/// The same of entries that were read already.
Input read_input(const GivenEntries& values, const std::filesystem::path& folder);

/// Number of grains that genesis will pack.
double expected_grains(const SpecimenParameters& specimen);

/// One for each combination of the values of the variants' entries, or the input itself. Throws InputError.
std::vector<Variant> variants(const Input& input);

/// The rocks of a sample: the input itself, then that of each group of cells, whose name is its label. Throws InputError.
std::vector<Variant> rocks_of_sample(const Input& input);

/// Fills entries and values from the table, and labels from a column that it must have where it is named. Throws InputError.
void read_variant_table(VariantParameters& wanted, std::string_view column_of_labels = {});
} // namespace feldspar
