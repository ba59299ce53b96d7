#pragma once

#include "base/byte_archive.h"
#include "base/input_error.h"
#include "laboratory/compression.h"
#include "laboratory/loading_stages.h"
#include "laboratory/record.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// State of a test at one moment; compression positive.
struct StageMoment
{
  double time; ///< of the dynamics [s]
  double axial_strain;
  double axial_stress;         ///< mean of both ends [Pa]
  double lateral_strain = 0.0; ///< of the gauge, where a stage of the table prescribes it
};

/// The demand of a stage at one moment.
struct StageDemand
{
  double confining_pressure;                   ///< compression positive [Pa]
  double closing_rate;                         ///< of the platens over the height of the specimen [1/s]
  std::optional<double> held_stress;           ///< by the platens instead, compression positive [Pa]
  std::optional<double> missing_widening = {}; ///< strain that the platens are to bring about instead
};

/// Leads a test through the stages of its loading table, one after another; docs/theory.md §4.11.
class StageWalk
{
public:
  explicit StageWalk(const TestParameters& parameters)
    : wanted(parameters)
    , stages(parameters.of<LoadingTable>().stages)
    , pressure_before(parameters.of<LoadingTable>().pressure_at_start)
    , axial_strain_rate(parameters.of<CompressionParameters>().strain_rate)
  {
  }

  /// Sets off at the first row of the curve.
  void begin(const StageMoment& now);

  void append(const LoadingStage& one) { stages.push_back(one); }
  /// Leaves the present stage where it stands, at this row, and begins the last one.
  void begin_last(std::uint64_t row, const StageMoment& now);

  /// Demand of the present stage; to be called before each step.
  StageDemand demand(const StageMoment& now);
  bool is_at_end_of_stage(const StageMoment& now) const;
  /// Returns whether the lateral strain controls a stage of the table: moments must then have it.
  bool needs_lateral_strain() const;
  bool is_led_by_lateral_strain() const { return stage().lateral_strain.has_value(); }
  /// The magnitude of the strain rate of the present stage [1/s].
  double strain_rate() const { return rate_of(stage()); }
  /// The stage that runs, and where the test stood when it began.
  const LoadingStage& stage() const { return stages[begun.size() - 1]; }
  const StageMoment& start_of_stage() const { return start; }

  /// Called once a row has been added to the curve: ends the stage where it has reached its target or never will, and
  /// begins the next. Returns whether that was the last one.
  bool is_over(const std::vector<CurveSample>& curve, const StageMoment& now);

  const std::vector<StageRecord>& records() const { return begun; }
  /// Message on the stage that could not be reached, and why; empty if all were.
  const std::string& ended_early() const { return early; }

  /// Into or out of a checkpoint. Throws InputError where that is of another table.
  template <typename Archive>
  void transfer(Archive& archive)
  {
    const std::string own_table = table();
    std::string of_archive = own_table;
    archive.text("loading_table", of_archive);
    if (of_archive != own_table)
      throw InputError("of another loading table");
    archive.value("stage_time", start.time);
    archive.value("stage_strain", start.axial_strain);
    archive.value("stage_stress", start.axial_stress);
    archive.value("stage_lateral_strain", start.lateral_strain);
    bool left_before = pressure_before.has_value(); // the one before was left where it stood
    transfer_flag(archive, "stage_begins_at_pressure", left_before);
    double pressure = pressure_before.value_or(0.0);
    archive.value("stage_pressure_before", pressure);
    pressure_before = left_before ? std::optional(pressure) : std::nullopt;
    archive.value("stage_widening_let_be", widening_let_be);
    archive.value("stage_highest_stress", highest_stress);
    archive.value("stage_strain_at_highest", strain_at_highest);
    std::uint64_t n_begun = begun.size();
    archive.value("n_stages_begun", n_begun);
    if (n_begun > stages.size())
      throw InputError("of more stages than its loading table has");
    begun.resize(n_begun);
    for (std::size_t k = 0; k < n_begun; ++k)
      {
        StageRecord& one = begun[k];
        const std::string name = fmt::format("stage_{}_", k);
        archive.text(name + "target", one.target);
        archive.value(name + "confining_pressure", one.confining_pressure);
        archive.value(name + "first_row", one.first_row);
        archive.value(name + "last_row", one.last_row);
        transfer_flag(archive, name + "reached", one.reached);
      }
    archive.text("stages_ended_early", early);
  }

private:
  double rate_of(const LoadingStage& one) const { return one.strain_rate.value_or(axial_strain_rate); }
  std::string table() const;
  void begin_next(std::uint64_t row, const StageMoment& now);

  TestParameters wanted;
  std::vector<LoadingStage> stages;
  /// Confining pressure when the present stage began; none: that at the end of the one before, or of itself [Pa].
  std::optional<double> pressure_before;
  double axial_strain_rate;       ///< of a stage that names none [1/s]
  std::vector<StageRecord> begun; ///< the last one runs
  std::string early;
  StageMoment start{};         ///< of the stage that runs
  double highest_stress = 0.0; ///< of its rows so far [Pa]
  double strain_at_highest = 0.0;
  double widening_let_be = 0.0; ///< of a stage that prescribes the lateral strain, beyond what its rate has come to
};
} // namespace feldspar
