#include "report/page/page.h"

#include "base/mapped.h"
#include "base/readable_file.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "report/chart/page_writer.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>
#include <kainjow/mustache.hpp>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string_view>

namespace feldspar
{
extern const std::string_view page_template;   // report/page/page.html
extern const std::string_view figure_template; // report/page/figure.html
extern const std::string_view page_script;     // third_party/*/*.js, report/page/viewer.js and page.js
extern const std::string_view script_sha_256;  // of it, hexadecimal

namespace
{
using kainjow::mustache::data;
using kainjow::mustache::object;
using live::base64;

constexpr int wide_picture = 900; // from here on a picture takes the width of the page [px]

/// Hash by which a policy names the one script that may run: no other does, whatever text comes into the page.
std::string hash_of_script()
{
  std::string bytes;
  for (std::size_t k = 0; k + 1 < script_sha_256.size(); k += 2)
    bytes += char(std::stoi(std::string(script_sha_256.substr(k, 2)), nullptr, 16));
  return "sha256-" + base64(bytes);
}

data list(const std::vector<std::string>& texts) { return mapped<data>(texts, std::identity()); }

data unless_empty(const std::string& text) { return text.empty() ? data(false) : data(text); }

/// Columns that say something; the files have all.
std::vector<std::size_t> columns_with_contents(const Table& table)
{
  std::vector<std::size_t> columns;
  for (std::size_t c = 1; c < table.header.size(); ++c)
    if (std::ranges::any_of(table.rows, [c](const std::vector<std::string>& row) {
          return c < row.size() && !row[c].empty() && row[c] != "–";
        }))
      columns.push_back(c);
  return columns;
}

/// Class of a cell, by which it is shown: a verdict in its colour, a sentence in lines.
std::string class_of(const std::string& cell)
{
  constexpr std::size_t longest_figure = 40; // in bytes: "1234.5 ± 12.3 (−10.1 %)"
  std::string name = cell.starts_with("✗")   ? "bad"
                     : cell.starts_with("✓") ? "good"
                     : cell.starts_with("?") ? "not-decided"
                                             : "";
  if (cell.size() > longest_figure)
    name += name.empty() ? "words" : " words";
  return name;
}

data describe(const Table& table)
{
  const std::vector<std::size_t> columns = columns_with_contents(table);
  std::vector<std::string> header{table.header.front()};
  for (const std::size_t c : columns)
    header.push_back(table.header[c]);
  const auto rows = mapped<data>(table.rows, [&](const std::vector<std::string>& row) {
    kainjow::mustache::list cells;
    for (const std::size_t c : columns)
      if (c < row.size())
        cells.push_back(object{{"text", row[c]}, {"class", unless_empty(class_of(row[c]))}});
    return object{{"heading", row.front()}, {"cells", cells}};
  });
  // The table is in the page itself: a link into its folder would be lost where it is mailed.
  return object{{"id", "table_" + table.name},
                {"caption", table.caption},
                {"csv", "data:text/csv;charset=utf-8;base64," + base64(as_csv(table))},
                {"file", table.name + ".csv"},
                {"header", list(header)},
                {"rows", rows}};
}

/// Keeps the page within its size.
struct PictureShelf
{
  const std::filesystem::path& folder; ///< of the figures
  std::size_t most_picture_bytes;      ///< of pictures whose data stand on the page
  std::size_t most_pdf_bytes;          ///< of their files in PDF
  std::size_t n_bytes = 0;
  std::size_t n_pdf_bytes = 0;

  data describe(const PagePicture& shown)
  {
    const Picture& picture = shown.picture;
    std::string problem = shown.problem;
    std::string source;
    if (problem.empty())
      {
        const std::string in_base64 = encoded(picture.shown_file());
        if (in_base64.empty())
          problem = picture.shown_file() + " cannot be read";
        else if (n_bytes + in_base64.size() > most_picture_bytes)
          problem = "Left out to keep this page small: see " + file_of(picture.shown_file());
        else
          {
            n_bytes += in_base64.size();
            source = fmt::format("data:image/{};base64,{}", picture.raster ? "png" : "svg+xml", in_base64);
          }
      }
    kainjow::mustache::list files;
    for (const auto& [ending, is_there] :
         {std::pair("PNG", picture.raster), {"SVG", picture.vector}, {"PDF", picture.vector}})
      if (is_there && shown.problem.empty())
        {
          const std::string name = picture.name + "." + in_small_letters(ending);
          const bool is_shown = picture.shown_file() == name;
          const std::string pdf = name.ends_with(".pdf") ? pdf_in_page(name) : "";
          files.push_back(object{{"file", pdf.empty() ? file_of(name) : pdf},
                                 {"ending", ending},
                                 {"shown", is_shown},
                                 {"download", unless_empty(pdf.empty() ? "" : name)},
                                 {"beside", !is_shown && pdf.empty()}});
        }
    std::string live = picture.live();
    const bool has_room = n_bytes + live.size() <= most_picture_bytes;
    if (!has_room)
      live.clear();
    n_bytes += live.size();
    // The script draws a body for paper, too.
    return object{{"source", unless_empty(source)},
                  {"live", unless_empty(live)},
                  {picture.body.empty() || live.empty() ? "absent" : "without_script", unless_empty(problem)},
                  {"alternative", picture.alternative},
                  {"caption", picture.caption},
                  {"live_caption", unless_empty(has_room ? picture.live_caption : "")},
                  {"width", std::to_string(picture.width)},
                  {"height", std::to_string(picture.height)},
                  {"wide", picture.width >= wide_picture},
                  {"files", files}};
  }

