#pragma once

#include "dem/specimen/specimen_report.h"
#include "results/curve.h"
#include "results/kinds.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What a laboratory test leaves behind: plain data, SI, tension positive. Points have dim entries used, the rest 0.
namespace feldspar
{
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
  /// σ_2, compression positive, where it is held at another value than the confining pressure [Pa].
  std::optional<double> intermediate_stress = std::nullopt;
  bool has_servo = false; ///< which holds it; else it is applied as it is
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

  EnvelopeRole envelope_role() const { return feldspar::envelope_role(kind, intermediate_stress); }
  int dimension() const { return size[2] > 0.0 ? 3 : 2; }
};
} // namespace feldspar
