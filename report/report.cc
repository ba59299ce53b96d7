#include "report/report.h"

#include "base/quoted.h"
#include "base/whole_file.h"
#include "report/page/page.h"
#include "report/pictures/crack_pictures.h"
#include "report/pictures/curve_pictures.h"
#include "report/pictures/envelope_pictures.h"
#include "report/pictures/lab_pictures.h"
#include "report/pictures/plot_style.h"
#include "report/pictures/sample_pictures.h"
#include "report/pictures/space_pictures.h"
#include "report/sections/comparison.h"
#include "report/sections/trust.h"
#include "report/sections/verdict.h"
#include "results/fits/strength_data.h"
#include "results/fits/strength_envelopes.h"
#include "results/folder/result_folder.h"
#include "results/result_table.h"
#include "results/statistics.h"
#include "results/test_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace feldspar
{
namespace
{
constexpr double mega = 1e6;
const std::string none = "–";

template <typename T>
void append(std::vector<T>& all, std::vector<T> more)
{
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// Everything that sections are made of, computed once.
struct Findings
{
  const std::vector<Series>& all;
  const std::optional<Reference>& reference;
  const std::string& reference_problem;
  bool one_folder;
  std::vector<std::vector<ComparisonRow>> comparisons; ///< of each series
  std::vector<StrengthEnvelopes> envelopes;            ///< of each series
};

std::string number(const double value, const int decimals) { return fmt::format("{:.{}f}", value, decimals); }

std::string number(const Figure& figure, const double unit, const int decimals)
{
  return figure.value ? number(*figure.value / unit, decimals) : none;
}

std::string estimate(const Estimate& value, const double unit, const int decimals)
{
  std::string text = number(value.value / unit, decimals);
  if (value.half_width.value)
    text += fmt::format(" ± {}", number(*value.half_width.value / unit, decimals));
  return text;
}

std::string deviation_text(const Statistics& over_seeds, const double unit, const int decimals)
{
  std::string text = number(over_seeds.mean / unit, decimals);
  if (over_seeds.standard_deviation)
    text += fmt::format(" ± {}", number(*over_seeds.standard_deviation / unit, decimals));
  return text;
}

std::string interval_text(const Statistics& over_seeds, const double unit, const int decimals)
{
  if (!over_seeds.confidence_95)
    return none;
  return fmt::format("{} to {}", number((over_seeds.mean - *over_seeds.confidence_95) / unit, decimals),
                     number((over_seeds.mean + *over_seeds.confidence_95) / unit, decimals));
}

/// Terminal text writes stresses out.
std::string with_symbols(std::string text)
{
  for (const auto& [word, symbol] :
       {std::pair("sigma_3", "σ₃"), {"sigma_1", "σ₁"}, {"sigma_t", "σ_t"}, {"sigma_ci", "σ_ci"}, {"<=", "≤"}})
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos;)
      text.replace(at, std::string(word).size(), symbol);
  return text;
}

/// The heading of what belongs to one of several series.
PageBlock block_of(const Findings& findings, const std::size_t n)
{
  PageBlock block;
  if (findings.all.size() > 1)
    {
      block.subheading = findings.all[n].label;
      block.chip = plot::colour(findings.all[n], n);
    }
  return block;
}

std::string signed_percent(const double share)
{
  return fmt::format("{}{:.1f} %", share < 0.0 ? "−" : "+", 100.0 * std::abs(share));
}

std::string against_experiment(const ComparisonRow& row)
{
  if (!row.ours || !row.experiment)
    return none;
  const std::string deviation = row.deviation() ? signed_percent(*row.deviation()) : "";
  if (!row.in_range())
    return "no range given" + (deviation.empty() ? "" : ", " + deviation);
  return (*row.in_range() ? "✓ " : "✗ ") + deviation + (*row.in_range() ? ", in range" : ", out of range");
}

/// A line of the comparison: heading, model, experiment, model against experiment and so on of one series; of several
/// the rock before them.
std::vector<std::string> arranged(const std::string& heading, const std::vector<std::string>& rock,
                                  const std::vector<std::string>& ours, const bool one)
{
  std::vector<std::string> line{heading};
  if (one && !rock.empty())
    append(line, {ours[0], rock[0], ours[1], ours[2], rock[1]});
  else
    {
      append(line, rock);
      append(line, ours);
    }
  return line;
}

Table comparison_table(const Findings& findings)
{
  // Measured curves have tables of their own beside the model, if there is one.
  const bool any_model = std::any_of(findings.all.begin(), findings.all.end(),
                                     [](const Series& series) { return series.kind != SeriesKind::laboratory_curve; });
  std::vector<std::size_t> compared;
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    if (!any_model || findings.all[n].kind != SeriesKind::laboratory_curve)
      compared.push_back(n);

  // Rows of these series, by their names, in the order in which they come.
  std::vector<std::string> properties;
  for (const std::size_t n : compared)
    for (const auto& row : findings.comparisons[n])
      if ((row.ours || row.experiment || row.model) &&
          std::find(properties.begin(), properties.end(), row.property) == properties.end())
        properties.push_back(row.property);
  const bool one = compared.size() == 1;

  Table table{"comparison",
              "Model and rock. ± is the standard deviation over the seeds; the interval is that of the mean, 95 %, by "
              "Student's t. Range: does our mean lie in that of the experiments?",
              {"property"},
              {}};
  // Of one series the model stands beside the rock; of several each is held against the rock, which comes first.
  std::vector<std::string> rock;
  if (findings.reference)
    rock = {findings.reference->experiment.label + ", mean (range)", findings.reference->model.label};
  std::vector<std::string> of_series;
  for (const std::size_t n : compared)
    append(of_series, {one && any_model ? "model" : findings.all[n].label, "against experiment", "95 % of the mean"});
  table.header = arranged("property", rock, of_series, one);
  for (const auto& property : properties)
    {
      std::string heading;
      std::vector<std::string> ours;
      std::string experiment = none;
      std::string model = none;
      for (const std::size_t n : compared)
        {
          const auto& rows = findings.comparisons[n];
          const auto row = std::find_if(rows.begin(), rows.end(),
                                        [&](const ComparisonRow& candidate) { return candidate.property == property; });
          if (row == rows.end())
            {
              append(ours, {none, none, none});
              continue;
            }
          heading = row->unit.empty() ? property : fmt::format("{} [{}]", property, row->unit);
          append(ours,
                 {row->ours ? fmt::format("{} (n = {})", deviation_text(*row->ours, 1.0, row->decimals), row->ours->n)
                            : none,
                  against_experiment(*row), row->ours ? interval_text(*row->ours, 1.0, row->decimals) : none});
          if (row->experiment)
            experiment = as_text(*row, row->experiment);
          if (row->model)
            model = as_text(*row, row->model);
        }
      if (findings.reference)
        rock = {experiment, model};
      table.rows.push_back(arranged(heading, rock, ours, one));
    }
  return table;
}

/// A measured curve beside the model's tests of its kind and pressure.
Table measured_table(const Findings& findings, const std::size_t which)
{
  const Series& measured = findings.all[which];
  const TestGroup curve = groups_of(measured).front();
  Table table{fmt::format("measured_{}_{}", which + 1, plot::file_name(measured.label)),
              curve.title() + ": measured and model, mean ± standard deviation over the seeds",
              {"property", measured.label},
              {}};
  // The model was hardly pressed with just the pressure of the laboratory.
  const auto is_alike = [&](const TestGroup& group) {
    return group.kind == curve.kind && std::abs(group.confining_pressure - curve.confining_pressure) <=
                                         0.05 * std::max(group.confining_pressure, curve.confining_pressure);
  };
  std::vector<TestGroup> beside;
  for (const auto& series : findings.all)
    if (series.kind != SeriesKind::laboratory_curve)
      for (const auto& group : groups_of(series))
        if (is_alike(group))
          {
            beside.push_back(group);
            table.header.push_back(group.confining_pressure == curve.confining_pressure
                                     ? series.label
                                     : series.label + ", " + group.title());
          }
  struct Property
  {
    const char* name;
    Figure TestResults::*figure;
    double unit;
    int decimals;
  };
  static constexpr std::array properties{
    Property{"peak stress [MPa]", &TestResults::peak_stress, mega, 1},
    Property{"strain at peak [1e-3]", &TestResults::strain_at_peak, 1e-3, 2},
    Property{"Young's modulus, tangent 40-60 % of peak [GPa]", &TestResults::youngs_modulus_tangent, 1e9, 1},
    Property{"Young's modulus, initial [GPa]", &TestResults::youngs_modulus_initial, 1e9, 1},
    Property{"Poisson's ratio, secant at 50 % of peak", &TestResults::poissons_ratio_secant, 1.0, 3},
    Property{"Poisson's ratio, initial", &TestResults::poissons_ratio_initial, 1.0, 3},
    Property{"crack initiation stress, lateral strain [MPa]", &TestResults::crack_initiation_stress_lateral, mega, 1},
    Property{"crack initiation stress, count of cracks [MPa]", &TestResults::crack_initiation_stress, mega, 1},
    Property{"crack damage stress [MPa]", &TestResults::crack_damage_stress, mega, 1}};
  for (const auto& property : properties)
    {
      std::vector<std::string> row{
        property.name, number(curve.tests.front()->results.*property.figure, property.unit, property.decimals)};
      for (const auto& group : beside)
        {
          const auto over_seeds = statistics(values(group, property.figure));
          row.push_back(over_seeds ? deviation_text(*over_seeds, property.unit, property.decimals) : none);
        }
      table.rows.push_back(row);
    }
  if (beside.empty())
    table.caption += "; the model was not tested so";
  return table;
}

/// What the input says of it.
std::string material_at_points(const Provenance& made_by)
{
  const auto found = std::find_if(made_by.input.begin(), made_by.input.end(), [](const InputEntry& one) {
    return one.section == "Sample" && one.entry == "Material";
  });
  if (found == made_by.input.end())
    return "";
  return found->value == "grains" ? " with a volume of grains at every point"
                                  : " of " + found->value + ", without grains";
}

PageSection verdict_section(const Findings& findings)
{
  PageSection section{"verdict", "Verdict", "Is the model the rock?", {}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      PageBlock block = block_of(findings, n);
      block.warnings = warnings(findings.all[n]);
      if (findings.all[n].kind == SeriesKind::laboratory_curve)
        {
          block.subheading = findings.all[n].label;
          block.chip = plot::colour(findings.all[n], n);
          block.paragraphs.push_back("Measured in a laboratory and evaluated as the model's tests are.");
          block.tables.push_back(measured_table(findings, n));
        }
      else
        {
          const Verdict answer = verdict(findings.comparisons[n], findings.reference_problem);
          if (findings.all[n].kind == SeriesKind::finite_elements)
            block.paragraphs.push_back(
              fmt::format("Made on a sample of finite elements{}, and evaluated as tests on specimens of grains are.",
                          material_at_points(findings.all[n].made_by)));
          block.headline = answer.headline;
          block.points = answer.points;
          if (block.warnings.empty())
            block.paragraphs.push_back("Every check of the section Trust is within its bounds.");
        }
      section.blocks.push_back(block);
    }
  PageBlock table;
  if (!findings.reference_problem.empty())
    table.warnings.push_back(findings.reference_problem + ".");
  table.tables.push_back(comparison_table(findings));
  if (findings.reference)
    {
      std::string source = findings.reference->rock;
      for (const auto& citation : findings.reference->citations)
        source += (source.empty() ? "" : ". ") + citation;
      if (!source.empty())
        table.paragraphs.push_back("Reference: " + source + ".");
    }
  section.blocks.push_back(table);
  return section;
}

Table fit_table(const StrengthEnvelopes& envelopes, const std::string& name)
{
  const auto& measured = envelopes.data;
  const auto stress = [](const std::optional<double>& value, const int decimals) {
    return value ? number(*value / mega, decimals) : none;
  };
  const auto beside = [](const double fitted, const std::optional<double>& was_measured) {
    return was_measured ? fmt::format(" ({})", signed_percent(fitted / *was_measured - 1.0)) : std::string();
  };
  Table table{
    name,
    fmt::format(
      "Envelopes, Hoek–Brown and Mohr–Coulomb: parameters ± half of the 95 % interval, stresses in MPa; fitted strengths "
      "with their deviation from the measured ones, UCS {} and σ_t {}",
      stress(measured.uniaxial_compressive_strength, 1), stress(measured.tensile_strength, 2)),
    {"form", "σ_ci", "m", "s", "a", "R²", "RMS", "fitted UCS", "fitted σ_t", "admissible"},
    {}};
  for (const auto& pair : envelopes.hoek_brown)
    for (const auto* answer : {&pair.with_tension_point, &pair.without_tension_point})
      {
        const std::string form =
          fmt::format("{}, {} σ_t", pair.form == HoekBrownForm::as_paper ? "as the paper" : feldspar::name(pair.form),
                      answer == &pair.with_tension_point ? "with" : "without");
        if (!answer->fit)
          {
            table.rows.push_back({form, "no fit: " + answer->reason, "", "", "", "", "", "", "", ""});
            continue;
          }
        const HoekBrownFit& fit = *answer->fit;
        table.rows.push_back(
          {form, estimate(fit.sigma_ci, mega, 1), estimate(fit.m, 1.0, 1), estimate(fit.s, 1.0, 2),
           estimate(fit.a, 1.0, 3), number(fit.quality.r_squared, 1.0, 4),
           number(fit.quality.root_mean_square / mega, 1),
           estimate(fit.uniaxial_compressive_strength, mega, 1) +
             beside(fit.uniaxial_compressive_strength.value, measured.uniaxial_compressive_strength),
           number(-fit.tensile_cut_off.value / mega, 2) + beside(-fit.tensile_cut_off.value, measured.tensile_strength),
           fit.s.value > 1.0005 ? "✗ s > 1" : "✓"});
      }
  if (const auto& fit = envelopes.mohr_coulomb.fit)
    table.rows.push_back({"Mohr–Coulomb", none, none, none, none, number(fit->quality.r_squared, 1.0, 4),
                          number(fit->quality.root_mean_square / mega, 1),
                          estimate(fit->uniaxial_strength, mega, 1) +
                            beside(fit->uniaxial_strength.value, measured.uniaxial_compressive_strength),
                          none, "✓"});
  else
    table.rows.push_back({"Mohr–Coulomb", "no fit: " + envelopes.mohr_coulomb.reason, "", "", "", "", "", "", "", ""});
  return table;
}

Table residual_table(const StrengthEnvelopes& envelopes, const std::string& name)
{
  Table table{name, "Residuals: σ₁ of each point less that of the envelope [MPa]", {"σ₃ [MPa]", "σ₁ [MPa]"}, {}};
  std::map<std::pair<double, double>, std::map<std::size_t, double>> residuals;
  std::size_t n_fits = 0;
  for (const auto& record : records(envelopes))
    {
      if (!record.reason.empty())
        continue;
      std::string heading = record.form + (record.variant.empty() ? "" : ", " + record.variant);
      std::replace(heading.begin(), heading.end(), '_', ' ');
      table.header.push_back(heading);
      for (const auto& [point, residual] : record.residuals)
        residuals[{point.sigma_3, point.sigma_1}][n_fits] = residual;
      ++n_fits;
    }
  for (const auto& [point, of_fits] : residuals)
    {
      std::vector<std::string> row{number(point.first / mega, 2), number(point.second / mega, 1)};
      for (std::size_t k = 0; k < n_fits; ++k)
        row.push_back(of_fits.contains(k) ? number(of_fits.at(k) / mega, 1) : none);
      table.rows.push_back(row);
    }
  return table;
}

/// "" of a single series, else something that tells the files of the series apart.
std::string of_series(const Findings& findings, const std::size_t n)
{
  return findings.all.size() > 1 ? fmt::format("_{}_{}", n + 1, plot::file_name(findings.all[n].label)) : "";
}

/// Draws everything and puts it where it belongs.
class PictureBook
{
public:
  /// Where the pictures go is filled in later: sections keep places.
  std::vector<PagePicture> keep(std::vector<Picture> pictures)
  {
    std::vector<PagePicture> places;
    for (auto& picture : pictures)
      {
        while (is_taken(picture.name)) // labels that differ in signs alone make the same name
          picture.name += "_again";
        places.push_back({picture, ""});
        all.push_back(std::move(picture));
      }
    return places;
  }

  /// Pictures that go to files only.
  void keep_as_files(std::vector<Picture> pictures)
  {
    for (auto& picture : pictures)
      if (!is_taken(picture.name))
        all.push_back(std::move(picture));
  }

  void draw_into(const std::filesystem::path& folder, Page& page)
  {
    const auto problems = draw(all, folder);
    std::map<std::string, std::string> problem_of;
    for (std::size_t k = 0; k < all.size(); ++k)
      problem_of[all[k].name] = problems[k];
    for (auto& section : page.sections)
      for (auto& block : section.blocks)
        for (auto& picture : block.pictures)
          picture.problem = problem_of[picture.picture.name];
    const auto first = std::find_if(problems.begin(), problems.end(), [](const auto& text) { return !text.empty(); });
    if (first != problems.end())
      missing = *first;
  }

  std::string missing; ///< why the first picture that is missing is
private:
  bool is_taken(const std::string& name) const
  {
    return std::any_of(all.begin(), all.end(), [&](const Picture& other) { return other.name == name; });
  }

  std::vector<Picture> all;
};

/// Whether an envelope that another source prints meets its own uniaxial tests; empty if there is none.
std::string remark_on_printed(const ReferenceSource& source)
{
  const auto measured = source.find("uniaxial_compressive_strength_MPa");
  if (!source.envelope || !measured)
    return "";
  const double fitted = source.envelope->sigma_1(0.0) / mega;
  std::string text = fmt::format(
    "{}: the printed envelope has s = {:.2f} and says {:.0f} MPa at σ₃ = 0, where its own tests gave {:.0f} MPa",
    source.label, source.envelope->s, fitted, measured->mean);
  if (source.envelope->s > 1.0)
    text += ": with s > 1 the strength σ_ci·sᵃ at σ₃ = 0 exceeds σ_ci";
  return text + ".";
}

PageSection envelope_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"envelope", "Envelope", "Strength envelope", {}};
  if (auto combined = combined_envelope_picture(findings.all, findings.envelopes, findings.reference);
      !combined.empty())
    {
      PageBlock together;
      together.pictures = book.keep(std::move(combined));
      section.blocks.push_back(together);
    }
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      if (findings.all[n].kind == SeriesKind::laboratory_curve)
        continue;
      PageBlock block = block_of(findings, n);
      const StrengthEnvelopes& envelopes = findings.envelopes[n];
      if (envelopes.data.points.empty())
        {
          block.paragraphs.push_back("No compression test of this series has a strength, so there is no envelope.");
          section.blocks.push_back(block);
          continue;
        }
      block.paragraphs.push_back(with_symbols(remark(envelopes)));
      if (n == 0 && findings.reference)
        if (const std::string printed = remark_on_printed(findings.reference->model); !printed.empty())
          block.paragraphs.push_back(printed);
      block.pictures = book.keep(envelope_pictures(findings.all, n, envelopes, findings.reference));
      section.blocks.push_back(block);
      PageBlock figures;
      figures.tables.push_back(fit_table(envelopes, "envelopes" + of_series(findings, n)));
      if (const auto& fit = envelopes.mohr_coulomb.fit)
        figures.paragraphs.push_back(fmt::format("Mohr–Coulomb: friction angle {}°, cohesion {} MPa.",
                                                 estimate(fit->friction_angle, std::numbers::pi / 180.0, 1),
                                                 estimate(fit->cohesion, mega, 1)));
      figures.paragraphs.push_back(
        "“As the paper” and “general” are one family of curves in two parametrisations, so they are drawn as one. "
        "“With σ_t” counts the tensile strength as a point at σ₃ = −σ_t, σ₁ = 0.");
      section.blocks.push_back(figures);
      PageBlock residuals;
      residuals.folded = "Residual of every point" + (findings.all.size() > 1 ? ", " + findings.all[n].label : "");
      residuals.pictures = book.keep(residual_picture(findings.all[n], envelopes));
      residuals.tables.push_back(residual_table(envelopes, "residuals" + of_series(findings, n)));
      if (!residuals.pictures.empty())
        section.blocks.push_back(residuals);
    }
  return section;
}

