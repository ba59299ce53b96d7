#include "report/pictures/envelope_plot.h"

#include "base/prefixes.h"
#include "results/fits/residual_strength.h"
#include "results/fits/strength_envelopes.h"
#include "results/runs/test_groups.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace feldspar::plot
{
namespace
{
/// A strength of a series with its scatter; a tension test lies at (-sigma_t, 0) and scatters along sigma_3.
struct StrengthPoint
{
  double sigma_3;
  double sigma_1;
  double deviation;
  bool tension;
};

std::vector<StrengthPoint> strength_points(const Series& series)
{
  std::vector<StrengthPoint> points;
  for (const auto& group : groups_of(series))
    if (const auto strength = statistics(values(group, &TestResults::peak_stress)))
      {
        const double deviation = strength->standard_deviation.value_or(0.0);
        switch (group.envelope_role())
          {
          case EnvelopeRole::tension:
          case EnvelopeRole::indirect_tension:
            points.push_back({-strength->mean, 0.0, deviation, true});
            break;
          case EnvelopeRole::compression:
            points.push_back({group.confining_pressure, strength->mean, deviation, false});
            break;
          case EnvelopeRole::none:
            break;
          }
      }
  return points;
}
} // namespace

std::string label_of(const HoekBrownFit& fit)
{
  return fmt::format("H–B {}, {} σ_t", name(fit.form), fit.with_tension_point ? "with" : "without");
}

void EnvelopePlot::take_in(const double sigma_3, const double sigma_1)
{
  lowest_3 = std::min(lowest_3, sigma_3);
  highest_3 = std::max(highest_3, sigma_3);
  highest_1 = std::max(highest_1, sigma_1);
}

void EnvelopePlot::add_points(const Series& series, const std::size_t n)
{
  const auto points = strength_points(series);
  if (points.empty())
    return;
  const bool has_scatter =
    std::any_of(points.begin(), points.end(), [](const auto& one) { return one.deviation > 0.0; });
  const std::string label = series.label + (has_scatter ? ": mean ± s.d." : "");
  bool is_second = false;
  for (const bool tension : {false, true})
    {
      std::string rows;
      ChartLine marks{.kind = ChartLine::Kind::marks,
                      .label = label,
                      .goes_with = is_second ? label : "",
                      .colour = colour(series, n),
                      .mark = point_type(series)};
      ChartLine bars{.kind = ChartLine::Kind::bars,
                     .label = label,
                     .goes_with = label,
                     .colour = colour(series, n),
                     .width = 1.4};
      for (const auto& point : points)
        if (point.tension == tension)
          {
            fmt::format_to(std::back_inserter(rows), "{} {} {}\n", point.sigma_3 / mega, point.sigma_1 / mega,
                           point.deviation / mega);
            marks.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega});
            for (const double sign : {-1.0, 1.0})
              bars.points.push_back({(point.sigma_3 + (tension ? sign * point.deviation : 0.0)) / mega,
                                     (point.sigma_1 + (tension ? 0.0 : sign * point.deviation)) / mega});
            bars.points.push_back(gap);
            take_in(point.sigma_3 - (tension ? point.deviation : 0.0),
                    point.sigma_1 + (tension ? 0.0 : point.deviation));
          }
      if (rows.empty())
        continue;
      const std::string block = add_data(rows);
      const std::string looks = fmt::format("pt {} ps 0.8 lw 1.4 lc rgb '{}'", marks.mark, marks.colour);
      later.push_back(fmt::format("{} using 1:2:3 with {} {} {}", block, tension ? "xerrorbars" : "yerrorbars", looks,
                                  key.entry(is_second ? "" : label)));
      of_page.push_back(std::move(bars));
      of_page.push_back(std::move(marks));
      is_second = true;
    }
}

