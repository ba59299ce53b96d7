#include "results/runs/remarks.h"

#include "laboratory/named_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace feldspar
{
namespace
{
/// Returns whether a test ended so near to its peak that a higher one may lie beyond. A table of stages defines its own
/// end, and a body that slides along a plane carries the same stress from its peak on.
bool ended_near_its_peak(const FinishedTest& test)
{
  constexpr double least_fall = 0.05; // of the deviator
  constexpr double least_way = 1.05;  // of the strain at the peak
  const TestRecord& record = test.record;
  const Figure& residual = test.results.residual_deviator_ratio;
  if (record.kind.follows_stages || record.kind.pressure_acts_across || record.came_apart || !residual.value ||
      record.curve.empty()) // its table may have been thrown away
    return false;
  return *residual.value > 1.0 - least_fall &&
         record.kind.strain(record.curve.back()) < least_way * *test.results.strain_at_peak.value;
}

/// The highest stress after the first fall of a test whose strength is the peak before it, over that strength; none where
/// it stayed below.
std::optional<double> rise_after_first_fall(const FinishedTest& test)
{
  const TestRecord& record = test.record;
  if (record.kind.peak_rule != PeakRule::first_before_a_fall || record.curve.empty())
    return std::nullopt;
  double highest = 0.0;
  for (const CurveSample& row : record.curve)
    highest = std::max(highest, record.kind.stress(row));
  const double ratio = highest / *test.results.peak_stress.value;
  return ratio > 1.0 ? std::optional(ratio) : std::nullopt;
}

/// A closed flaw that cuts a body from one side to the other, between its ends.
struct PlaneThrough
{
  std::string name;
  double angle; ///< from the platens [rad]
};

/// The steepest of them; none in a body that no such flaw cuts.
std::optional<PlaneThrough> plane_through(const FinishedTest& test)
{
  const TestRecord& record = test.record;
  const auto axis = std::size_t(record.dimension()) - 1;
  const double width = record.size[0];
  const double height = record.size[axis];
  const double grain = record.specimen.resolution > 0.0 ? width / record.specimen.resolution : 0.0;
  std::optional<PlaneThrough> steepest;
  for (const FlawPicture& flaw : test.appearance.flaws)
    {
      if (flaw.open || flaw.outline.size() < 2)
        continue;
      const auto [left, right] =
        std::ranges::minmax_element(flaw.outline, [](const auto& a, const auto& b) { return a[0] < b[0]; });
      const auto lies_within = [&](const auto& point) { return point[axis] > 0.0 && point[axis] < height; };
      if ((*left)[0] > grain || (*right)[0] < width - grain || !lies_within(*left) || !lies_within(*right))
        continue;
      const double angle = std::atan2(std::abs((*right)[axis] - (*left)[axis]), (*right)[0] - (*left)[0]);
      if (!steepest || angle > steepest->angle)
        steepest = PlaneThrough{flaw.name, angle};
    }
  return steepest;
}
} // namespace

std::string shortcoming(const FinishedTest& test)
{
  const TestRecord& record = test.record;
  if (!record.failure.empty())
    return fmt::format("{} could not be {}: {}.", test.name, record.curve.empty() ? "made" : "finished",
                       record.failure);
  if (!test.results.peak_stress.value)
    return fmt::format("{} has no strength: {}.", test.name, test.results.peak_stress.reason);
  if (!record.ended_early.empty())
    return fmt::format("{} ended early: {}.", test.name, record.ended_early);
  if (const auto rise = rise_after_first_fall(test))
    return fmt::format("{} bore {:.2f} times its strength after its first fall, by which the strength is taken.",
                       test.name, *rise);
  if (ended_near_its_peak(test))
    return fmt::format(
      "{} ended at {:.2f} times the strain of its peak and still bore {:.0f} % of the strength: a higher peak may lie "
      "beyond; a greater {} shows it.",
      test.name, record.kind.strain(record.curve.back()) / *test.results.strain_at_peak.value,
      100.0 * *test.results.residual_deviator_ratio.value, input_entries::stop_strain.text());
  if (record.kind.follows_stages && ends_rising(record))
    return fmt::format("{} was still being loaded when its table ended: its highest stress is no strength.", test.name);
  if (record.way_to_grains > 0.0)
    return fmt::format(
      "{}: no grain lay at the sides of the specimen's box; walls were brought to the grains by up to {:.3g} "
      "mm, and the area of the stress is that of the box.",
      test.name, 1e3 * record.way_to_grains);
  return "";
}

std::string remark_on_splitting(const FinishedTest& test)
{
  if (!test.results.is_valid() && test.results.peak_stress.value)
    return fmt::format(
      "{}, {:.2f} MPa, is not valid as a splitting test: {:.0f} % of its first cracks lie at the pads, where "
      "the disc is crushed, and a splitting crack begins in the middle (ISRM 1978, ASTM D3967). Its figures "
      "enter no mean, envelope or calibration. A larger disc or smaller grains help.",
      test.name, *test.results.peak_stress.value / 1e6, 100.0 * *test.results.first_cracks_at_pads_share.value);
  return "";
}

std::string remark_on_side_plates(const TestsOfRock& tests)
{
  constexpr double least_angle = 10.0 * std::numbers::pi / 180.0; // faces of rock with less friction are not known
  constexpr double least_factor = 1.02;                           // the accuracy of the formula
  for (const FinishedTest* const test : tests)
    {
      const bool has_plates = test->record.kind.takes_confining_pressure && test->results.servo_error.value &&
                              !test->record.kind.pressure_acts_across;
      const auto plane = has_plates ? plane_through(*test) : std::nullopt;
      if (!plane || plane->angle < least_angle)
        continue;
      const double height = test->record.size[std::size_t(test->record.dimension()) - 1];
      const double factor = height / (test->record.size[0] * std::tan(plane->angle));
      if (factor > least_factor)
        return fmt::format(
          "A {} crosses the body from side to side at {:.0f} deg to the platens. Rigid side plates hold each half by one "
          "plate alone: where the body slides on it, the deviator is that of {:.2f} times the confining pressure, {:.0f} % "
          "too high (docs/theory.md, section 3.1). {} = membrane has no such error, nor has a body as high as its width times "
          "tan {:.0f} deg.",
          plane->name, plane->angle * 180.0 / std::numbers::pi, factor, 100.0 * (factor - 1.0),
          input_entries::lateral_boundary.text(), plane->angle * 180.0 / std::numbers::pi);
    }
  return "";
}

std::string remark_on_flaws(const TestsOfRock& tests)
{
  const bool any = std::ranges::any_of(tests, [](const FinishedTest* test) { return test->has_flaws(); });
  return any
           ? "The body has flaws: its strengths are highest nominal stresses, load over the whole section, and hold for "
             "this body. They are no strengths of the rock, nor is their envelope."
           : "";
}

std::string remark_on_load_control(const TestsOfRock& tests)
{
  const auto lost = std::ranges::find_if(tests, [](const FinishedTest* const test) {
    return test->record.stress_rate > 0.0 && test->results.strain_at_peak.value;
  });
  return lost == tests.end()
           ? ""
           : fmt::format(
               "Under load control the strength is the load up to which the body follows the machine. Beyond it "
               "the strain runs away ({}: at a strain of {:.3g} %), and the curve does not describe the rock.",
               (*lost)->name, 100.0 * *(*lost)->results.strain_at_peak.value);
}

std::string remark_on_rate(const TestsOfRock& tests)
{
  const auto longest = std::ranges::max_element(tests, {}, [](const FinishedTest* const test) {
    const double steps = test->bookkeeping.steps_at_laboratory_rate;
    return std::isnan(steps) ? 0.0 : steps;
  });
  if (longest == tests.end() || !((*longest)->record.rate_over_laboratory > 1.0))
    return "";
  const TestRecord& record = (*longest)->record;
  const auto rate = [&](const double faster) {
    return std::isnan(record.stress_rate) ? fmt::format("{:.3g} 1/s", record.strain_rate / faster)
                                          : fmt::format("{:.3g} MPa/s", record.stress_rate / faster / 1e6);
  };
  return fmt::format(
    "The rate of the laboratory is {}, that of the run {}, {:.2g} times as fast: at the former a test would "
    "take up to {:.2g} steps.",
    rate(record.rate_over_laboratory), rate(1.0), record.rate_over_laboratory,
    (*longest)->bookkeeping.steps_at_laboratory_rate);
}
} // namespace feldspar
