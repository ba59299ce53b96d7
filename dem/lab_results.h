#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What a laboratory test leaves behind: plain data, SI, tension positive. Points have dim entries used, the rest 0.
namespace feldspar
{
enum class TestKind
{
  direct_tension,
  uniaxial_compression,
  triaxial_compression,
  brazilian
};

/// The name used in input and result files.
std::string name(TestKind kind);

/// What a test is made on.
enum class TestBody
{
  grains,         ///< a specimen that moves in time
  finite_elements ///< a sample in equilibrium at every row; no time, and no grain has a place of its own
};

/// The name used in result files.
std::string name(TestBody body);

/// A test of the programme.
struct TestCase
{
  TestKind kind;
  double confining_pressure = 0.0; ///< of a triaxial test, compression positive [Pa]
};

/// The name used in result files: the kind, and of a triaxial test the pressure.
std::string name(const TestCase& test);

/// Each kind, and each triaxial test under each of the pressures [Pa], in this order.
std::vector<TestCase> test_cases(const std::vector<TestKind>& kinds, const std::vector<double>& confinements);

/// +1 where the test pulls, -1 where it presses: turns tension-positive figures into those of the laboratory curve.
double laboratory_sign(TestKind kind);

/// Follows a curve to its peak, row by row; stresses positive in the sense of the test.
struct PeakWatch
{
  explicit PeakWatch(const TestKind of_kind)
    : kind(of_kind)
  {
  }

  /// Whether this stress is the highest so far. In a Brazilian test nothing is after the first fall of 5 %.
  bool is_highest(double stress);

  TestKind kind;
  double highest = 0.0;
  bool fallen = false;
};

/// Energies since the start of the test, kinetic energy as it is [J]; each integrated on its own, none is the remainder
/// of the others. NaN where they are not known.
struct Energies
{
  double boundary_work = 0.0;
  double kinetic = 0.0;
  double strain = 0.0;
  double slip = 0.0;
  double released = 0.0; ///< by breaking segments
  double damping = 0.0;
  double kinetic_at_start = 0.0; ///< of the motion that the grains were set off with

  /// Boundary work and the energy at the start less all they went into [J].
  double unaccounted() const;
  /// |unaccounted| over the sum of all terms.
  double imbalance() const;
  /// |unaccounted| over the boundary work.
  double imbalance_over_work() const;
};

enum class CrackKind
{
  tension,
  shear
};

/// One broken segment.
struct Crack
{
  CrackKind kind;
  std::uint64_t joint;
  std::uint32_t segment;
  std::uint64_t step;
  double axial_strain;              ///< of the specimen, platen or grip travel
  std::array<double, 3> centroid{}; ///< [m]
  std::array<double, 3> normal{};
  double size;            ///< length of the segment in 2D, root of its area in 3D [m]
  double released_energy; ///< [J]
};

/// One row of the curve.
struct CurveSample
{
  std::uint64_t step = 0;
  double time = 0.0;                  ///< [s]
  double axial_strain = 0.0;          ///< platen or grip travel over the length between them
  double axial_stress = 0.0;          ///< mean of both ends over the area; Brazilian: -2P/(πDt) [Pa]
  double end_stress_difference = 0.0; ///< between both ends [Pa]
  double lateral_stress = 0.0;        ///< of the side walls, mean since the row before; 0 without [Pa]
  double mid_stress = 0.0;            ///< carried across the middle of the specimen [Pa]
  double gauge_axial_strain = 0.0;    ///< of the grains in the middle
  double gauge_lateral_strain = 0.0;
  double gauge_volumetric_strain = 0.0;
  std::uint64_t n_tension_cracks = 0;
  std::uint64_t n_shear_cracks = 0;
  double unbalanced_force_ratio = 0.0; ///< mean unbalanced over mean contact force
  Energies energies;
};

/// A grain as the pictures need it.
struct GrainPicture
{
  std::array<double, 3> start;    ///< when the loading began [m]
  std::array<double, 3> position; ///< at the end [m]
  double radius;                  ///< [m]
  std::uint32_t fragment;         ///< number of the fragment it belongs to, largest first
};

/// The grains at one row of the curve.
struct Snapshot
{
  std::uint64_t step = 0;
  double axial_strain = 0.0;
  double axial_stress = 0.0;                    ///< [Pa]
  std::array<std::vector<double>, 3> position;  ///< of each grain [m]; the last is empty in the plane
  std::vector<std::uint32_t> fragment;          ///< of each grain, as in GrainPicture
  std::vector<std::uint32_t> n_broken_segments; ///< of each grain's joints since the start
};

/// How the specimen came out.
struct SpecimenReport
{
  std::uint64_t n_grains = 0;
  std::uint64_t n_joints = 0;
  double coordination_number = 0.0;
  double coordination_number_core = 0.0; ///< of grains more than three mean diameters from the walls; NaN if none
  double installation_gap_ratio = 0.0;   ///< over the mean radius
  double porosity = 0.0;
  double mean_overlap_ratio = 0.0; ///< of overlapping pairs, over the mean radius
  double largest_overlap_ratio = 0.0;
  double resolution = 0.0;        ///< width over mean diameter
  double radius_multiplier = 1.0; ///< by which genesis scaled the drawn radii
  double packing_stress = 0.0;    ///< reached by genesis, compression positive [Pa]
  double mean_radius = 0.0;       ///< [m]
};

/// What it took to find the equilibria of a sample of finite elements, steps that were given up included.
struct SolverWork
{
  std::uint64_t n_solves = 0;
  std::uint64_t n_iterations = 0; ///< of Newton's method
  std::uint64_t n_cascades = 0;   ///< times that something broke and equilibrium was sought anew
  double seconds_in_points = 0.0; ///< of one core
};

/// How evenly the processes (ranks) of a test were at work in the volumes of its points; one is as long as the mean.
struct RankBalance
{
  double mean = 0.0;            ///< of one rank on one core, up to the last step [s]
  double longest = 0.0;         ///< sum over the rounds in which all wait for the longest [s]
  double longest_unmoved = 0.0; ///< the same had no point moved to another rank
  unsigned int n_moves = 0;     ///< times that points were dealt out anew
};

/// A laboratory test as it ran.
struct TestRecord
{
  TestKind kind;
  TestBody body = TestBody::grains;
  double confining_pressure = 0.0; ///< compression positive [Pa]
  bool has_servo = false;          ///< which holds it; else it is applied as it is
  std::uint64_t seed = 0;
  double strain_rate = 0.0;     ///< magnitude; NaN where there is no time [1/s]
  std::array<double, 3> size{}; ///< width, (depth,) height of the specimen [m]; the last is 0 in the plane
  SpecimenReport specimen;
  std::vector<CurveSample> curve;
  std::vector<Crack> cracks;
  std::vector<GrainPicture> grains_at_end;
  std::vector<Snapshot> snapshots; ///< a few, evenly over the curve; the first is the start
  std::uint64_t steps = 0;
  double time_step = 0.0;    ///< the last one; NaN where there is no time [s]
  double bulk_density = 0.0; ///< [kg/m³]
  double wall_time = 0.0;    ///< [s]
  RankBalance ranks;
  bool interrupted = false;
  std::string failure;     ///< why the test could not be made; empty if it could
  std::string ended_early; ///< why it could not go on to where the stop rule would end it; empty if it did
  bool came_apart = false; ///< it ended early because beyond its last row nothing held it
  std::optional<SolverWork> solver_work;