void EnvelopePlot::add_residual(const Series& series, const std::size_t n)
{
  const std::string label = series.label + ": residual";
  ChartLine line{.label = label, .colour = colour(series, n), .width = 1.2, .dashes = 3};
  std::string rows;
  for (const auto& point : residual_points(series))
    {
      fmt::format_to(std::back_inserter(rows), "{} {} {}\n", point.sigma_3 / mega, point.sigma_1 / mega,
                     point.deviation / mega);
      line.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega});
      take_in(point.sigma_3, point.sigma_1 + point.deviation);
    }
  if (rows.empty())
    return;
  ChartLine marks = line;
  marks.kind = ChartLine::Kind::marks;
  marks.goes_with = label;
  marks.mark = point_type(series) - 1;
  const std::string block = add_data(rows);
  first.push_back(fmt::format("{} using 1:2 with lines lw 1.2 dt 3 lc rgb '{}' notitle", block, line.colour));
  later.push_back(fmt::format("{} using 1:2:3 with yerrorbars pt {} ps 0.8 lw 1.2 lc rgb '{}' {}", block, marks.mark,
                              line.colour, key.entry(label)));
  of_page.push_back(std::move(line));
  of_page.push_back(std::move(marks));
}

void EnvelopePlot::add_curve(const std::function<double(double)>& sigma_1, const double begin, const double end,
                             const CurveLooks& looks, const std::string& label)
{
  std::string rows;
  ChartLine line{.label = label, .colour = looks.colour, .width = looks.width, .dashes = looks.dashes};
  constexpr int n = 300;
  for (int k = 0; k <= n; ++k)
    {
      // Closer where the curve bends: near its beginning.
      const double share = std::pow(double(k) / n, 4.0);
      const double inside = begin + 1e-12 * std::abs(begin); // at its beginning the bracket is 0, or just below it
      const double sigma_3 = inside + (end - inside) * share;
      if (const double value = sigma_1(sigma_3); std::isfinite(value))
        {
          fmt::format_to(std::back_inserter(rows), "{} {}\n", sigma_3 / mega, value / mega);
          if (k % 3 == 0)
            line.points.push_back({sigma_3 / mega, value / mega});
        }
    }
  first.push_back(fmt::format("{} using 1:2 with lines lw {} dt {} lc rgb '{}' {}", add_data(rows), looks.width,
                              looks.dashes, looks.colour, key.entry(label)));
  of_page.push_back(std::move(line));
}

void EnvelopePlot::add_reference(const Reference& reference)
{
  const std::string label = reference.experiment.label + ": mean, range";
  bool is_second = false;
  const auto draw_range = [&](const std::string& property, const bool tension) {
    const auto value = reference.experiment.find(property);
    if (!value)
      return;
    const double middle = value->middle();
    const double low = value->low.value_or(middle);
    const double high = value->high.value_or(middle);
    const std::string block = add_data(tension ? fmt::format("{} 0 {} {}\n", -middle, -high, -low)
                                               : fmt::format("0 {} {} {}\n", middle, low, high));
    later.push_back(fmt::format("{} using 1:2:3:4 with {} pt {} ps 1.1 lw 2.2 lc rgb '{}' {}", block,
                                tension ? "xerrorbars" : "yerrorbars", mark_of_experiment, black,
                                key.entry(is_second ? "" : label)));
    const auto at = [&](const double strength) {
      return tension ? std::array{-strength, 0.0} : std::array{0.0, strength};
    };
    of_page.push_back({.kind = ChartLine::Kind::bars,
                       .label = label,
                       .goes_with = label,
                       .colour = black,
                       .points = {at(low), at(high), gap}});
    of_page.push_back({.kind = ChartLine::Kind::marks,
                       .label = label,
                       .goes_with = is_second ? label : "",
                       .colour = black,
                       .mark = mark_of_experiment,
                       .points = {at(middle)}});
    is_second = true;
    take_in(tension ? -high * mega : 0.0, tension ? 0.0 : high * mega);
  };
  draw_range("uniaxial_compressive_strength_MPa", false);
  draw_range("tensile_strength_MPa", true);
  draw_strengths(reference.experiment, mark_of_experiment, "ps 1.1 lw 1.6", black);
  draw_strengths(reference.model, mark_of_model, "ps 0.9 lw 1.2", grey);
}

void EnvelopePlot::add_printed(const ReferenceSource& source, const char* of_colour)
{
  const auto points = source.strengths(); // by rising pressure
  const double end = !points.empty() && points.back().sigma_3 > 0.0 ? points.back().sigma_3 : highest_3;
  if (const auto& printed = source.envelope)
    add_curve([&](const double x) { return printed->sigma_1(x); }, -printed->s * printed->sigma_ci / printed->m, end,
              {1.4, 3, of_colour}, source.label + ", printed");
  if (const auto line = source.line())
    add_curve([&](const double x) { return line->sigma_1(x); }, 0.0, end, {1.4, 4, of_colour},
              source.label + ": c and φ, printed");
}