PageSection curve_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"curves", "Curves", "Curves", {}};
  for (auto& group : curve_pictures(findings.all))
    if (group.on_page)
      {
        PageBlock block;
        block.subheading = group.title;
        block.pictures = book.keep(std::move(group.pictures));
        section.blocks.push_back(block);
      }
    else
      book.keep_as_files(std::move(group.pictures));
  PageBlock remark_below;
  remark_below.paragraphs.push_back(
    section.blocks.empty()
      ? std::string("No test of these series has a curve.")
      : fmt::format("Of the confinements the lowest and the highest are shown; the others are in {}/.",
                    result_file::figures));
  section.blocks.push_back(remark_below);
  return section;
}

PageSection crack_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"cracks", "Cracks", "Cracks", {}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      const Series& series = findings.all[n];
      if (series.kind == SeriesKind::laboratory_curve)
        continue;
      PageBlock block = block_of(findings, n);
      std::vector<Picture> maps;
      std::vector<Picture> fragments;
      for (const auto& group : shown(groups_of(series)))
        if (const auto* test = typical(group))
          {
            const std::string title = group.title() + (findings.all.size() > 1 ? ", " + series.label : "");
            append(maps, crack_map(*test, title));
            append(maps, space_picture(*test, title));
            append(fragments, fragment_map(*test, title));
          }
      if (!findings.one_folder)
        for (auto* pictures : {&maps, &fragments})
          for (auto& picture : *pictures)
            picture.name += of_series(findings, n);
      if (maps.empty())
        block.paragraphs.push_back(
          series.kind == SeriesKind::finite_elements
            ? "No crack map: there are no cracks, or no test with a peak, in this result folder."
            : "No crack map: the positions of the grains, or a test with a peak, are missing in this result folder.");
      block.pictures = book.keep(std::move(maps));
      append(block.pictures, book.keep(rose_picture(series)));
      append(block.pictures, book.keep(std::move(fragments)));
      append(block.pictures, book.keep(fragment_size_picture(series)));
      section.blocks.push_back(block);
    }
  PageBlock together;
  together.pictures = book.keep(shear_share_picture(findings.all));
  if (!together.pictures.empty())
    section.blocks.push_back(together);
  return section;
}

