#include "results/folder/result_folder.h"

#include "base/colour.h"
#include "base/whole_file.h"
#include "results/evaluation.h"
#include "results/fits/direct_shear.h"
#include "results/folder/provenance_json.h"
#include "results/runs/trust.h"
#include "results/statistics.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

/// A number, or null with the reason in a field beside it.
void write_figure(Json& json, const std::string& key, const Figure& figure)
{
  if (figure.value)
    json[key] = json_number(*figure.value);
  else
    {
      json[key] = nullptr;
      json[key + "_reason"] = figure.reason;
    }
}

Json as_json(const Statistics& over_seeds)
{
  Json json{{"n", over_seeds.n}, {"mean", over_seeds.mean}};
  if (over_seeds.standard_deviation)
    {
      json["standard_deviation"] = *over_seeds.standard_deviation;
      json["standard_error"] = *over_seeds.standard_error;
      json["mean_confidence_95"] = *over_seeds.confidence_95;
      const Interval of_deviation = deviation_interval_95(over_seeds.n);
      json["standard_deviation_low_95"] = of_deviation.low * *over_seeds.standard_deviation;
      json["standard_deviation_high_95"] = of_deviation.high * *over_seeds.standard_deviation;
    }
  return json;
}

/// The figures at the end of each stage of a loading table; compression positive.
Json stages(const TestRecord& record)
{
  Json json = Json::array();
  const auto results = evaluate_stages(record);
  for (std::size_t k = 0; k < results.size(); ++k)
    {
      const StageRecord& stage = record.stages[k];
      Json one;
      one["target"] = stage.target;
      one["confining_pressure_Pa"] = json_number(stage.confining_pressure);
      one["reached"] = stage.reached;
      one["first_row"] = stage.first_row;
      one["last_row"] = stage.last_row;
      one["duration_s"] = results[k].duration;
      one["axial_strain_at_start"] = results[k].strain_at_start;
      one["axial_strain_at_end"] = results[k].strain_at_end;
      one["axial_stress_at_start_Pa"] = results[k].stress_at_start;
      one["axial_stress_at_end_Pa"] = results[k].stress_at_end;
      write_figure(one, "lateral_stress_at_end_Pa", results[k].lateral_stress_at_end);
      write_figure(one, "slope_Pa", results[k].slope);
      one["n_cracks"] = results[k].n_cracks;
      json.push_back(one);
    }
  return json;
}

void write_variant(Json& json, const FinishedTest& test)
{
  if (!test.variant.empty())
    json["variant"] = test.variant;
  if (!test.settings.empty())
    json["variant_values"] = as_json(test.settings);
}