void EnvelopePlot::add_fit_of(const ReferenceSource& experiment)
{
  for (const auto& pair : experiment.fitted.hoek_brown)
    if (pair.form == HoekBrownForm::intact)
      {
        const auto& best = pair.with_tension_point.fit ? pair.with_tension_point.fit : pair.without_tension_point.fit;
        if (best && best->quality.degrees_of_freedom > 0)
          add_fit(*best, {1.6, 2, black}, experiment.label + ": " + label_of(*best));
      }
}

void EnvelopePlot::add_rock_curves(const Reference& reference)
{
  add_fit_of(reference.experiment);
  add_printed(reference.experiment, black);
  add_printed(reference.model, grey);
}

void EnvelopePlot::add_cut_off(const HoekBrownFit& fit, const std::string& of_colour)
{
  const double sigma_3 = fit.tensile_cut_off.value / mega;
  const double top = fit.uniaxial_compressive_strength.value / mega;
  const std::string block = add_data(fmt::format("{} 0\n{} {}\n", sigma_3, sigma_3, top));
  const std::string label = "tensile cut-off of the intact form";
  first.push_back(fmt::format("{} using 1:2 with lines lw 1 dt 3 lc rgb '{}' {}", block, of_colour, key.entry(label)));
  of_page.push_back(
    {.label = label, .colour = of_colour, .width = 1.0, .dashes = 3, .points = {{sigma_3, 0.0}, {sigma_3, top}}});
}

std::array<double, 4> EnvelopePlot::part_up_to(const std::optional<EnvelopePoint>& upper) const
{
  return {(lowest_3 < 0.0 ? 1.25 * lowest_3 : 0.0) / mega,
          (upper ? upper->sigma_3 : std::max(1.05 * highest_3, 1e6)) / mega, 0.0,
          (upper ? upper->sigma_1 : 1.08 * highest_1) / mega};
}

std::string EnvelopePlot::script(const std::optional<EnvelopePoint>& upper) const
{
  const auto [left, right, bottom, top] = part_up_to(upper);
  std::string text = data + frame(x_label, y_label);
  fmt::format_to(std::back_inserter(text), "set xrange [{}:{}]; set yrange [{}:{}]\n", left, right, bottom, top);
  text += "set arrow from 0, graph 0 to 0, graph 1 nohead lw 0.8 lc rgb '#b0b0b0' back\n" + key.set_up(width) +
          " font ',12'\nplot ";
  const auto add = [&](const std::vector<std::string>& entries) {
    for (const auto& entry : entries)
      text += entry + ", \\\n";
  };
  add(first);
  add(later);
  text.resize(text.size() - 4); // the last comma
  return text + "\n";
}

std::string EnvelopePlot::json(const std::optional<EnvelopePoint>& upper) const
{
  Chart chart{.x_label = x_label, .y_label = y_label};
  if (upper)
    chart.part = part_up_to(upper);
  chart.lines = of_page;
  return chart.json();
}

void EnvelopePlot::draw_strengths(const ReferenceSource& source, const int mark, const std::string& looks,
                                  const char* of_colour)
{
  std::string rows;
  ChartLine marks{.kind = ChartLine::Kind::marks, .label = source.label, .colour = of_colour, .mark = mark};
  for (const auto& point : source.strengths())
    {
      fmt::format_to(std::back_inserter(rows), "{} {}\n", point.sigma_3 / mega, point.sigma_1 / mega);
      marks.points.push_back({point.sigma_3 / mega, point.sigma_1 / mega});
      take_in(point.sigma_3, point.sigma_1);
    }
  if (rows.empty())
    return;
  later.push_back(fmt::format("{} using 1:2 with points pt {} {} lc rgb '{}' {}", add_data(rows), mark, looks,
                              of_colour, key.entry(source.label)));
  of_page.push_back(std::move(marks));
}

std::string EnvelopePlot::add_data(const std::string& rows)
{
  const std::string block = fmt::format("$data{}", n_blocks++);
  data += fmt::format("{} << EOD\n{}EOD\n", block, rows);
  return block;
}
} // namespace feldspar::plot