/// Where the volumes that are drawn stand, with what broke in them.
std::vector<Table> volume_tables(const FinishedTest& test, const std::string& title, const std::string& ending)
{
  if (test.volumes.empty())
    return {};
  Table table{"volumes_" + test.name + ending,
              fmt::format("{}, seed {}: the volumes that are drawn; feldspar multiscale FOLDER --extract CELL:POINT "
                          "writes these or any other for ParaView and for feldspar rve",
                          title, test.record.seed),
              {"volume", "where", "cell:point", "broken segments", "of all [%]", "in shear"},
              {}};
  for (std::size_t k = 0; k < test.volumes.size(); ++k)
    {
      const PointVolume& volume = test.volumes[k];
      const auto n_shear = std::count_if(volume.cracks.begin(), volume.cracks.end(),
                                         [](const Crack& crack) { return crack.kind == CrackKind::shear; });
      table.rows.push_back({fmt::format("{}, {}", letter_of_volume(k), volume.which), standing_of(volume, test.fields),
                            volume.place(), fmt::format("{}", volume.cracks.size()),
                            number(100.0 * broken_share(volume), 2), fmt::format("{}", n_shear)});
    }
  return {table};
}

/// The test of a group that has most to show.
const FinishedTest* with_fields(const TestGroup& group)
{
  if (const auto* test = typical(group))
    return test;
  const auto found = std::find_if(group.tests.begin(), group.tests.end(),
                                  [](const FinishedTest* test) { return !test->fields.nodes.empty(); });
  return found == group.tests.end() ? nullptr : *found;
}