Json describe(const FinishedTest& test)
{
  Json json;
  json["kind"] = test.record.kind.name;
  json["name"] = test.name;
  json["group"] = test.group;
  json["body"] = name(test.record.body);
  json["seed"] = test.record.seed;
  if (test.record.intermediate_stress)
    json["intermediate_stress_Pa"] = json_number(*test.record.intermediate_stress);
  if (test.record.normal_stiffness)
    json["normal_stiffness_Pa_per_m"] = json_number(*test.record.normal_stiffness);
  write_variant(json, test);
  json["interrupted"] = test.record.interrupted;
  if (!test.record.failure.empty())
    json["failure"] = test.record.failure;
  if (!test.record.ended_early.empty())
    json["ended_early"] = test.record.ended_early;
  if (test.record.came_apart)
    json["came_apart"] = true;
  if (const auto& work = test.bookkeeping.solver_work)
    json["solver_work"] = {{"solves", work->n_solves},
                           {"iterations", work->n_iterations},
                           {"cascades", work->n_cascades},
                           {"seconds_in_points", work->seconds_in_points}};
  json["size_m"] = test.record.size;
  json["way_to_grains_m"] = json_number(test.record.way_to_grains);
  const PeakDemands& demands = test.record.peak_demands;
  json["peak_demands"] = {{"least_stress_Pa", json_number(demands.least_stress)},
                          {"least_time_s", json_number(demands.least_time)},
                          {"least_fall", json_number(demands.least_fall)},
                          {"end_over_peak_strain", json_number(demands.end_over_peak_strain)}};
  if (const RankBalance& ranks = test.bookkeeping.ranks; ranks.mean > 0.0)
    json["ranks"] = {{"mean_s", ranks.mean},
                     {"longest_s", ranks.longest},
                     {"longest_unmoved_s", ranks.longest_unmoved},
                     {"moves", ranks.n_moves}};
  for (const TestQuantity& quantity : test_quantities)
    write_figure(json, std::string(quantity.name), value_of(quantity, test));
  if (test.record.kind.follows_stages)
    json["stages"] = stages(test.record);
  if (const auto& notch = test.record.notch)
    json["notch"] = {{"intensity_over_stress_sqrt_m", notch->intensity_over_stress},
                     {"work_over_stress_m3", notch->work_over_stress},
                     {"ligament_area_m2", notch->ligament_area},
                     {"ligament_length_m", notch->ligament_length},
                     {"is_valid", notch->is_valid}};
  for (const auto& [mineral, n_grains, share] : test.record.minerals)
    json["minerals"].push_back(
      {{"name", mineral.name}, {"colour", colour_text(mineral.colour)}, {"n_grains", n_grains}, {"share", share}});
  for (const auto& flaw : test.appearance.flaws)
    json["flaws"].push_back({{"name", flaw.name}, {"open", flaw.open}, {"outline_m", flaw.outline}});
  for (const auto& rve : test.appearance.rves)
    json["rves"].push_back({{"which", rve.which},
                            {"cell", rve.cell},
                            {"point", rve.point},
                            {"position_m", rve.position},
                            {"n_segments", rve.n_segments},
                            {"n_broken_segments", rve.cracks.size()}});
  return json;
}

/// Means over the seeds of each group of tests: of valid ones that were made. Their number stands beside that of all.
Json ensemble(const std::vector<FinishedTest>& tests)
{
  std::map<std::string, std::vector<const FinishedTest*>> groups;
  for (const auto& test : tests)
    groups[test.group].push_back(&test);

  Json json = Json::object();
  for (const auto& [group, members] : groups)
    {
      Json& out = json[group];
      if (!members.front()->variant.empty())
        write_variant(out, *members.front());
      out["n_tests"] = members.size();
      out["n_valid"] = std::ranges::count_if(members, [](const auto* test) { return test->counts(); });
      out["n_made"] = std::ranges::count_if(members, [](const auto* test) { return test->was_made(); });
      for (const TestQuantity& quantity : test_quantities)
        {
          std::vector<double> values;
          for (const FinishedTest* const test : members)
            if (const Figure figure = value_of(quantity, *test); test->counts() && figure.value)
              values.push_back(*figure.value);
          if (const auto over_seeds = statistics(values))
            out[std::string(quantity.name)] = as_json(*over_seeds);
        }
    }
  return json;
}

/// Verdict on how far the tests of each rock can be trusted.
Json verdict(const std::vector<FinishedTest>& tests)
{
  Json json = Json::array();
  for (const auto& [variant, kind, of_rock] : by_rock(tests))
    {
      Json rock;
      if (!variant.empty())
        rock["variant"] = variant;
      rock["checks"] = Json::array();
      for (const auto& [measure, n_tests, n_out, mean, worst, worst_test] : trust_checks(of_rock, kind))
        rock["checks"].push_back(
          {{"measure", measure.name},
           {"meaning", measure.title},
           {measure.bound.side == BoundSide::at_most ? "at_most" : "at_least", measure.bound.value},
           {"mean", mean},
           {"worst", worst},
           {"worst_test", worst_test},
           {"n_tests", n_tests},
           {"n_out_of_bounds", n_out}});
      rock["warnings"] = warnings(of_rock, kind);
      json.push_back(rock);
    }
  return json;
}

