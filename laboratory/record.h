#pragma once

#include "laboratory/curve.h"
#include "laboratory/kinds.h"
#include "laboratory/peak.h"
#include "laboratory/specimen_report.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// The measurement of a laboratory test: plain data, SI, tension positive. Points have dim entries used, the rest 0.
/// The looks and the effort of a test are elsewhere: laboratory/test_outcome.h.
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
  double size;                  ///< length of the segment in 2D, root of its area in 3D [m]
  double released_energy;       ///< [J]
  bool on_smooth_joint = false; ///< of a flaw or at the boundary of a mineral grain
  std::uint64_t event = 0;      ///< number of the event of acoustic emission; 0: none
  std::uint32_t mineral_1 = 0;  ///< number of the mineral on its one side, from 1; 0: of a rock without minerals
  std::uint32_t mineral_2 = 0;  ///< on the other side, not below mineral_1
  bool on_boundary = false;     ///< between two mineral grains
};

/// An event of acoustic emission: breaks of segments near each other in place and time; on finite elements those of one
/// representative volume in one step.
struct EmissionEvent
{
  std::uint64_t number = 0;         ///< from 1, in the order of the first breaks
  std::uint64_t step = 0;           ///< of the first break
  double time = 0.0;                ///< of the first break, since the strain was zero [s]; NaN where there is no time
  double axial_strain = 0.0;        ///< of the specimen at the first break
  std::uint64_t n_tension = 0;      ///< breaks in tension
  std::uint64_t n_shear = 0;        ///< breaks in shear
  double released_energy = 0.0;     ///< by the breaks [J]
  std::array<double, 3> centroid{}; ///< mean of the places of the breaks [m]
  double extent = 0.0;              ///< largest distance of a break from the centroid [m]
  /// Moment tensor when its scalar moment was largest: xx, xy, xz, yy, yz, zz [N m].
  std::array<double, 6> moment{};

  std::uint64_t n_breaks() const { return n_tension + n_shear; }
};

/// The pieces that the joints still hold together at the end.
struct Fragments
{
  std::uint64_t n;      ///< of two grains or more
  double largest_share; ///< of the grains' volume
};

/// Factors by which a test with a notch gives the toughness of the rock.
struct NotchGeometry
{
  double intensity_over_stress; ///< K_I at the notch over the measured stress [√m]
  double work_over_stress;      ///< work of the load over ∫ stress d(strain) of the curve [m³]
  double ligament_area;         ///< ahead of the notch, or on both sides of a crack [m²]
  double ligament_length;       ///< from the notch to the side of the body [m]
  bool is_valid;                ///< within the range in which the formula is that of its source
};

/// A stage of a test that follows a table, as it went.
struct StageRecord
{
  std::string target;          ///< in words
  double confining_pressure;   ///< wanted at its end, compression positive [Pa]
  std::uint64_t first_row = 0; ///< of the curve
  std::uint64_t last_row = 0;  ///< of the curve
  bool reached = false;        ///< its target
};

/// A laboratory test as it was measured, and how it was made.
struct TestRecord
{
  TestKind kind;
  TestBody body = TestBody::grains;
  double confining_pressure = 0.0; ///< compression positive [Pa]
  /// σ_2, compression positive, where it is held at another value than the confining pressure [Pa].
  std::optional<double> intermediate_stress = std::nullopt;
  bool has_servo = false; ///< which holds it; else it is applied as it is
  /// Growth of the confining pressure per opening of the sheared plane, where it grows [Pa/m].
  std::optional<double> normal_stiffness = std::nullopt;
  std::uint64_t seed = 0;
  double strain_rate = 0.0;                                      ///< magnitude; NaN where there is no time [1/s]
  double stress_rate = std::numeric_limits<double>::quiet_NaN(); ///< under load control [Pa/s]
  double rate_over_laboratory = std::numeric_limits<double>::quiet_NaN(); ///< where that of a laboratory was wanted
  std::array<double, 3> size{}; ///< width, (depth,) height of the specimen [m]; the last is 0 in the plane
  SpecimenReport specimen;
  std::vector<CurveSample> curve;
  std::vector<Crack> cracks;
  std::vector<EmissionEvent> events;  ///< of acoustic emission; none of a material without grains
  std::optional<Fragments> fragments; ///< none without grains
  double bulk_density = 0.0;          ///< [kg/m³]
  PeakDemands peak_demands = {};      ///< on its highest stress
  /// Distance by which the walls were brought to the grains before the test began; that of the farthest wall [m].
  double way_to_grains = 0.0;
  std::vector<StageRecord> stages; ///< that were begun, of a test that follows a table
  /// The notch of a bending test; none without.
  std::optional<NotchGeometry> notch;
  bool interrupted = false;
  std::string failure;                ///< why the test could not be made; empty if it could
  std::string ended_early;            ///< why it could not go on to where the stop rule would end it; empty if it did
  bool came_apart = false;            ///< it ended early because beyond its last row nothing held it
  std::vector<MineralShare> minerals; ///< of a rock whose minerals are told apart

  EnvelopeRole envelope_role() const { return feldspar::envelope_role(kind, intermediate_stress); }
  int dimension() const { return size[2] > 0.0 ? 3 : 2; }
};
} // namespace feldspar
