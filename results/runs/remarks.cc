#include "results/runs/trust.h"

#include "base/append.h"
#include "base/contains.h"
#include "base/text.h"
#include "laboratory/named_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

/// Remarks on tests, each in a sentence or two: a result that is missing, or a condition of a strength; the warnings of which
/// they are a part.
namespace feldspar
{
namespace
{
constexpr std::size_t fewest_seeds = 3; // below that a standard deviation says nothing
constexpr std::string_view same_of_others = " The same holds for ";

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

/// Why a test has no result, or not all of it; empty if it has.
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

/// Why a splitting test is not valid; empty if it is, or is none.
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

/// A warning that rigid side plates make the body too strong, where it slides on a plane through it (docs/theory.md
/// §3.1); empty where they do not. Bodies of one rock have the same flaws.
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

/// A remark that the strengths of a body with flaws are nominal stresses; empty for a body without flaws.
std::string remark_on_flaws(const TestsOfRock& tests)
{
  const bool any = std::ranges::any_of(tests, [](const FinishedTest* test) { return test->has_flaws(); });
  return any
           ? "The body has flaws: its strengths are highest nominal stresses, load over the whole section, and hold for "
             "this body. They are no strengths of the rock, nor is their envelope."
           : "";
}

/// A remark on where the strain ran away under load control; empty where no test was under it.
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

/// A remark that the tests ran faster than in the laboratory; empty where none did.
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
} // namespace

std::vector<std::string> shortcomings(const TestsOfRock& tests, const SeriesKind kind)
{
  std::vector<std::string> sentences;
  std::map<std::string, std::pair<std::size_t, std::vector<std::string>>>
    alike; // by what is said: where, and further names
  for (const FinishedTest* const test : tests)
    for (const std::string& sentence : {shortcoming(*test), remark_on_splitting(*test)})
      if (!sentence.empty())
        {
          auto& of = alike.try_emplace(sentence.substr(test->name.size()), sentences.size(), std::vector<std::string>())
                       .first->second;
          if (of.first == sentences.size())
            sentences.push_back(sentence);
          else
            of.second.push_back(test->name);
        }
  for (const auto& [said, of] : alike)
    if (!of.second.empty())
      sentences[of.first] += fmt::format("{}{}.", same_of_others, some_of(of.second));
  for (const std::string& sentence :
       {remark_on_flaws(tests), remark_on_side_plates(tests), remark_on_load_control(tests), remark_on_rate(tests)})
    if (!sentence.empty())
      sentences.push_back(sentence);
  std::set<std::uint64_t> seeds;
  for (const FinishedTest* const test : tests)
    seeds.insert(test->record.seed);
  if (kind != SeriesKind::laboratory_curve && seeds.size() < fewest_seeds)
    {
      const std::string one = kind == SeriesKind::specimens ? "specimen" : "sample";
      sentences.push_back(fmt::format("Only {} {}{}: what belongs to the rock and what to the single {} cannot be told "
                                      "apart; take {} seeds or more.",
                                      seeds.size(), one, seeds.size() == 1 ? "" : "s", one, fewest_seeds));
    }
  return sentences;
}

std::vector<std::string> warnings(const TestsOfRock& tests, const SeriesKind kind)
{
  std::vector<std::string> sentences = shortcomings(tests, kind);
  for (const TrustCheck& check : trust_checks(tests, kind))
    if (check.n_out > 0)
      sentences.push_back(check.warning());
  return sentences;
}

std::vector<std::string> warnings(const Series& series)
{
  std::vector<std::string> sentences = warnings(all_of(series), series.kind);
  for (const auto& problem : series.problems)
    sentences.push_back(problem + ".");
  return sentences;
}

SharedWarnings shared_warnings(const std::vector<Series>& series)
{
  SharedWarnings shared;
  TestsOfRock all;
  std::vector<const Series*> models;
  for (const Series& one : series)
    {
      shared.own.push_back(warnings(one));
      if (one.kind == SeriesKind::laboratory_curve)
        continue;
      models.push_back(&one);
      append(all, all_of(one));
    }
  if (models.size() < 2)
    return shared;
  const auto erase = [&](const Series& one, const std::string& sentence) {
    std::erase(shared.own[std::size_t(&one - series.data())], sentence);
  };
  for (const std::string& sentence : shortcomings(all_of(*models.front()), models.front()->kind))
    if (std::ranges::all_of(models, [&](const Series* const one) {
          const auto its = shortcomings(all_of(*one), one->kind);
          return contains(its, sentence);
        }))
      {
        shared.of_all.push_back(sentence);
        for (const Series* const one : models)
          erase(*one, sentence);
      }
  for (const TrustCheck& of_all : trust_checks(all, models.front()->kind))
    {
      std::vector<std::string> sentences; // of the models that are out
      for (const Series* const one : models)
        for (const TrustCheck& check : trust_checks(*one))
          if (check.measure.name == of_all.measure.name && check.n_out > 0)
            sentences.push_back(check.warning());
      if (sentences.size() < models.size())
        continue;
      shared.of_all.push_back(of_all.warning());
      for (std::size_t k = 0; k < models.size(); ++k)
        erase(*models[k], sentences[k]);
    }
  return shared;
}

std::vector<std::string> grouped_warnings(const std::vector<Series>& series)
{
  struct Alike
  {
    std::string form; ///< without names of tests and digits
    std::string first;
    std::size_t n; ///< models
  };
  std::vector<Alike> all_alike;
  std::vector<std::string> problems;
  TestsOfRock all;
  std::size_t n_models = 0;
  SeriesKind kind = SeriesKind::specimens;
  for (const Series& one : series)
    {
      for (const auto& problem : one.problems)
        problems.push_back(problem + ".");
      if (one.kind == SeriesKind::laboratory_curve)
        continue;
      ++n_models;
      kind = one.kind;
      append(all, all_of(one));
      std::set<std::string> forms;
      for (const std::string& sentence : shortcomings(all_of(one), one.kind))
        {
          std::string form = sentence.substr(0, sentence.find(same_of_others));
          for (const FinishedTest& test : one.tests)
            if (const std::size_t at = form.find(test.name); at != std::string::npos)
              form.erase(at, test.name.size());
          std::erase_if(form, [](const char c) { return '0' <= c && c <= '9'; });
          if (!forms.insert(form).second)
            continue;
          const auto same = std::ranges::find(all_alike, form, &Alike::form);
          if (same == all_alike.end())
            all_alike.push_back({form, sentence, 1});
          else
            ++same->n;
        }
    }
  std::vector<std::string> sentences;
  for (const auto& [form, first, n] : all_alike)
    sentences.push_back(
      n == 1 ? first : fmt::format("{} (so in {} of {} series).", first.substr(0, first.size() - 1), n, n_models));
  for (const TrustCheck& check : trust_checks(all, kind))
    if (check.n_out > 0)
      sentences.push_back(check.warning());
  append(sentences, problems);
  return sentences;
}
} // namespace feldspar