/// What of a sample of finite elements at the end of a test is shown; one of no grains has none of it.
PageSection sample_section(const Findings& findings, PictureBook& book)
{
  PageSection section{"sample", "Sample", "The sample at its end", {}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      const Series& series = findings.all[n];
      if (series.kind != SeriesKind::finite_elements)
        continue;
      std::vector<const FinishedTest*> on_page;
      for (const auto& group : shown(groups_of(series)))
        if (const auto* test = with_fields(group))
          on_page.push_back(test);
      PageBlock heading = block_of(findings, n);
      std::vector<PageBlock> blocks;
      for (const auto& group : groups_of(series))
        for (const auto* test : group.tests)
          {
            const std::string title = group.title() + (findings.all.size() > 1 ? ", " + series.label : "");
            const auto named = [&](std::vector<Picture> pictures) {
              if (!findings.one_folder)
                for (auto& picture : pictures)
                  picture.name += of_series(findings, n);
              return pictures;
            };
            std::vector<Picture> sample = named(sample_picture(*test, title));
            std::vector<Picture> volumes = named(volume_picture(*test, title));
            if (std::find(on_page.begin(), on_page.end(), test) == on_page.end())
              {
                if (findings.one_folder)
                  for (auto* pictures : {&sample, &volumes})
                    book.keep_as_files(std::move(*pictures));
                continue;
              }
            PageBlock block;
            block.subheading = title;
            block.pictures = book.keep(std::move(sample));
            append(block.pictures, book.keep(std::move(volumes)));
            if (block.pictures.empty())
              continue;
            block.tables = volume_tables(*test, title, findings.one_folder ? "" : of_series(findings, n));
            if (test->volumes.empty())
              block.paragraphs.push_back("The grains of single volumes are not in this result folder: it is of before "
                                         "they were kept, or the test did not come to its end.");
            blocks.push_back(block);
          }
      if (blocks.empty())
        heading.paragraphs.push_back(
          "No picture of the sample: its fields are missing in this result folder, or it has "
          "no grains.");
      if (!heading.subheading.empty() || !heading.paragraphs.empty())
        section.blocks.push_back(heading);
      append(section.blocks, std::move(blocks));
    }
  return section;
}

