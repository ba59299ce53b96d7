#pragma once

#include "results/fits/run_envelopes.h"
#include "results/runs/series.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// Files of a result folder that more than one place names.
namespace result_file
{
inline constexpr const char* summary = "summary.json";
inline constexpr const char* curves = "curves";
inline constexpr const char* cracks = "cracks.csv";
inline constexpr const char* emission = "emission.csv";
inline constexpr const char* minerals = "minerals.csv";
inline constexpr const char* tests = "tests.csv";
inline constexpr const char* steps = "steps.csv";
inline constexpr const char* grains = "grains";
inline constexpr const char* fields = "fields";
inline constexpr const char* points = "points";
inline constexpr const char* reference = "reference.json";
inline constexpr const char* figures = "figures";
inline constexpr const char* tables = "tables";
inline constexpr const char* page = "report.html";
inline constexpr const char* film = "film.webp";
inline constexpr const char* quakeml = "quakeml";
} // namespace result_file

/// A test as an element of `tests` in summary.json.
std::string test_as_json(const FinishedTest& test);

/// Envelopes as `fits` in summary.json.
std::string envelopes_as_text(const StrengthEnvelopes& envelopes);

/// Writes summary.json: provenance, every test's figures in SI units, means over seeds, and the envelopes of a run
/// without variants. A figure that could not be had is null, with the reason in a field of the same name and `_reason`.
void write_summary(const Provenance& provenance, const std::vector<FinishedTest>& tests, const RunEnvelopes& envelopes,
                   const std::filesystem::path& file);

/// Writes what a later report needs: summary.json, tests.csv, curves/, cracks.csv, emission.csv, steps.csv of samples, grains/,
/// points/. The fields of finite elements, fields/, are there already.
void write_result_folder(const Provenance& made_by, const std::vector<FinishedTest>& tests,
                         const RunEnvelopes& envelopes, const std::filesystem::path& folder);

/// Reads it back: one series, or one for each variant. A table that is missing or cannot be read leaves its place empty
/// and becomes a problem of the series, as does a summary of another layout, as far as it can be read, and a test of
/// another kind than the given ones. Throws InputError where there is no summary.json at all or where nothing in it is
/// a test.
std::vector<Series> read_result_folder(const std::filesystem::path& folder, const std::vector<TestKind>& kinds);
} // namespace feldspar
