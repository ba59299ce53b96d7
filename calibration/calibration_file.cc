#include "calibration/calibration_file.h"

#include "base/whole_file.h"
#include "results/folder/provenance_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace feldspar::calibration
{
namespace
{
using Json = nlohmann::ordered_json;

std::string si_unit(const Response& response) { return response.shown.unit.empty() ? "1" : "Pa"; }

Json as_json(const TargetOutcome& outcome, const Response& response, const double tolerance)
{
  Json json{{"title", response.title},
            {"unit", si_unit(response)},
            {"target", outcome.target.value},
            {"target_standard_deviation", outcome.target.deviation},
            {"target_standard_deviation_is", outcome.target.source},
            {"reached", outcome.value()}};
  if (outcome.reached && outcome.reached->standard_error)
    json["standard_error"] = *outcome.reached->standard_error;
  else
    {
      json["standard_error"] = nullptr;
      json["standard_error_reason"] = "it was not tested on two packings or more; `reached` is the prediction";
    }
  json["n_packings"] = outcome.reached ? outcome.reached->n : 0;
  if (outcome.reached && outcome.reached->confidence_95)
    {
      json["lower_95"] = outcome.reached->mean - *outcome.reached->confidence_95;
      json["upper_95"] = outcome.reached->mean + *outcome.reached->confidence_95;
    }
  if (outcome.reached && outcome.reached->standard_deviation)
    json["standard_deviation_over_packings"] = *outcome.reached->standard_deviation;
  json["deviation"] = outcome.deviation();
  json["within_tolerance"] = std::abs(outcome.deviation()) <= tolerance;
  const TargetVerdict verdict = verdict_on(outcome, tolerance);
  json["verdict"] = name(verdict);
  if (verdict == TargetVerdict::not_decided)
    {
      const auto needed = packings_to_decide(mean_of(outcome, response.title), tolerance);
      json["packings_needed"] = needed ? Json(*needed) : Json();
      if (!needed)
        json["packings_needed_reason"] =
          outcome.reached && outcome.reached->n > 1 ? "more than 10000" : "fewer than two packings gave the figure";
    }
  return json;
}

Json as_json(const ParameterAnswer& answer)
{
  Json json{{"title", answer.title},   {"unit", answer.si_unit()},    {"best", answer.best},
            {"median", answer.median}, {"lower_90", answer.lower_90}, {"upper_90", answer.upper_90}};
  if (answer.bounds)
    json["bounds"] = {answer.bounds->lower, answer.bounds->upper};
  json["share_of_bounds"] = answer.share_of_bounds;
  json["verdict"] = words(answer.verdict);
  if (!answer.helpful_test.empty())
    json["helpful_test"] = answer.helpful_test;
  json["sentence"] = answer.sentence;
  return json;
}

std::string design_table(const ResponseModel& model, const std::vector<TestedPoint>& tested)
{
  std::string text = "stage,point,seed,modulus_Pa,bond_tensile_strength_Pa,bond_cohesion_Pa,stiffness_ratio,"
                     "bond_friction_angle_rad,friction,installation_gap_ratio";
  const bool has_boundaries = std::ranges::any_of(
    model.unknowns(), [](const Unknown& one) { return one.member == &MicroParameters::boundary_strength; });
  text += has_boundaries ? ",boundary_strength" : "";
  for (std::size_t j = 0; j < model.n_responses(); ++j)
    text += fmt::format(",{}{}", model.response(j).name, model.response(j).shown.unit.empty() ? "" : "_Pa");
  text += '\n';
  for (const TestedPoint& one : tested)
    {
      const MicroParameters& p = one.parameters;
      fmt::format_to(std::back_inserter(text), "{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}", one.stage,
                     one.number, one.seed, p.modulus, p.bond_tensile_strength,
                     p.cohesion_ratio * p.bond_tensile_strength, p.stiffness_ratio, p.bond_friction_angle, p.friction,
                     p.gap ? fmt::format("{:.9g}", *p.gap) : "");
      if (has_boundaries)
        fmt::format_to(std::back_inserter(text), ",{:.9g}", p.boundary_strength);
      for (const auto& value : one.values)
        text += value ? fmt::format(",{:.9g}", *value) : ",";
      text += '\n';
    }
  return text;
}

std::string posterior_table(const CalibrationOutcome& outcome, const ResponseModel& model)
{
  std::string text = "modulus_Pa,bond_tensile_strength_Pa,bond_cohesion_Pa";
  for (const Unknown& unknown : model.unknowns())
    text += fmt::format(",{}{}", unknown.name, unknown.unit == "deg" ? "_rad" : "");
  text += '\n';
  for (const Place& place : outcome.posterior.samples)
    {
      const MicroParameters p = model.parameters(place);
      fmt::format_to(std::back_inserter(text), "{:.7g},{:.7g},{:.7g}", p.modulus, p.bond_tensile_strength,
                     p.cohesion_ratio * p.bond_tensile_strength);
      for (std::size_t k = 0; k < model.unknowns().size(); ++k)
        fmt::format_to(std::back_inserter(text), ",{:.7g}", model.unknowns()[k].value(place.point[k]));
      text += '\n';
    }
  return text;
}
} // namespace

void write_calibration(const Provenance& made_by, const CalibrationOutcome& outcome, const ResponseModel& model,
                       const std::vector<TestedPoint>& tested, const std::filesystem::path& folder)
{
  Json json = as_json(made_by);
  json["rock"] = outcome.rock;
  json["verdict"] = name(outcome.verdict);
  json["has_reached"] = outcome.verdict == TargetVerdict::reached;
  json["statement"] = outcome.statement;
  json["tolerance"] = outcome.tolerance;
  json["targets"] = Json::object();
  for (const TargetOutcome& target : outcome.targets)
    {
      const Response& response = model.response(target.target.response);
      json["targets"][response.name] = as_json(target, response, outcome.tolerance);
    }
  json["parameters"] = Json::object();
  for (const ParameterAnswer& answer : outcome.posterior.parameters)
    json["parameters"][answer.name] = as_json(answer);
  json["predictions"] = Json::object();
  for (const PredictedResponse& predicted : outcome.posterior.predictions)
    {
      const Response& response = model.response(predicted.response);
      json["predictions"][response.name] = {{"title", response.title},
                                            {"unit", si_unit(response)},
                                            {"median", predicted.median},
                                            {"lower_90", predicted.lower_90},
                                            {"upper_90", predicted.upper_90}};
    }
  json["sensitivities"] = Json::object();
  for (const auto& [name, indices] : outcome.sensitivities)
    for (std::size_t k = 0; k < model.unknowns().size(); ++k)
      json["sensitivities"][name][model.unknowns()[k].name] = {{"first_order", indices.first_order[k]},
                                                               {"total", indices.total[k]}};
  Json& learnt = json["surrogates"] = Json::object();
  for (std::size_t j = 0; j < model.n_responses(); ++j)
    if (model.knows(j))
      {
        const LearntResponse& of_tests = model.learnt(j);
        Json& one = learnt[model.response(j).name];
        one["noise_of_a_value"] = of_tests.noise;
        one["correction"] = of_tests.correction;
        if (of_tests.scatter)
          one["scatter_of_packings"] = *of_tests.scatter;
        one["is_of"] = model.response(j).scale == ResponseScale::none ? "the figure" : "its logarithm";
      }
  json["strain_scale_effects"] = outcome.scale_effects;
  if (outcome.modulus_of_specimens_over_cells)
    json["modulus_of_specimens_over_cells"] = *outcome.modulus_of_specimens_over_cells;
  json["n_steps"] = outcome.n_steps;
  write_whole_file(folder / calibration_file::answer, json_text(json));
  write_design(model, tested, folder);
  if (!outcome.posterior.samples.empty())
    write_whole_file(folder / calibration_file::posterior, posterior_table(outcome, model));
}

void write_design(const ResponseModel& model, const std::vector<TestedPoint>& tested,
                  const std::filesystem::path& folder)
{
  write_whole_file(folder / calibration_file::design, design_table(model, tested));
}

std::string as_text(const CalibrationOutcome& outcome, const ResponseModel& model)
{
  const bool was_tested =
    std::ranges::any_of(outcome.targets, [](const auto& target) { return target.reached.has_value(); });
  std::string text;
  text += fmt::format("{:44} {:>10} {:>19} {:>10}  {}\n", "", "target", was_tested ? "reached" : "predicted",
                      "deviation", "verdict");
  for (const TargetOutcome& target : outcome.targets)
    {
      const Response& response = model.response(target.target.response);
      const auto shown = [&](const double value) {
        return fmt::format("{:.{}f}", value / response.shown.scale, response.shown.decimals);
      };
      std::string reached = shown(target.value());
      if (target.reached && target.reached->standard_error)
        reached += fmt::format(" +- {}", shown(*target.reached->standard_error));
      text += fmt::format("{:44} {:>10} {:>19} {:>9.1f}%  {}\n", with_unit(response.title, response.shown.unit),
                          shown(target.target.value), reached, 100.0 * target.deviation(),
                          words(verdict_on(target, outcome.tolerance)));
    }
  if (outcome.posterior.parameters.empty())
    return text + fmt::format("\nThe parameters that come nearest stand in {}.\n\n{}\n", calibration_file::nearest,
                              outcome.statement);
  text += fmt::format("\n{:44} {:>10} {:>10} {:>19}  {}\n", "", "best", "median", "90 % interval", "verdict");
  for (const ParameterAnswer& answer : outcome.posterior.parameters)
    {
      const auto shown = [&](const double value) { return fmt::format("{:.3g}", value / answer.unit_size); };
      text += fmt::format("{:44} {:>10} {:>10} {:>19}  {}\n", with_unit(answer.title, answer.unit), shown(answer.best),
                          shown(answer.median), fmt::format("{} to {}", shown(answer.lower_90), shown(answer.upper_90)),
                          words(answer.verdict));
    }
  text += '\n';
  for (const ParameterAnswer& answer : outcome.posterior.parameters)
    text += answer.sentence + "\n";
  if (!outcome.scale_effects.empty())
    {
      text += "\nHalf as much bond strength again at the same modulus changed, over that strength and on one packing,";
      const char* comma = "";
      for (const auto& [name, effect] : outcome.scale_effects)
        {
          text += fmt::format("{} {} by {:+.1f} %", comma, model.title(name), 100.0 * effect);
          comma = ",";
        }
      text += ".\n";
    }
  return text + "\n" + outcome.statement + "\n";
}
} // namespace feldspar::calibration
