#pragma once

#include "results/runs/run.h"

#include <filesystem>
#include <string>
#include <vector>

/// The tables of a result folder: written after a run, read when a report is made of it. Readers know columns by their
/// names, so more columns or another order do not matter, and throw InputError, one line, for what they cannot read.
namespace feldspar
{
/// The rows of a table as it was read.
template <typename Row>
struct TableRows
{
  std::vector<Row> rows;
  std::string remark =
    {}; ///< on cells without a finite number, a sentence without its full stop; empty where there are none
};

/// The curve of a test, a row per sample. Stress and strain are positive in the sense of the test: tension in a tension
/// test, compression in a compression test. Rows without a finite strain or stress are kept: they are gaps of the curve.
void write_curve(const TestRecord& record, const std::filesystem::path& file);
TableRows<CurveSample> read_curve(const std::filesystem::path& file, const TestKind& kind);

/// The cracks of all tests, in the order in which they came.
void write_cracks(const std::vector<FinishedTest>& tests, const std::filesystem::path& file);
/// Puts each crack into the test of its name; those of other names, and rows without finite numbers, are left out. Returns
/// the remark on the latter.
std::string read_cracks(const std::filesystem::path& file, std::vector<FinishedTest>& tests);

/// The events of acoustic emission of all tests, with their mechanisms (results/emission.h); nothing where there is none.
void write_events(const std::vector<FinishedTest>& tests, const std::filesystem::path& file);
/// The mean stress and the strain of each mineral and the cracks in it at the snapshots of all tests; nothing of rocks without minerals.
void write_minerals(const std::vector<FinishedTest>& tests, const std::filesystem::path& file);
/// Reads them as read_cracks() does; mechanisms follow from the moments.
std::string read_events(const std::filesystem::path& file, std::vector<FinishedTest>& tests);

/// The steps of the samples of finite elements among the tests, a row a step; nothing where there is none. Counts and two
/// digits of residuals, so that the number of processes, which changes the order of sums, leaves the file as it is.
void write_steps(const std::vector<FinishedTest>& tests, const std::filesystem::path& file);

/// Name of the groups of a test's grains in files.
std::string group_name(const TestRecord& test);

/// The grains of a test, where they were and where they came to. `group`: the column of the numbers of the groups they are
/// parts of, `clump` or `mineral_grain`; both are read. Rows without finite numbers are left out.
void write_grains(const std::vector<GrainPicture>& grains, const std::filesystem::path& file,
                  const std::string& group = "mineral_grain");
TableRows<GrainPicture> read_grains(const std::filesystem::path& file);

/// All tests of a run as one table, for a data frame: a row a test; columns are its name, kind, seed, each entry that differs
/// between variants, and each result by its name in summary.json. A number has a cell of its own, its unit is in the name of
/// the column; what could not be had is empty. Throws OutputError.
void write_tests(const std::vector<FinishedTest>& tests, const std::filesystem::path& file);
} // namespace feldspar
