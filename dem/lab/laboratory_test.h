#pragma once

#include "dem/dynamics/dynamics.h"
#include "dem/lab/parameters.h"
#include "dem/lab/stop_rule.h"
#include "dem/lab/strain_gauge.h"
#include "results/record.h"

#include <filesystem>
#include <functional>
#include <string>

namespace feldspar
{
/// Stresses at the ends of a specimen [Pa], tension positive.
struct EndStress
{
  double lower;
  double upper;
};

/// What tells one laboratory test from another once its walls or grips stand; it keeps no state of its own.
template <int dim>
struct Protocol
{
  double strain_rate = 0.0;                  ///< along the last axis, tension positive [1/s]
  double sampling_strain = 0.0;              ///< between two rows of the curve
  std::function<void(Dynamics<dim>&)> seat;  ///< brings the specimen to where the strain is zero; may be empty
  std::function<void(Dynamics<dim>&)> drive; ///< before each step after that; may be empty
  std::function<EndStress(const Dynamics<dim>&)> end_stress;
  std::function<double(const Dynamics<dim>&)> servo_stress; ///< on the sides [Pa]; empty where no servo holds it
};

/// A specimen between walls or grips, ready to be loaded.
template <int dim>
struct SetUpTest
{
  Dynamics<dim> dynamics;
  Protocol<dim> protocol;
};

/// Two platens, each at half the strain rate times the height; no side walls. docs/theory.md §4.1.
template <int dim>
SetUpTest<dim> set_up_uniaxial_compression(const Specimen<dim>& specimen, const TestParameters& wanted,
                                           const DynamicsParameters& dynamics);

/// Two rigid grips, each at half the strain rate times the free length between them. docs/theory.md §4.2.
template <int dim>
SetUpTest<dim> set_up_direct_tension(const Specimen<dim>& specimen, const TestParameters& wanted,
                                     const DynamicsParameters& dynamics);

/// Side walls that hold the pressure, platens as in uniaxial compression. docs/theory.md §4.3.
template <int dim>
SetUpTest<dim> set_up_triaxial_compression(const Specimen<dim>& specimen, double confining_pressure,
                                           const TestParameters& wanted, const DynamicsParameters& dynamics);

/// A disc cut out of the specimen, pressed together by pads of its own grains. docs/theory.md §4.4.
template <int dim>
SetUpTest<dim> set_up_brazilian(const Specimen<dim>& specimen, const TestParameters& wanted,
                                const DynamicsParameters& dynamics);

/// A laboratory test that can be left and taken up again: run row by row of its curve.
template <int dim>
class LabTest
{
public:
  LabTest(const TestCase& test, const Specimen<dim>& specimen, const TestParameters& wanted,
          const DynamicsParameters& dynamics);

  /// Seats the specimen at the first call, then loads it to the next row of the curve. False once the stop rule has
  /// ended the test. Throws InputError where the confinement cannot be reached.
  bool advance();

  bool has_ended() const { return ended; }
  std::uint64_t n_steps() const { return set_up.dynamics.n_steps(); }
  const CurveSample& last_row() const { return record.curve.back(); }

  /// The test as it stands, whether it has ended or not.
  TestRecord finish(bool interrupted) const;

  /// The whole state, so that a test read back runs on to the same bits. `identity` tells whose state it is.
  void write_checkpoint(const std::filesystem::path& file, const std::string& identity);
  /// Throws InputError where the file is missing, torn, foreign or of another identity; the test is then unusable.
  void read_checkpoint(const std::filesystem::path& file, const std::string& identity);

private:
  template <typename Archive>
  void transfer(Archive& archive);
  double lateral_stress() const;
  CurveSample sample() const;
  void take_snapshot();
  void start_gauge();

  TestParameters wanted;
  StopRule stop_rule;
  SetUpTest<dim> set_up;
  TestRecord record;
  StrainGauge<dim> gauge;
  bool seated = false;
  bool ended = false;
  Components<dim> gauge_positions; ///< of all grains when the gauge was set
  double time_at_start = 0.0;      ///< of the loading, after seating [s]
  std::uint64_t n_tension = 0;
  std::uint64_t n_shear = 0;
  std::vector<std::uint32_t> n_broken_segments; ///< of each grain's joints
  std::uint64_t rows_between_snapshots = 1;
};
} // namespace feldspar
