#include "report/pictures/curves/curve_pictures.h"

#include "report/pictures/curves/courses.h"
#include "report/pictures/curves/stress_curves.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
std::vector<GroupPictures> curve_pictures(const std::vector<Series>& all)
{
  // Of every series the tests of the same kind and pressure.
  std::vector<std::pair<TestGroup, SameTests>> programme;
  std::vector<TestGroup> every;
  for (std::size_t n = 0; n < all.size(); ++n)
    for (const auto& group : groups_of(all[n]))
      {
        auto found = std::find_if(programme.begin(), programme.end(),
                                  [&](const auto& entry) { return same_conditions(entry.first, group); });
        if (found == programme.end())
          found = programme.insert(programme.end(), {group, {}});
        found->second.push_back({&all[n], n, group});
      }
  std::stable_sort(programme.begin(), programme.end(),
                   [](const auto& a, const auto& b) { return comes_before(a.first, b.first); });
  for (const auto& [group, same] : programme)
    every.push_back(group);
  const auto on_page = shown(every);

  std::vector<GroupPictures> result;
  for (const auto& [group, same] : programme)
    {
      const std::string name = group.name();
      const std::string of_tests = group.title();
      const bool is_shown =
        std::any_of(on_page.begin(), on_page.end(), [&](const TestGroup& one) { return one.name() == name; });
      GroupPictures pictures{of_tests, is_shown, {}};
      for (const auto& make : {stress_picture, crack_count_picture, energy_picture, crack_rate_picture})
        if (auto picture = make(same, name, of_tests))
          pictures.pictures.push_back(std::move(*picture));
      if (!pictures.pictures.empty())
        result.push_back(std::move(pictures));
    }
  return result;
}
} // namespace feldspar
