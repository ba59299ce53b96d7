#pragma once

#include "laboratory/specimen_report.h"
#include "results/runs/series.h"
#include "results/statistics.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The bodies of grains that a comparison sets side by side. Installation gap, coordination number away from walls and
/// porosity decide their strength as the parameters of the joints do; a coordination number over all grains does not tell
/// them apart, because walls take joints.
namespace feldspar
{
/// Means over the specimens, or the representative volumes, of a series.
struct BodyFigures
{
  std::string label;
  Statistics gap; ///< up to which grains are joined, over the mean radius
  std::optional<Statistics> coordination_number_core;
  Statistics porosity;
};

/// The specimen of each seed, whole: a test on a part of it, such as a disc, has fewer grains.
std::map<std::uint64_t, SpecimenReport> whole_bodies(const std::vector<FinishedTest>& tests);

/// Figures of bodies; none without grains.
std::optional<BodyFigures> body_figures(const std::string& label, const std::vector<SpecimenReport>& bodies);
/// One body a seed.
std::optional<BodyFigures> body_figures(const Series& series);

/// "direct: gap 0.0457 mean radii, coordination number 4.36 in the bulk, porosity 0.166".
std::string as_text(const BodyFigures& figures);

/// A sentence where the gaps of the two differ, so that they are two rocks; empty where they do not.
std::string gap_remark(const BodyFigures& one, const BodyFigures& other);

/// The remarks for each of the series after the first that has another gap than the first with grains.
std::vector<std::string> gap_remarks(const std::vector<Series>& all);
} // namespace feldspar
