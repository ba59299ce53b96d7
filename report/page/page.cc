#include "report/page/page.h"

#include "base/readable_file.h"
#include "base/whole_file.h"
#include "report/chart/page_writer.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>
#include <kainjow/mustache.hpp>

#include <algorithm>
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

data list(const std::vector<std::string>& texts)
{
  data result = data::type::list;
  for (const auto& text : texts)
    result << data(text);
  return result;
}

void set_unless_empty(data& object, const std::string& name, const std::string& text)
{
  object.set(name, text.empty() ? data(data::type::bool_false) : data(text));
}

/// Columns that say something; the files have all.
std::vector<std::size_t> columns_with_contents(const Table& table)
{
  std::vector<std::size_t> columns;
  for (std::size_t c = 1; c < table.header.size(); ++c)
    if (std::any_of(table.rows.begin(), table.rows.end(), [c](const std::vector<std::string>& row) {
          return c < row.size() && !row[c].empty() && row[c] != "–";
        }))
      columns.push_back(c);
  return columns;
}

/// Class of a cell, by which it is shown: a verdict in its colour, a sentence in lines.
std::string class_of(const std::string& cell)
{
  constexpr std::size_t longest_figure = 40; // in bytes: "1234.5 ± 12.3 (−10.1 %)"
  std::string name = cell.starts_with("✗") ? "bad" : cell.starts_with("✓") ? "good" : "";
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
  data rows = data::type::list;
  for (const auto& row : table.rows)
    {
      data cells = data::type::list;
      for (const std::size_t c : columns)
        {
          if (c >= row.size())
            break;
          data cell = data::type::object;
          cell.set("text", row[c]);
          set_unless_empty(cell, "class", class_of(row[c]));
          cells << cell;
        }
      data one = data::type::object;
      one.set("heading", row.front());
      one.set("cells", cells);
      rows << one;
    }
  data result = data::type::object;
  result.set("id", "table_" + table.name);
  result.set("caption", table.caption);
  // The table is in the page itself: a link into its folder would be lost where it is mailed.
  result.set("csv", "data:text/csv;charset=utf-8;base64," + base64(as_csv(table)));
  result.set("file", table.name + ".csv");
  result.set("header", list(header));
  result.set("rows", rows);
  return result;
}

/// Keeps the page within its size.
class PictureShelf
{
public:
  /// `room` limits the bytes of pictures whose data stand on the page, `room_for_pdf` those of their files in PDF.
  PictureShelf(const std::filesystem::path& figures, const std::size_t room, const std::size_t room_for_pdf)
    : folder(figures)
    , most_picture_bytes(room)
    , most_pdf_bytes(room_for_pdf)
  {
  }

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
    data files = data::type::list;
    for (const auto& [ending, is_there] :
         {std::pair("PNG", picture.raster), {"SVG", picture.vector}, {"PDF", picture.vector}})
      if (is_there && shown.problem.empty())
        {
          std::string small = ending;
          for (char& c : small)
            c = char(c - 'A' + 'a');
          const std::string name = picture.name + "." + small;
          const bool is_shown = picture.shown_file() == name;
          const std::string pdf = small == "pdf" ? pdf_in_page(name) : "";
          data file = data::type::object;
          file.set("file", pdf.empty() ? file_of(name) : pdf);
          file.set("ending", std::string(ending));
          file.set("shown", data(is_shown));
          set_unless_empty(file, "download", pdf.empty() ? "" : name);
          file.set("beside", data(!is_shown && pdf.empty()));
          files << file;
        }
    data result = data::type::object;
    set_unless_empty(result, "source", source);
    std::string live = picture.live();
    const bool has_room = n_bytes + live.size() <= most_picture_bytes;
    if (!has_room)
      live.clear();
    n_bytes += live.size();
    set_unless_empty(result, "live", live);
    // The script draws a body for paper, too.
    set_unless_empty(result, picture.body.empty() || live.empty() ? "absent" : "without_script", problem);
    result.set("alternative", picture.alternative);
    result.set("caption", picture.caption);
    set_unless_empty(result, "live_caption", has_room ? picture.live_caption : "");
    result.set("width", std::to_string(picture.width));
    result.set("height", std::to_string(picture.height));
    result.set("wide", data(picture.width >= wide_picture));
    result.set("files", files);
    return result;
  }