  std::string file_of(const std::string& name) const { return folder.filename().string() + "/" + name; }

  /// A file of the folder, empty where it cannot be read.
  std::string encoded(const std::string& name) const
  {
    return objection_to_reading(folder / name).empty() ? base64(content_of(folder / name)) : "";
  }

  /// Returns the PDF as the target of a link, as long as there is room; otherwise nothing.
  std::string pdf_in_page(const std::string& name)
  {
    std::string target = n_pdf_bytes < most_pdf_bytes ? encoded(name) : "";
    if (target.empty() || n_pdf_bytes + target.size() > most_pdf_bytes)
      return "";
    n_pdf_bytes += target.size();
    return "data:application/pdf;base64," + target;
  }
};

data describe(const Tile& tile)
{
  // Class and sign of each mark.
  static constexpr std::pair<const char*, const char*> marks[] = {{"", ""},
                                                                  {"good", "✓"},
                                                                  {"bad", "✗"},
                                                                  {"not-decided", "?"}};
  const auto& [its_class, sign] = marks[std::size_t(tile.mark)];
  object result{{"property", tile.property},         {"value", tile.value},
                {"notes", unless_empty(tile.notes)}, {"n", fmt::format("{}", tile.n)},
                {"class", unless_empty(its_class)},  {"mark", unless_empty(sign)},
                {"has_bar", tile.low && tile.high}};
  if (!tile.low || !tile.high)
    return result;
  // The bar holds the range and the deviations, with room at both ends.
  const double low = std::min(*tile.low, tile.mean - tile.deviation);
  const double width = std::max(*tile.high, tile.mean + tile.deviation) - low;
  const auto place = [&](const double value) {
    return fmt::format("{:.1f}%", width > 0.0 ? 8.0 + 84.0 * (value - low) / width : 50.0);
  };
  const auto length = [&](const double value) {
    return fmt::format("{:.1f}%", width > 0.0 ? 84.0 * value / width : 0.0);
  };
  result.insert({{"range_at", place(*tile.low)},
                 {"range_width", length(*tile.high - *tile.low)},
                 {"deviation_at", place(tile.mean - tile.deviation)},
                 {"deviation_width", length(2.0 * tile.deviation)},
                 {"mean_at", place(tile.mean)}});
  return result;
}

data describe(const PageBlock& block, PictureShelf& shelf)
{
  const auto drawn = [&](const PagePicture& picture) { return shelf.describe(picture); };
  const auto figures = mapped<data>(block.pictures, drawn);
  const auto lead = mapped<data>(block.lead, drawn);
  const auto behind_first = lead.begin() + (lead.empty() ? 0 : 1);
  return object{{"folded", unless_empty(block.folded)},
                {"subheading", unless_empty(block.subheading)},
                {"chip", unless_empty(block.chip)},
                {"headline", unless_empty(block.headline)},
                {"paragraphs", list(block.paragraphs)},
                {"has_tiles", !block.tiles.empty()},
                {"tiles", mapped<data>(block.tiles, [](const Tile& tile) { return describe(tile); })},
                {"has_points", !block.points.empty()},
                {"points", list(block.points)},
                {"has_warnings", !block.warnings.empty()},
                {"warnings", list(block.warnings)},
                {"tables", mapped<data>(block.tables, [](const Table& table) { return describe(table); })},
                {"has_lead", !lead.empty()},
                {"beside", kainjow::mustache::list(lead.begin(), behind_first)},
                {"below", kainjow::mustache::list(behind_first, lead.end())},
                {"has_figures", !block.pictures.empty()},
                {"figures", figures}};
}

/// Renders a page with pictures, and with PDFs of them, of so many bytes at most.
std::string rendered(const Page& page, const std::filesystem::path& figures, const std::size_t room,
                     const std::size_t room_for_pdf)
{
  PictureShelf shelf{figures, room, room_for_pdf};
  const auto sections = mapped<data>(page.sections, [&](const PageSection& section) {
    return object{
      {"id", section.id},
      {"short_title", section.short_title},
      {"heading", section.heading},
      {"section_folded", unless_empty(section.folded)},
      {"blocks", mapped<data>(section.blocks, [&](const PageBlock& block) { return describe(block, shelf); })}};
  });
  const object whole{{"title", page.title},
                     {"subtitle", page.subtitle},
                     {"labels", unless_empty(page.labels)},
                     {"paper_head", unless_empty(page.paper_head)},
                     {"brief_on_paper", !page.prints_folded},
                     {"sections", sections},
                     {"script_hash", hash_of_script()},
                     {"script", std::string(page_script)},
                     {"figure", kainjow::mustache::partial([] { return std::string(figure_template); })}};

  kainjow::mustache::mustache filled{std::string(page_template)};
  if (!filled.is_valid())
    throw std::logic_error("report/page/page.html: " + filled.error_message());
  return filled.render(whole);
}
} // namespace

void write_page(const Page& page, const std::filesystem::path& file, const std::filesystem::path& figures,
                const std::size_t most_bytes)
{
  const auto left = [=](const std::size_t used) { return most_bytes - std::min(most_bytes, used); };
  const std::size_t for_pictures = left(rendered(page, figures, 0, 0).size());
  // Pictures come first; what they leave is for the files that a mailed page would else lose.
  const std::size_t for_pdf = left(rendered(page, figures, for_pictures, 0).size() + most_bytes / 100);
  write_whole_file(file, rendered(page, figures, for_pictures, for_pdf));
}
} // namespace feldspar
