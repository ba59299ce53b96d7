#pragma once

#include "coupling/sample/sample_body.h"
#include "coupling/sample/sample_run.h"
#include "fem/solid/advance.h"
#include "laboratory/stage_walk.h"
#include "laboratory/stop_rule.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace feldspar
{
/// Target of a row of a test that follows stages.
struct StageRow : SampleTarget
{
  double time = 0.0; ///< at its end, by the rates of the stages [s]
};

/// A multiscale test on its way: what it consists of, and its steps.
struct SampleTest::Parts
{
  TestCase test;
  SampleParameters sample;
  TestParameters wanted;
  SampleStanding standing;
  std::function<void(const SampleStanding&)> watch;
  std::function<bool()> gives_up;
  std::unique_ptr<SampleBody> body;
  SampleSize size{};
  std::optional<fem::FieldOutput> fields;
  StopRule stop_rule;
  std::optional<StageWalk> stage_walk; ///< of a test that follows stages
  StageRow stage_row;                  ///< the last one, or the one on its way
  TestRecord record;
  RunBookkeeping bookkeeping;
  std::function<void()> step_done;
  std::optional<fem::StepControl> steps; ///< to the next row, where it is on its way
  bool widens = false;                   ///< lateral strain is what is controlled
  double wanted_width = 0.0;             ///< lateral strain of the row that is on its way
  bool avalanche = false;                ///< the next of these steps may break as much as it likes
  unsigned int most_events_per_segment = 1;
  unsigned int n_cuts_for_breaks = 0; ///< of the step that is tried
  SolverStep step_on_its_way;         ///< what was given up for it
  bool seated = false;
  bool ended = false;
  double height_at_seating = 0.0; ///< displacement of the top [m]
  double lateral_strain_at_seating = 0.0;
  std::uint64_t n_tension = 0;
  std::uint64_t n_shear = 0;

  /// Throws InputError for a test that such a sample cannot make.
  Parts(const TestCase& which, const SampleParameters& of, const TestParameters& parameters);

  void take(std::unique_ptr<SampleBody> its_body, unsigned int events_per_segment);
  SampleSetUp set_up();

  /// Pressure all round, the top plate free to follow.
  void seat();
  /// Loads to the next row.
  void load();
  /// After a row.
  bool is_over();
  /// Goes in steps that break no more than their share. A step that still does, cut twice for that or the smallest, is
  /// an avalanche, which no step divides. It goes from where it was left, if it was.
  void go(const SampleTarget& target);
  void share_work();
  /// Keeps what an accepted step took.
  void note_step(const fem::NewtonReport& report);
  /// Called after each accepted step. Cracks of a point come in the order in which they broke, points in the order of
  /// their numbers.
  void gather_cracks();
  /// Adds the present state of the sample to the curve as a row.
  void add_row();

  /// The state that all ranks share besides the solid; in sample_checkpoint.cc.
  template <typename Archive>
  void transfer(Archive& archive, std::string& fields_written, fem::StoredSolid& solid);

  /// Pressure on the sides [Pa]; before the first row, that of the seating.
  double pressure_of_last_row() const { return stage_walk ? stage_row.confining_pressure : test.confining_pressure; }
  double axial_strain() const { return (body->top_displacement() - height_at_seating) / size.height; }
  fem::StepControl first_steps() const { return {1.0, sample.smallest_step_share, 1.0}; }

private:
  double sign() const { return test.kind.sign; }
  /// Returns whether the sample may widen: from the first avalanche or fall of the stress on.
  bool may_widen() const { return seated && sample.widened_past_peak && sign() < 0.0 && !stage_walk; }
  /// In stage_rows.cc.
  void load_by_stage();
  StageMoment stage_moment() const;
  StageRow next_row_of_stage();
};
} // namespace feldspar