Table strength_table(const Findings& findings)
{
  Table table{"strengths",
              "Strengths of every kind of test [MPa]",
              {"test", "series", "n", "mean ± s.d.", "95 % of the mean", "shear share of cracks at the peak [%]",
               "deviator at the end over peak"},
              {}};
  for (const auto& series : findings.all)
    for (const auto& group : groups_of(series))
      {
        const auto over_seeds = [&](Figure TestResults::*figure, const double unit, const int decimals) {
          const auto found = statistics(values(group, figure));
          return found ? deviation_text(*found, unit, decimals) : none;
        };
        const auto strength = statistics(values(group, &TestResults::peak_stress));
        const int decimals = group.kind == TestKind::direct_tension || group.kind == TestKind::brazilian ? 2 : 1;
        table.rows.push_back({group.title(), series.label, fmt::format("{}", strength ? strength->n : 0),
                              over_seeds(&TestResults::peak_stress, mega, decimals),
                              strength ? interval_text(*strength, mega, decimals) : none,
                              over_seeds(&TestResults::shear_share_at_peak, 1e-2, 1),
                              over_seeds(&TestResults::residual_deviator_ratio, 1.0, 2)});
      }
  return table;
}

/// Every figure of every test in SI; the page shows the most wanted, the file has all.
Table test_table(const Findings& findings, const bool all_figures)
{
  static const std::set<std::string_view> wanted{"peak_stress_Pa",
                                                 "strain_at_peak",
                                                 "youngs_modulus_tangent_Pa",
                                                 "youngs_modulus_initial_Pa",
                                                 "poissons_ratio_initial",
                                                 "crack_initiation_stress_Pa",
                                                 "crack_damage_stress_Pa",
                                                 "n_tension_cracks",
                                                 "n_shear_cracks",
                                                 "energy_imbalance_over_work",
                                                 "wall_time_s"};
  Table table{"tests", "Every test, SI; the file has every figure of summary.json", {"test", "series", "seed"}, {}};
  for (const auto& entry : result_table())
    if (all_figures || wanted.contains(entry.name))
      table.header.emplace_back(entry.name);
  for (const auto& series : findings.all)
    for (const auto& test : series.tests)
      {
        std::vector<std::string> row{test.name, series.label, fmt::format("{}", test.record.seed)};
        for (const auto& entry : result_table())
          if (all_figures || wanted.contains(entry.name))
            {
              const Figure figure = entry.value(test);
              row.push_back(!figure.value ? (all_figures ? "" : none)
                                          : fmt::format("{:.{}g}", *figure.value, all_figures ? 10 : 4));
            }
        table.rows.push_back(row);
      }
  return table;
}

