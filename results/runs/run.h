#pragma once

#include "laboratory/named_entries.h"
#include "laboratory/test_outcome.h"
#include "results/evaluation.h"
#include "results/variant_setting.h"

#include <string>
#include <vector>

namespace feldspar
{
/// An entry of the input as it was understood, defaults included.
struct InputEntry
{
  std::string section;
  std::string entry;
  std::string value; ///< with its unit
};

/// The origin of results, saved with them.
struct Provenance
{
  std::string version;
  std::string commit;
  std::string input_file;
  std::vector<InputEntry> input;
  std::string processor;
  unsigned int n_processes = 1;
  unsigned int n_threads = 1; ///< of each

  /// Value of an entry with its unit; empty where the input is not known or has no such entry.
  std::string value_of(const input_entries::EntryName& wanted) const;
  /// Text of the user for the head of a report; empty where there is none.
  std::string label_of(const input_entries::EntryName& wanted) const;
};

/// A finished test with its results.
struct FinishedTest
{
  std::string group;                    ///< what it is averaged with over the seeds: triaxial_compression_5_MPa
  std::string name;                     ///< of its files and figures: triaxial_compression_5_MPa_seed_1
  std::string variant;                  ///< Section/Entry = value for each entry; empty where there are none
  std::vector<VariantSetting> settings; ///< the same, entry by entry
  TestRecord record;                    ///< the measurement
  TestResults results;                  ///< read off the record
  TestAppearance appearance;
  RunBookkeeping bookkeeping;

  /// Returns whether the test ran to its end.
  bool was_made() const { return record.failure.empty() && !record.interrupted; }
  /// Returns whether the figures of the test may be averaged with those of others: it ran to its end and is a valid
  /// test of its kind.
  bool counts() const { return was_made() && results.is_valid(); }
  /// Returns whether the body has holes, slots or joints: its highest stress is then nominal, load over the whole
  /// section, and not a strength of the rock.
  bool has_flaws() const { return !appearance.flaws.empty(); }
};

bool any_has_flaws(const std::vector<FinishedTest>& tests);

/// A finished test, with the figures read off its record.
FinishedTest finished(TestOutcome outcome, std::string group, std::string name, std::string variant,
                      std::vector<VariantSetting> settings = {});

/// The value of a quantity in a test. A test that could not be made has none but its loading: numbers in a record of it were
/// not measured.
Figure value_of(const TestQuantity& quantity, const FinishedTest& test);

/// Puts back what value_of() gave.
void set_value(const TestQuantity& quantity, FinishedTest& test, const Figure& figure);
} // namespace feldspar
