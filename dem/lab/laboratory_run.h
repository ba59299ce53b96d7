#pragma once

#include "dem/dynamics/dynamics.h"
#include "dem/lab/emission.h"
#include "dem/lab/laboratory_protocol.h"
#include "dem/lab/mineral_gauge.h"
#include "dem/lab/strain_gauge.h"
#include "laboratory/energies.h"
#include "laboratory/parameters.h"
#include "laboratory/stage_walk.h"
#include "laboratory/stop_rule.h"
#include "laboratory/test_outcome.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Stresses at the ends of a specimen [Pa], tension positive.
struct EndStress
{
  double lower;
  double upper;
};

/// The way of a test since its strain was zero.
struct SinceStart
{
  double time;         ///< [s]
  double axial_strain; ///< tension positive
  double opening;      ///< of the platens, where Loading::opening measures it [m]
};

/// Loading and measurement of a specimen once its walls or grips stand; keeps no state of its own.
template <int dim>
struct Loading
{
  double strain_rate = 0.0;     ///< along the last axis, tension positive [1/s]
  double sampling_strain = 0.0; ///< between two rows of the curve
  /// Stress rate under load control [Pa/s], and the rate over that of a laboratory where one was wanted; else NaN.
  double stress_rate = std::numeric_limits<double>::quiet_NaN();
  double rate_over_laboratory = std::numeric_limits<double>::quiet_NaN();
  double way_to_grains = 0.0;                ///< by which the farthest wall was brought to the specimen [m]
  std::optional<double> intermediate_stress; ///< σ_2, where it is not the confining pressure [Pa]
  std::optional<NotchGeometry> notch;
  std::optional<double> normal_stiffness; ///< that presses back the opening [Pa/m]
  /// Brings the specimen to where the strain is zero, and calls check() at every step; may be empty.
  std::function<void(Dynamics<dim>&, const std::function<void()>& check)> seat;
  std::function<void(Dynamics<dim>&, const SinceStart&)> drive; ///< before each step after that; may be empty
  std::function<double(const Dynamics<dim>&)> opening;          ///< of the platens since the genesis [m]; may be empty
  /// Before each step, of a test that follows the stages of a loading table; else empty.
  std::function<void(Dynamics<dim>&, const StageDemand&)> drive_stage;
  /// Shortening of the specimen since its genesis, over its height; empty where the strain goes with time, at the strain rate.
  std::function<double(const Dynamics<dim>&)> shortening;
  std::function<EndStress(const Dynamics<dim>&)> end_stress;
  std::function<double(const Dynamics<dim>&)> servo_stress; ///< on the sides [Pa]; empty where no servo holds it
};

/// A specimen between walls or grips, ready to be loaded.
template <int dim>
struct SetUpTest
{
  Dynamics<dim> dynamics;
  Loading<dim> loading;
};

/// Acceleration of all grains of a test [m/s²].
template <int dim>
Vector<dim> gravity_of(const TestParameters& wanted)
{
  Vector<dim> acceleration = Vector<dim>::Zero();
  for (std::size_t c = 0; c < wanted.gravity.size(); ++c)
    acceleration[Eigen::Index(c)] = wanted.gravity[c];
  return acceleration;
}

/// A protocol under the pressure that it takes [Pa]; compression positive, 0 where it takes none.
struct LaboratoryCase
{
  const LaboratoryProtocol& protocol;
  double confining_pressure = 0.0;
};

/// Sees from row to row of a curve whether a body has more energy than it was given.
class EnergyWatch
{
public:
  /// Returns whether more has been stored and dissipated than twice what was put in, at the most there has been until
  /// now. The scheme itself leaves a thousandth of that open. Energies that are no numbers count as grown.
  bool has_grown_without_work(const Energies& now)
  {
    most_put_in = std::max(most_put_in, std::abs(now.boundary_work) + now.kinetic_at_start);
    constexpr double round_off = 4e-21; // of a body at rest: k_B T of a room [J]
    return !(-now.unaccounted() <= most_put_in + round_off);
  }

private:
  double most_put_in = 0.0; ///< [J]
};

