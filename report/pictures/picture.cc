#include "report/pictures/picture.h"

#include "base/quoted.h"
#include "base/system/program.h"
#include "base/whole_file.h"
#include "laboratory/named_entries.h"
#include "report/chart/gnuplot_writer.h"
#include "report/chart/page_writer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace feldspar
{
namespace
{
/// File endings with the terminals that make them. 1 px is 1/40 cm on paper: 640 px are a page's width.
std::vector<std::pair<std::string, std::string>> outputs(const Picture& picture)
{
  const std::string size = fmt::format("{},{}", picture.width, picture.height);
  std::vector<std::pair<std::string, std::string>> result;
  if (picture.raster)
    result.emplace_back(".png", fmt::format("pngcairo size {} font 'DejaVu Sans,11'", size));
  if (picture.vector)
    {
      result.emplace_back(".svg", fmt::format("svg size {} font 'sans-serif,14' background 'white'", size));
      result.emplace_back(".pdf", fmt::format("pdfcairo size {:.2f}cm,{:.2f}cm font 'DejaVu Sans,8'",
                                              picture.width / 40.0, picture.height / 40.0));
    }
  return result;
}

/// The script as a file of its own that leaves its pictures in the folder it is run in.
std::string whole_script(const Picture& picture)
{
  const std::string commands = picture.script();
  std::string script = "set encoding utf8\n";
  for (const auto& [ending, terminal] : outputs(picture))
    script += fmt::format("set terminal {}\nset output {}\n{}unset output\nreset\n", terminal,
                          gnuplot_text(picture.name + ending), commands);
  return script;
}

/// Takes the time of drawing out of a PDF, with which the same results would give other bytes: cairo writes it as it is, and
/// a date of the same length leaves all other places where they were.
void take_date_out(const std::filesystem::path& pdf)
{
  constexpr std::string_view before = "/CreationDate (D:";
  constexpr std::string_view of_no_day = "20000101000000";
  std::fstream file(pdf, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const std::size_t date = bytes.find(before);
  if (date == std::string::npos)
    return;
  file.clear();
  file.seekp(std::streamoff(date + before.size()));
  file.write(of_no_day.data(), std::streamsize(of_no_day.size()));
}

std::string draw_one(const Picture& picture, const std::filesystem::path& folder,
                     const std::chrono::milliseconds longest, const std::function<bool()>& is_over,
                     std::atomic<bool>& has_hung)
{
  const auto called_off = [&] {
    return fmt::format("{} was not drawn: the run was asked to end before; {} with its folder draws all", picture.name,
                       input_entries::report);
  };
  if (!is_plain_name(picture.name))
    throw std::logic_error("a picture is named " + in_quotes(picture.name));
  const std::string script = picture.name + ".gp";
  write_whole_file(folder / script, whole_script(picture));
  if (is_over())
    return called_off();
  if (has_hung)
    return fmt::format("{} was not drawn: gnuplot did not end with another picture", picture.name);
  // Without the user's own settings (-d), which are commands too.
  for (const auto& [ending, terminal] : outputs(picture))
    make_way_for(folder / (picture.name + ending));
  const ProgramEnd end = run_program({"gnuplot", "-d", script}, folder, longest, is_over);
  if (end == ProgramEnd::called_off)
    return called_off();
  if (end == ProgramEnd::hung)
    {
      has_hung = true;
      return fmt::format("{} was not drawn: gnuplot did not end within {} s", picture.name,
                         std::chrono::duration<double>(longest).count());
    }
  for (const auto& [ending, terminal] : outputs(picture))
    if (end == ProgramEnd::failed || !std::filesystem::exists(folder / (picture.name + ending)))
      return fmt::format("{} was not drawn: is gnuplot (package gnuplot-nox) installed?", picture.name + ending);
    else if (ending == ".pdf")
      take_date_out(folder / (picture.name + ending));
  return "";
}
} // namespace

std::vector<std::string> draw(const std::vector<Picture>& pictures, const std::filesystem::path& folder,
                              const std::chrono::milliseconds longest, const DrawingWatch& watch)
{
  std::vector<std::string> problems(pictures.size());
  std::atomic<bool> has_hung = false;
  std::mutex hearing;
  std::size_t n_done = 0;
  tbb::parallel_for(std::size_t(0), pictures.size(), [&](const std::size_t k) {
    if (pictures[k].body.empty())
      problems[k] = draw_one(pictures[k], folder, longest, watch.is_over, has_hung);
    const std::lock_guard lock(hearing);
    watch.hear(++n_done, pictures.size());
  });
  return problems;
}

std::vector<Picture> picture_of(Chart chart, const int width, const int height, const std::string& name,
                                const std::string& caption, const std::string& alternative)
{
  if (chart.empty())
    return {};
  return {{.name = name,
           .caption = caption,
           .alternative = alternative,
           .width = width,
           .height = height + further_height(chart, width),
           .panels = {std::move(chart)}}};
}

std::string Picture::script() const { return gnuplot_script(panels, columns, width); }

std::string Picture::live() const
{
  return !story.empty() || panels.size() != 1 ? story : live::chart_data(panels.front());
}
} // namespace feldspar