PageSection trust_section(const Findings& findings)
{
  PageSection section{"trust", "Trust", "How far to trust it", {}};
  for (std::size_t n = 0; n < findings.all.size(); ++n)
    {
      const Series& series = findings.all[n];
      PageBlock block = block_of(findings, n);
      if (series.kind == SeriesKind::laboratory_curve)
        {
          block.paragraphs.push_back("Measured on rock; there is nothing of ours to be checked.");
          section.blocks.push_back(block);
          continue;
        }
      Table checks{"trust" + of_series(findings, n),
                   "Checks over all tests",
                   {"measure", "bound", "mean", "worst", "within"},
                   {}};
      for (const auto& check : trust_checks(series))
        checks.rows.push_back({check.measure, check.bound, check.mean, check.worst,
                               check.n_out == 0 ? fmt::format("✓ all {}", check.n_tests)
                                                : fmt::format("✗ {} of {} out", check.n_out, check.n_tests)});
      if (series.kind == SeriesKind::finite_elements)
        block.paragraphs.push_back("Each row of a curve is an equilibrium, found without time: there is no kinetic "
                                   "energy, no wave and no servo to be checked.");
      block.tables.push_back(checks);
      if (std::any_of(series.tests.begin(), series.tests.end(),
                      [](const FinishedTest& test) { return test.record.specimen.n_grains > 0; }))
        {
          Table specimens = specimen_table(series);
          specimens.name += of_series(findings, n);
          block.tables.push_back(specimens);
        }
      const auto& made_by = series.made_by;
      block.paragraphs.push_back(fmt::format("Made by feldspar {}{} from {} on {}, {} thread{}.",
                                             made_by.version.empty() ? "of unknown version" : made_by.version,
                                             made_by.commit.empty() ? "" : ", commit " + made_by.commit,
                                             made_by.input_file.empty() ? "an unknown input" : made_by.input_file,
                                             made_by.processor.empty() ? "an unknown processor" : made_by.processor,
                                             made_by.n_threads, made_by.n_threads == 1 ? "" : "s"));
      section.blocks.push_back(block);
      Table input{"input" + of_series(findings, n), "Input as it was understood", {"section", "entry", "value"}, {}};
      for (const auto& entry : made_by.input)
        input.rows.push_back({entry.section, entry.entry, entry.value});
      PageBlock echo;
      echo.folded = "Input" + (findings.all.size() > 1 ? ", " + series.label : "");
      echo.tables.push_back(input);
      section.blocks.push_back(echo);
    }
  PageBlock tests;
  tests.folded = "Every test";
  tests.tables = {strength_table(findings), test_table(findings, false)};
  section.blocks.push_back(tests);
  return section;
}

