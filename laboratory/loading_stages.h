#pragma once

#include "laboratory/own_entries.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// One row of a loading table: its target, and its rate. Compression positive, SI. docs/theory.md §4.11.
struct LoadingStage
{
  std::optional<double> axial_strain = {}; ///< at its end
  std::optional<double> axial_stress = {}; ///< at its end; of a hold: throughout [Pa]
  /// Lateral strain at its end, of the gauge since the seating; the platens bring the specimen there. A widening is
  /// negative.
  std::optional<double> lateral_strain = {};
  std::optional<double> duration = {};    ///< of a hold; none: it ends at its strain or stress [s]
  double confining_pressure = 0.0;        ///< at its end [Pa]
  std::optional<double> strain_rate = {}; ///< of the prescribed strain, magnitude; none: axial, of compression [1/s]
};

/// The table that a test follows.
struct LoadingTable
{
  std::string file;                 ///< CSV; empty: none
  std::vector<LoadingStage> stages; ///< read from it
  /// Confining pressure before the first stage; none: that at its end [Pa].
  std::optional<double> pressure_at_start = {};
};

/// The entries of LoadingTable.
std::vector<Entry<TestParameters>> loading_table_entries();

/// The stages of a loading table, row by row, in a CSV file. Throws InputError, one line with the file and the number of
/// the stage, for a stage that cannot be made.
std::vector<LoadingStage> read_loading_stages(const std::filesystem::path& file);

/// The reason why a stage cannot be made after the one before, null of the first; empty if it can.
std::string objection(const LoadingStage& stage, const LoadingStage* before);

/// Target of a stage in words: "axial strain 0.004", "hold of 1e-05 s".
std::string words(const LoadingStage& stage);

/// All its numbers, to the last bit: two stages of the same text are the same.
std::string full_text(const LoadingStage& stage);
} // namespace feldspar
