#include "report/page/picture_book.h"

#include <fmt/format.h>

#include <algorithm>
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

std::string PictureBook::draw_into(const std::filesystem::path& folder, Page& page, const DrawingWatch& watch) const
{
  const auto problems = draw(all, folder, std::chrono::minutes(5), watch);
  std::map<std::string, std::string> problem_of;
  for (std::size_t k = 0; k < all.size(); ++k)
    problem_of[all[k].name] = problems[k];
  for (auto& section : page.sections)
    for (auto& block : section.blocks)
      for (auto* pictures : {&block.lead, &block.pictures})
        for (auto& picture : *pictures)
          picture.problem = problem_of[picture.picture.name];
  const auto first = std::find_if(problems.begin(), problems.end(), [](const auto& text) { return !text.empty(); });
  return first == problems.end() ? "" : *first;
}

bool PictureBook::is_taken(const std::string& name) const
{
  return std::any_of(all.begin(), all.end(), [&](const Picture& picture) { return picture.name == name; });
}
} // namespace feldspar
