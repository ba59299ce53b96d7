#include "report/pictures/curves/curve_pictures.h"

#include "base/contains.h"
#include "report/chart/gnuplot_writer.h"
#include "report/pictures/figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace feldspar
{
bool SeriesGroup::counts_cracks() const
{
  return series->kind != SeriesKind::laboratory_curve &&
         std::ranges::none_of(group.tests, [](const FinishedTest* test) {
           const bool is_continuum =
             test->record.body == TestBody::finite_elements && test->record.specimen.n_joints == 0;
           return is_continuum ||
                  (!test->record.curve.empty() && std::isnan(test->record.curve.back().energies.strain));
         });
}

bool any_has_several(const SameTests& same)
{
  return std::ranges::any_of(same, [](const SeriesGroup& of) { return of.group.tests.size() > 1; });
}

std::string means_of_several(const SameTests& same, const bool shows_single_tests)
{
  if (!any_has_several(same))
    return "";
  const bool all_have = std::ranges::all_of(same, [](const SeriesGroup& of) { return of.group.tests.size() > 1; });
  if (all_have)
    return std::string(". Lines: means; bands: ± standard deviation") +
           (shows_single_tests ? "; thin lines: single tests" : "");
  return std::string(". Of a series with several tests the line is the mean and the band ± standard deviation") +
         (shows_single_tests ? "; thin lines are single tests" : "");
}

std::string abscissa_name(const SameTests& same)
{
  const TestKind& kind = same.front().group.kind;
  return kind.follows_stages ? "time" : std::string(kind.channel.strain_name);
}

std::string abscissa_label(const SameTests& same)
{
  return abscissa_name(same) + (same.front().group.kind.follows_stages ? " [ms]" : " [10⁻³]");
}

void add_mean(Chart& chart, ChartSeries mean, const std::vector<std::array<double, 2>>& deviations)
{
  if (!deviations.empty())
    {
      ChartSeries band{.kind = ChartSeries::Kind::area,
                       .label = mean.label + ", ± standard deviation",
                       .goes_with = mean.label,
                       .colour = mean.colour,
                       .opacity = 0.18};
      for (std::size_t k = 0; k < deviations.size(); ++k)
        band.points.push_back({mean.points[k][0] + deviations[k][0], mean.points[k][1] + deviations[k][1]});
      for (std::size_t k = deviations.size(); k-- > 0;)
        band.points.push_back({mean.points[k][0] - deviations[k][0], mean.points[k][1] - deviations[k][1]});
      chart.series.push_back(std::move(band));
    }
  chart.series.push_back(std::move(mean));
}

std::vector<Picture> curve_picture(Chart chart, const SameTests& same, const std::string& ending,
                                   const std::string& caption, const std::string& alternative)
{
  constexpr int width = 580; // [px]
  if (chart.empty())
    return {};
  const auto layer = [](const ChartSeries& series) {
    return series.kind == ChartSeries::Kind::area ? 0 : !series.goes_with.empty() ? 1 : series.to_the_right ? 3 : 2;
  };
  std::ranges::stable_sort(chart.series,
                           [&](const ChartSeries& a, const ChartSeries& b) { return layer(a) < layer(b); });
  return {{.name = same.front().group.name() + ending,
           .caption = caption,
           .alternative = alternative,
           .width = width,
           .height = 450 + further_height(chart, width),
           .panels = {std::move(chart)}}};
}

std::vector<GroupPictures> curve_pictures(const std::vector<Series>& all)
{
  // Tests of the same kind and pressure of every series.
  std::vector<std::pair<TestGroup, SameTests>> programme;
  std::vector<TestGroup> every;
  for (std::size_t n = 0; n < all.size(); ++n)
    for (const auto& group : groups_of(all[n]))
      {
        auto found =
          std::ranges::find_if(programme, [&](const auto& entry) { return same_conditions(entry.first, group); });
        if (found == programme.end())
          found = programme.insert(programme.end(), {group, {}});
        found->second.push_back({&all[n], n, group});
      }
  std::ranges::stable_sort(programme, [](const auto& a, const auto& b) { return comes_before(a.first, b.first); });
  for (const auto& [group, same] : programme)
    every.push_back(group);
  const auto on_page = shown(every);

  std::vector<GroupPictures> result;
  for (const auto& [group, same] : programme)
    {
      const std::string name = group.name();
      const bool is_shown = contains(on_page, name, &TestGroup::name);
      GroupPictures pictures{group.title(), is_shown, pictures_of(curve_figures, same)};
      if (!pictures.pictures.empty())
        result.push_back(std::move(pictures));
    }
  return result;
}
} // namespace feldspar