private:
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

  std::filesystem::path folder;
  std::size_t most_picture_bytes;
  std::size_t most_pdf_bytes;
  std::size_t n_bytes = 0;
  std::size_t n_pdf_bytes = 0;
};

data describe(const Tile& tile)
{
  data result = data::type::object;
  result.set("property", tile.property);
  result.set("value", tile.value);
  set_unless_empty(result, "notes", tile.notes);
  result.set("n", fmt::format("{}", tile.n));
  set_unless_empty(result, "class", !tile.in_range ? "" : *tile.in_range ? "good" : "bad");
  set_unless_empty(result, "mark", !tile.in_range ? "" : *tile.in_range ? "✓" : "✗");
  result.set("has_bar", data(tile.low && tile.high));
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
  result.set("range_at", place(*tile.low));
  result.set("range_width", length(*tile.high - *tile.low));
  result.set("deviation_at", place(tile.mean - tile.deviation));
  result.set("deviation_width", length(2.0 * tile.deviation));
  result.set("mean_at", place(tile.mean));
  return result;
}

data describe(const PageBlock& block, PictureShelf& shelf)
{
  data tables = data::type::list;
  for (const auto& table : block.tables)
    tables << describe(table);
  data figures = data::type::list;
  for (const auto& picture : block.pictures)
    figures << shelf.describe(picture);
  data result = data::type::object;
  set_unless_empty(result, "folded", block.folded);
  set_unless_empty(result, "subheading", block.subheading);
  set_unless_empty(result, "chip", block.chip);
  set_unless_empty(result, "headline", block.headline);
  result.set("paragraphs", list(block.paragraphs));
  data tiles = data::type::list;
  for (const Tile& tile : block.tiles)
    tiles << describe(tile);
  result.set("has_tiles", data(!block.tiles.empty()));
  result.set("tiles", tiles);
  result.set("has_points", data(!block.points.empty()));
  result.set("points", list(block.points));
  result.set("has_warnings", data(!block.warnings.empty()));
  result.set("warnings", list(block.warnings));
  result.set("tables", tables);
  result.set("has_lead", data(!block.lead.empty()));
  data beside = data::type::list;
  data below = data::type::list;
  for (std::size_t k = 0; k < block.lead.size(); ++k)
    (k == 0 ? beside : below) << shelf.describe(block.lead[k]);
  result.set("beside", beside);
  result.set("below", below);
  result.set("has_figures", data(!block.pictures.empty()));
  result.set("figures", figures);
  return result;
}

/// Renders a page with pictures, and with PDFs of them, of so many bytes at most.
std::string rendered(const Page& page, const std::filesystem::path& figures, const std::size_t room,
                     const std::size_t room_for_pdf)
{
  PictureShelf shelf(figures, room, room_for_pdf);
  data sections = data::type::list;
  for (const auto& section : page.sections)
    {
      data blocks = data::type::list;
      for (const auto& block : section.blocks)
        blocks << describe(block, shelf);
      data one = data::type::object;
      one.set("id", section.id);
      one.set("short_title", section.short_title);
      one.set("heading", section.heading);
      set_unless_empty(one, "section_folded", section.folded);
      one.set("blocks", blocks);
      sections << one;
    }
  data whole = data::type::object;
  whole.set("title", page.title);
  whole.set("subtitle", page.subtitle);
  set_unless_empty(whole, "labels", page.labels);
  set_unless_empty(whole, "paper_head", page.paper_head);
  whole.set("brief_on_paper", data(!page.prints_folded));
  whole.set("sections", sections);
  whole.set("script_hash", hash_of_script());
  whole.set("script", std::string(page_script));
  whole.set("figure", kainjow::mustache::partial([] { return std::string(figure_template); }));

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