/// Every strength envelope of one rock. Instead of each, a reason if one is given.
Json envelopes_as_json(const StrengthEnvelopes& envelopes, const std::string& instead = {})
{
  Json json;
  for (const auto& record : records(envelopes))
    {
      Json& form = json[record.form];
      Json& out = record.variant.empty() ? form : form[record.variant];
      if (const std::string& reason = instead.empty() ? record.reason : instead; !reason.empty())
        {
          out["reason"] = reason;
          continue;
        }
      for (const auto& [entry_name, figure] : record.entries)
        write_figure(out, entry_name, figure);
      if (envelopes.data.tensile_strength && out.contains("measured_tensile_strength_Pa"))
        out["measured_tensile_strength_from"] = envelopes.data.tension_is_indirect ? "brazilian" : "direct_tension";
      for (const auto& [point, residual] : record.residuals)
        out["residuals"].push_back(
          {{"sigma_3_Pa", point.sigma_3}, {"sigma_1_Pa", point.sigma_1}, {"residual_Pa", residual}});
    }
  return json;
}

/// The envelopes of a run of one rock; of variants there is none of all together.
Json fits(const RunEnvelopes& envelopes)
{
  if (const auto of_one_rock = envelopes.find(""); of_one_rock != envelopes.end())
    return envelopes_as_json(of_one_rock->second);
  return envelopes_as_json(fit_strength_envelopes({}),
                           envelopes.empty() ? "" : "each variant has its own in fits_of_variants");
}

/// The envelopes of each variant, in the order of the tests.
Json fits_of_variants(const std::vector<FinishedTest>& tests, const RunEnvelopes& envelopes)
{
  Json json;
  std::set<std::string> written;
  for (const auto& test : tests)
    if (const auto own = envelopes.find(test.variant); !test.variant.empty() && own != envelopes.end())
      if (written.insert(test.variant).second)
        {
          Json variant;
          write_variant(variant, test);
          variant.update(envelopes_as_json(own->second));
          json.push_back(variant);
        }
  return json;
}

/// The line through the shear tests of each rock; none where there are no such tests.
Json shear_lines(const std::vector<FinishedTest>& tests)
{
  std::map<std::string, std::vector<const FinishedTest*>> rocks;
  for (const auto& test : tests)
    if (test.record.kind.pressure_acts_across)
      rocks[test.variant].push_back(&test);
  Json json;
  for (const auto& [variant, of_rock] : rocks)
    {
      Json& out = variant.empty() ? json : json[variant];
      const auto [line, reason] = fit_shear_line(of_rock);
      if (line)
        out = {{"cohesion_Pa", line->cohesion},
               {"friction_angle_rad", line->friction_angle},
               {"r_squared", line->r_squared},
               {"n_tests", line->n}};
      else
        out["reason"] = reason;
    }
  return json;
}
} // namespace

std::string test_as_json(const FinishedTest& test) { return json_text(describe(test)); }

std::string envelopes_as_text(const StrengthEnvelopes& envelopes) { return json_text(envelopes_as_json(envelopes)); }

void write_summary(const Provenance& provenance, const std::vector<FinishedTest>& tests, const RunEnvelopes& envelopes,
                   const std::filesystem::path& file)
{
  Json json = as_json(provenance);
  json["tests"] = Json::array();
  for (const auto& test : tests)
    json["tests"].push_back(describe(test));
  json["ensemble"] = ensemble(tests);
  json["verdict"] = verdict(tests);
  json["fits"] = fits(envelopes);
  if (const Json lines = shear_lines(tests); !lines.is_null())
    json["fits"]["direct_shear"] = lines;
  if (const Json of_variants = fits_of_variants(tests, envelopes); !of_variants.is_null())
    json["fits_of_variants"] = of_variants;
  write_whole_file(file, json_text(json)); // reasons may quote what is not UTF-8
}
} // namespace feldspar