  int dimension() const { return size[2] > 0.0 ? 3 : 2; }
};

/// A figure, or the reason why it could not be had.
struct Figure
{
  std::optional<double> value;
  std::string reason;
};

/// The results of a test; stresses and strains positive in the sense of the test.
struct TestResults
{
  Figure peak_stress;
  Figure strain_at_peak;
  Figure youngs_modulus_initial; ///< by the gauge, 5–20 % of the peak
  Figure youngs_modulus_tangent; ///< 40–60 % of the peak
  Figure youngs_modulus_secant;  ///< to 50 % of the peak
  Figure poissons_ratio_initial;
  Figure poissons_ratio_secant;
  Figure crack_initiation_stress;         ///< by the count of cracks
  Figure crack_initiation_stress_lateral; ///< by the lateral strain, as curves of the laboratory are read
  Figure crack_damage_stress;
  Figure post_peak_drop;          ///< peak minus last stress, over peak
  Figure residual_deviator_ratio; ///< deviator at the end over that at the peak
  std::uint64_t n_tension_cracks = 0;
  std::uint64_t n_shear_cracks = 0;
  Figure n_tension_cracks_at_peak;
  Figure n_shear_cracks_at_peak;
  Figure shear_share_at_peak; ///< of all cracks
  double energy_imbalance = 0.0;
  double energy_imbalance_over_work = 0.0;
  Figure kinetic_to_strain_energy; ///< largest from 5 % of the peak to the peak
  Figure end_stress_difference;    ///< largest share of the peak deviator, from 5 % of the peak to the peak
  Figure unbalanced_force_ratio;   ///< mean from 5 % of the peak to the peak
  Figure p_wave_transits_to_peak;
  Figure servo_error;            ///< mean |lateral stress / pressure - 1| from seating to the peak
  Figure servo_error_largest;    ///< largest of the same
  Figure n_fragments;            ///< of two grains or more, at the end
  Figure largest_fragment_share; ///< of the grains' volume
};

/// The row of the curve where the stress was highest; none if it was rising to the end. Of a Brazilian test the first
/// maximum that was followed by a fall: the halves of a split disc may carry more than the whole one did.
std::optional<std::size_t> peak_row(const TestRecord& record);

/// The first row with 1 % of the cracks at the peak; none if there is no crack up to there.
std::optional<std::size_t> crack_initiation_row(const TestRecord& record, std::size_t peak);

/// Reads the results off the curve (docs/theory.md §5).
TestResults evaluate(const TestRecord& record);
} // namespace feldspar