/// Labels are names of folders and files, which may be anything: as they are shown, on one line and not long. They tell
/// series apart; the same ones are numbered.
std::vector<Series> with_labels_to_show(std::vector<Series> all)
{
  constexpr std::size_t most_characters = 120; // a variant of two entries
  std::set<std::string> taken;
  for (auto& series : all)
    {
      const std::string label = excerpt(series.label, most_characters);
      series.label = label;
      for (int n = 2; !taken.insert(series.label).second; ++n)
        series.label = fmt::format("{} ({})", label, n);
    }
  return all;
}
} // namespace

std::vector<std::string> write_report(const ReportInput& input, const std::filesystem::path& folder)
{
  const std::vector<Series> all = with_labels_to_show(input.all);
  Findings findings{all, input.reference, input.reference_problem, input.one_folder, {}, {}};
  for (const auto& series : all)
    {
      findings.comparisons.push_back(compare(series.tests, input.reference));
      findings.envelopes.push_back(fit_strength_envelopes(strength_data(series.tests)));
    }

  PictureBook book;
  Page page;
  page.title = input.reference && !input.reference->rock.empty()
                 ? input.reference->rock.substr(0, input.reference->rock.find_first_of(":;"))
                 : "Rock";
  page.title += ": model and rock";
  std::size_t n_tests = 0;
  for (const auto& series : all)
    n_tests += series.tests.size();
  page.subtitle =
    fmt::format("Feldspar report of {} test{} in {} series.", n_tests, n_tests == 1 ? "" : "s", all.size());
  page.sections = {verdict_section(findings), envelope_section(findings, book), curve_section(findings, book)};
  if (PageSection sample = sample_section(findings, book); !sample.blocks.empty())
    page.sections.push_back(std::move(sample));
  append(page.sections, {crack_section(findings, book), trust_section(findings)});

  if (input.one_folder)
    for (const auto& series : all)
      {
        book.keep_as_files(single_test_pictures(series));
        if (&series == &all.front())
          book.keep_as_files(overview_picture(series));
      }

  std::filesystem::create_directories(folder / result_file::figures);
  std::filesystem::create_directories(folder / result_file::tables);
  book.draw_into(folder / result_file::figures, page);
  if (!book.missing.empty())
    page.sections.front().blocks.front().warnings.push_back("Pictures are missing: " + book.missing);
  for (const auto& section : page.sections)
    for (const auto& block : section.blocks)
      for (const auto& table : block.tables)
        write_whole_file(folder / result_file::tables / (table.name + ".csv"),
                         as_csv(table.name == "tests" ? test_table(findings, true) : table));
  write_page(page, folder / result_file::page, folder / result_file::figures);

  std::vector<std::string> missing;
  for (const auto& series : all)
    missing.insert(missing.end(), series.problems.begin(), series.problems.end());
  for (const auto& problem : {input.reference_problem, book.missing})
    if (!problem.empty())
      missing.push_back(problem);
  return missing;
}
} // namespace feldspar
