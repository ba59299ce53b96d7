#include "report/page/picture_book.h"

#include "base/contains.h"
#include "base/whole_file.h"
#include "report/page/browser.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace feldspar
{
std::vector<PagePicture> PictureBook::keep(std::vector<Picture> pictures)
{
  std::vector<PagePicture> places;
  for (auto& picture : pictures)
    {
      // Labels that differ in signs alone, or behind the place where long names are cut, make the same name.
      const std::string name = picture.name;
      for (unsigned int k = 2; is_taken(picture.name); ++k)
        picture.name = fmt::format("{}_{}", name, k);
      places.push_back({picture, ""});
      all.push_back(std::move(picture));
    }
  return places;
}

void PictureBook::keep_as_files(std::vector<Picture> pictures)
{
  for (auto& picture : pictures)
    if (!is_taken(picture.name))
      all.push_back(std::move(picture));
}

std::vector<std::string> PictureBook::draw_bodies_into(const std::filesystem::path& folder,
                                                       const DrawingWatch& watch) const
{
  Page bodies;
  PageBlock& block = bodies.sections.emplace_back().blocks.emplace_back();
  for (const Picture& picture : all)
    if (!picture.body.empty())
      {
        make_way_for(folder / picture.shown_file());
        block.pictures.push_back({picture, "drawn below"});
        block.pictures.back().picture.story = picture.body;
      }
  const std::filesystem::path page = folder / "bodies.html";
  DrawnByBrowser drawn{ProgramEnd::failed, {}};
  if (!block.pictures.empty() && browser() != nullptr && !watch.is_over())
    {
      write_page(bodies, page, folder, std::numeric_limits<std::size_t>::max());
      drawn = drawn_by_browser(page, "#stills", 2, std::chrono::minutes(5), watch.is_over);
      std::filesystem::remove(page);
    }
  drawn.files.resize(block.pictures.size());
  std::vector<std::string> missing;
  for (std::size_t k = 0; k < drawn.files.size(); ++k)
    if (const std::string& name = block.pictures[k].picture.name; drawn.files[k].empty())
      missing.push_back(name);
    else
      write_whole_file(folder / (name + ".png"), drawn.files[k]);
  return missing;
}

std::string PictureBook::draw_into(const std::filesystem::path& folder, Page& page, const DrawingWatch& watch) const
{
  const auto problems = draw(all, folder, std::chrono::minutes(5), watch);
  std::map<std::string, std::string> problem_of;
  for (std::size_t k = 0; k < all.size(); ++k)
    problem_of[all[k].name] = problems[k];
  for (const std::string& name : draw_bodies_into(folder, watch))
    problem_of[name] =
      name + ".png is missing: Chromium (package chromium) draws it, or this page with scripts and WebGL 2";
  for (auto& section : page.sections)
    for (auto& block : section.blocks)
      for (auto* pictures : {&block.lead, &block.pictures})
        for (auto& [picture, problem] : *pictures)
          {
            problem = problem_of[picture.name];
            if (!problem.empty() && picture.story.empty())
              picture.story = picture.body;
          }
  const auto first = std::ranges::find_if(problems, [](const auto& text) { return !text.empty(); });
  return first == problems.end() ? "" : *first;
}

bool PictureBook::is_taken(const std::string& name) const { return contains(all, name, &Picture::name); }
} // namespace feldspar