/// A laboratory test that can be left and resumed: run row by row of its curve.
template <int dim>
class LabTest
{
public:
  LabTest(const LaboratoryCase& test, Specimen<dim> specimen, const TestParameters& wanted,
          const DynamicsParameters& dynamics);

  /// Before the first row: keeps the own part of the body, to run the test together with partners, which all have it as it stands,
  /// as Dynamics::share(). Throws InputError for a test that cannot be shared.
  void share(Partners& with) { set_up.dynamics.share(with); }
  void meet() { set_up.dynamics.meet(); }
  double unevenness() const { return set_up.dynamics.unevenness(); }

  /// Seats the specimen at the first call, then loads it to the next row of the curve. False once the test has ended: by
  /// the stop rule, after its last stage, or because numbers went wrong, which its record then says. Calls check() at
  /// every step, which may throw; a row that this broke off is gone on with at the next call, a seating cannot be. Throws
  /// InputError where the confinement cannot be reached, or a prescribed strain not be measured.
  bool advance(const std::function<void()>& check = [] {});

  /// Appends a stage to those of a test that follows stages. It begins where the test stands, before the first row with the
  /// others. Throws InputError where its lateral strain cannot be measured.
  void follow(const LoadingStage& stage);

  bool has_ended() const { return ended; }
  bool is_seated() const { return seated; }
  /// Returns whether the test has ended because of its numbers.
  bool went_wrong() const { return !record.failure.empty(); }
  std::uint64_t n_steps() const { return set_up.dynamics.n_steps(); }
  const std::vector<CurveSample>& curve() const { return record.curve; }

  /// The test as it stands, whether it has ended or not. A test whose numbers went wrong has all that was before the
  /// row in which they did.
  TestOutcome finish(const bool interrupted) const& { return outcome(interrupted, snapshots); }
  TestOutcome finish(const bool interrupted) && { return outcome(interrupted, std::move(snapshots)); }

  /// The whole state, so that a test read back runs on to the same bits. `identity` tells whose state it is. Of a shared test the
  /// first process writes that of all; throws OutputError on all.
  void write_checkpoint(const std::filesystem::path& file, const std::string& identity);
  /// Throws InputError where the file is missing, torn, foreign or of another identity; the test is then unusable. A shared test is
  /// divided anew; meet() before it goes on.
  void read_checkpoint(const std::filesystem::path& file, const std::string& identity);

private:
  template <typename Archive>
  void transfer(Archive& archive);
  double lateral_stress() const;
  /// The displacement gradient of the gauge since it was set.
  Tensor<dim> displacement_gradient() const;
  CurveSample sample() const;
  void seat(const std::function<void()>& check);
  void check_gauge() const;
  void load_to_next_row(const std::function<void()>& check);
  void step();
  void add_row();
  double axial_strain() const;
  StageMoment moment() const;
  TestOutcome outcome(bool interrupted, std::vector<Snapshot> shots) const;
  Snapshot snapshot() const;
  void take_snapshot();
  void start_gauge();

  TestParameters wanted;
  StopRule stop_rule;
  SetUpTest<dim> set_up;
  StageWalk stage_walk;
  TestRecord record;
  std::vector<Snapshot> snapshots;
  EnergyWatch energy_watch;
  EmissionWatch<dim> emission;
  double wall_time = 0.0;    ///< [s]
  std::vector<bool> is_part; ///< each grain, of the body, before anything broke
  StrainGauge<dim> gauge;
  MineralGauge<dim> mineral_gauge;
  bool seated = false;
  bool ended = false;
  Components<dim> gauge_positions;       ///< of all grains when the gauge was set
  double time_at_start = 0.0;            ///< of the loading, after seating [s]
  double time_of_last_row = 0.0;         ///< of the dynamics [s]
  double lateral_stress_over_time = 0.0; ///< since then [Pa s]
  std::uint64_t n_tension = 0;
  std::uint64_t n_shear = 0;
  std::vector<std::uint32_t> n_broken_segments; ///< of each grain's joints
  std::uint64_t rows_between_snapshots = 1;
  double shortening_at_start = 0.0; ///< where the loading measures it
  double opening_at_start = 0.0;    ///< the same [m]
};
} // namespace feldspar
