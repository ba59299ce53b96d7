#include "report/report.h"

#include "base/append.h"
#include "base/quoted.h"
#include "base/whole_file.h"
#include "report/pictures/figures.h"
#include "report/sections/provenance.h"
#include "report/sections/sections.h"
#include "results/folder/result_folder.h"
#include "results/runs/bodies.h"
#include "results/runs/repeats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <set>
#include <utility>

namespace feldspar
{
namespace
{
/// Numbers a name that is taken, by a pattern of the name and the number.
std::string made_unique(const std::string& name, const char* pattern, std::set<std::string>& taken)
{
  std::string unique = name;
  for (int n = 2; !taken.insert(unique).second; ++n)
    unique = fmt::format(fmt::runtime(pattern), name, n);
  return unique;
}

/// Labels are titles of runs, or names of folders and files, which may be anything: as they are shown, on one line and not
/// long. They tell series apart; the same ones are numbered. The key of a series alone is its kind. So are the names of measured curves, by which their pictures are called: files
/// of several folders may have one name, or that of a test of the model.
std::vector<Series> with_labels_to_show(std::vector<Series> all)
{
  constexpr std::size_t most_characters = 120; // a variant of two entries
  std::set<std::string> labels;
  std::set<std::string> names;
  for (auto& series : all)
    {
      // A variant is told by its entries.
      const std::string title = series.made_by.label_of(input_entries::report_title);
      const bool is_titled = !title.empty() && !series.tests.empty() && series.tests.front().variant.empty();
      series.label = made_unique(excerpt(is_titled ? title : series.label, most_characters), "{} ({})", labels);
      if (all.size() == 1 && !is_titled && series.kind != SeriesKind::laboratory_curve)
        series.key_if_alone = series.kind == SeriesKind::specimens ? "specimens" : "sample";
      if (series.kind != SeriesKind::laboratory_curve)
        for (const auto& test : series.tests)
          names.insert(test.name);
    }
  for (auto& series : all)
    if (series.kind == SeriesKind::laboratory_curve)
      for (auto& test : series.tests)
        test.name = made_unique(test.name, "{}_{}", names);
  return all;
}

/// Series with pictures where there are more series than a page has room for; otherwise none.
std::vector<Series> pictured_of_many(const std::vector<Series>& all)
{
  std::vector<Series> pictured;
  if (all.size() > most_series_in_full)
    for (std::size_t n = 0; n < all.size(); ++n)
      if (n < most_series_in_full || all[n].kind == SeriesKind::laboratory_curve)
        pictured.push_back(all[n]);
  return pictured;
}

Findings findings_of(const std::vector<Series>& all, const std::vector<Series>& pictured_of_many,
                     const ReportInput& input)
{
  Findings findings{all,
                    pictured_of_many.empty() ? all : pictured_of_many,
                    input.reference,
                    input.reference_problem,
                    input.one_folder,
                    {},
                    input.envelopes,
                    {},
                    input.calibration ? &*input.calibration : nullptr,
                    input.catalogues};
  if (input.one_folder) // of several folders the same variant may come twice
    {
      std::vector<const FinishedTest*> tests;
      for (const auto& series : all)
        for (const auto& test : series.tests)
          tests.push_back(&test);
      findings.repeats = remarks_on_repeats(tests);
    }
  const bool any_flaws = any_has_flaws(all);
  for (const auto& series : all)
    findings.comparisons.push_back(compare(
      series.tests, input.reference, input.calibration ? input.calibration->elastic : ElasticFigures(), any_flaws));
  return findings;
}

/// The picture that ranks highest, the first of its rank, taken out of its place; none where all rank 0.
std::vector<PagePicture> taken_out(std::vector<PageSection>& sections,
                                   const std::function<std::size_t(const Picture&)>& rank)
{
  std::vector<PagePicture>* where = nullptr;
  std::vector<PagePicture>::iterator which;
  std::size_t highest = 0;
  for (PageSection& section : sections)
    for (PageBlock& block : section.blocks)
      for (auto one = block.pictures.begin(); one != block.pictures.end(); ++one)
        if (const std::size_t its_rank = rank(one->picture); its_rank > highest)
          {
            where = &block.pictures;
            which = one;
            highest = its_rank;
          }
  if (where == nullptr)
    return {};
  std::vector<PagePicture> taken{std::move(*which)};
  where->erase(which);
  return taken;
}

/// Rank of the specimens that the viewer shows: by what there is to see.
std::size_t rank_of_specimen(const Picture& picture)
{
  return picture.name.find("_cracks") == std::string::npos ? 0 : picture.story.size();
}

/// Rank of a sample of finite elements, which stands where there is no specimen: one that was pressed first.
std::size_t rank_of_sample(const Picture& picture)
{
  return !picture.name.ends_with("_sample") ? 0 : picture.name.starts_with("uniaxial_compression") ? 2 : 1;
}

/// Rank of the picture beside the specimen: the strengths with one fit, else any curve.
std::size_t rank_of_answer(const Picture& picture)
{
  return picture.name == "envelopes" ? 2 : picture.story.empty() ? 1 : 0;
}

/// Rank of the curves below it: those with a measured one, then of all confinements, else those without confinement.
std::size_t rank_of_curves(const Picture& picture, const std::vector<Series>& all)
{
  const auto shows = [&](const Series& series) {
    return series.kind == SeriesKind::laboratory_curve && std::ranges::any_of(picture.panels, [&](const Chart& panel) {
             return std::ranges::any_of(panel.series,
                                        [&](const ChartSeries& one) { return one.label.starts_with(series.label); });
           });
  };
  return picture.name.ends_with("_stress") && std::ranges::any_of(all, shows) ? 4
         : picture.name.starts_with("compression_")                           ? 3
         : picture.name == "uniaxial_compression_stress"                      ? 2
         : picture.name.ends_with("_stress")                                  ? 1
                                                                              : 0;
}

/// Name of a rock in a title, from its name in a reference.
std::string rock_in_title(const std::string& rock)
{
  return rock.empty() ? "Rock" : rock.substr(0, rock.find_first_of(":;"));
}

/// Puts the user's texts into the head of a page.
void set_labels(Page& page, const Provenance& made_by, const std::string& rock)
{
  if (const std::string title = made_by.label_of(input_entries::report_title); !title.empty())
    page.title = title;
  page.labels = labels_of(made_by);
  page.paper_head = paper_head_of(made_by, rock);
}

/// The page without its pictures, which the book draws later.
Page page_of(const Findings& findings, PictureBook& book)
{
  Page page;
  const std::string rock = rock_in_title(findings.reference ? findings.reference->rock : "");
  page.title = rock + ": model and rock";
  if (findings.one_folder)
    set_labels(page, findings.all.front().made_by, findings.reference ? rock : "");
  std::size_t n_tests = 0;
  for (const auto& series : findings.all)
    n_tests += series.tests.size();
  page.subtitle =
    fmt::format("Feldspar report of {} test{} in {} series.", n_tests, n_tests == 1 ? "" : "s", findings.all.size());
  page.prints_folded = !findings.is_study() && !findings.has_many();
  page.sections.push_back(verdict_section(findings));
  page.sections.push_back(envelope_section(findings, book));
  page.sections.push_back(curve_section(findings, book));
  if (PageSection sample = sample_section(findings, book); !sample.blocks.empty())
    page.sections.push_back(std::move(sample));
  page.sections.push_back(crack_section(findings, book));
  page.sections.push_back(trust_section(findings));
  PageSection study = study_section(findings, book);
  const bool is_first = !study.blocks.empty() && !study.blocks.front().lead.empty(); // else it has warnings alone
  if (findings.has_many())
    {
      for (std::size_t k = 1; k + 1 < page.sections.size(); ++k)
        if (std::ranges::any_of(page.sections[k].blocks,
                                [](const PageBlock& block) { return !block.pictures.empty(); }))
          page.sections[k].folded = fmt::format("The first {} series, one by one", most_series_in_full);
    }
  else if (!is_first) // the key of many curves would push the tables off the first screen
    {
      std::vector<PagePicture>& lead = page.sections.front().blocks.front().lead;
      lead = taken_out(page.sections, rank_of_specimen);
      if (lead.empty())
        lead = taken_out(page.sections, rank_of_sample);
      if (const bool is_sample = !lead.empty() && lead.front().picture.story.empty(); !is_sample)
        append(lead, taken_out(page.sections, rank_of_answer));
      append(lead,
             taken_out(page.sections, [&](const Picture& picture) { return rank_of_curves(picture, findings.all); }));
    }
  // A page begins with what its run was made for.
  if (!study.blocks.empty())
    page.sections.insert(page.sections.begin() + (is_first ? 0 : 1), std::move(study));
  if (findings.calibration)
    page.sections.insert(page.sections.begin(), calibration_section(*findings.calibration, book));
  return page;
}

void write_tables(const Page& page, const std::filesystem::path& folder)
{
  for (const auto& section : page.sections)
    for (const auto& block : section.blocks)
      for (const auto* tables : {&block.tables, &block.tables_as_files})
        for (const auto& table : *tables)
          write_whole_file(folder / (table.name + ".csv"), as_csv(table));
}

/// Draws, and writes the page with its tables. Returns why a picture is missing; empty if none is.
std::string write_files(Page& page, const PictureBook& book, const std::filesystem::path& folder,
                        const DrawingWatch& watch)
{
  const std::filesystem::path figures = folder / result_file::figures;
  std::filesystem::create_directories(figures);
  std::filesystem::create_directories(folder / result_file::tables);
  const std::string not_drawn = book.draw_into(figures, page, watch);
  if (!not_drawn.empty())
    page.sections.front().blocks.front().warnings.push_back("Pictures are missing: " + not_drawn);
  write_tables(page, folder / result_file::tables);
  write_page(page, folder / result_file::page, figures);
  return not_drawn;
}
} // namespace

std::vector<std::string> write_report(const ReportInput& input, const std::filesystem::path& folder,
                                      const DrawingWatch& watch)
{
  const std::vector<Series> all = with_labels_to_show(input.all);
  const std::vector<Series> pictured = pictured_of_many(all);
  const Findings findings = findings_of(all, pictured, input);
  PictureBook book;
  Page page = page_of(findings, book);
  for (const auto& series : all)
    if (input.one_folder)
      book.keep_as_files(single_test_pictures(series));
  const std::string not_drawn = write_files(page, book, folder, watch);

  std::vector<std::string> missing;
  for (const auto& series : all)
    append(missing, series.problems);
  append(missing, gap_remarks(all));
  append(missing, findings.repeats);
  for (const auto& problem : {input.reference_problem, not_drawn})
    if (!problem.empty())
      missing.push_back(problem);
  return missing;
}

std::vector<std::string> write_report(const CalibrationRecord& calibration, const std::filesystem::path& folder,
                                      const DrawingWatch& watch)
{
  PictureBook book;
  const std::string rock = rock_in_title(calibration.rock);
  Page page{.title = rock + ": calibration",
            .subtitle = "Feldspar report of a calibration without tests of its answer.",
            .sections = {calibration_section(calibration, book)}};
  set_labels(page, calibration.made_by, rock);
  const std::string not_drawn = write_files(page, book, folder, watch);
  return not_drawn.empty() ? std::vector<std::string>() : std::vector{not_drawn};
}
} // namespace feldspar
