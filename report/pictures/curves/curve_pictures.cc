#include "report/pictures/curves/curve_pictures.h"

#include "base/contains.h"
#include "base/mapped.h"
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
  return std::string(all_have
                       ? ". Lines: means; bands: ± standard deviation"
                       : ". Of a series with several tests the line is the mean and the band ± standard deviation") +
         (!shows_single_tests ? ""
          : all_have          ? "; thin lines: single tests"
                              : "; thin lines are single tests");
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
  const auto layer = [](const ChartSeries& series) {
    return series.kind == ChartSeries::Kind::area ? 0 : !series.goes_with.empty() ? 1 : series.to_the_right ? 3 : 2;
  };
  std::ranges::stable_sort(chart.series, {}, layer);
  return picture_of(std::move(chart), 580, 450, same.front().group.name() + ending, caption, alternative);
}

std::vector<GroupPictures> curve_pictures(const std::vector<Series>& all)
{
  // Tests of the same kind and pressure of every series.
  std::vector<SameTests> programme;
  for (std::size_t n = 0; n < all.size(); ++n)
    for (const auto& one : groups_of(all[n]))
      {
        auto found = std::ranges::find_if(
          programme, [&](const SameTests& same) { return same_conditions(same.front().group, one); });
        if (found == programme.end())
          found = programme.insert(programme.end(), SameTests());
        found->push_back({&all[n], n, one});
      }
  std::ranges::stable_sort(
    programme, [](const SameTests& a, const SameTests& b) { return comes_before(a.front().group, b.front().group); });
  const auto on_page = shown(mapped<TestGroup>(programme, [](const SameTests& same) { return same.front().group; }));

  std::vector<GroupPictures> result;
  for (const SameTests& same : programme)
    if (Pictures pictures = pictures_of(curve_figures, same); !pictures.empty())
      result.push_back({same.front().group.title(), contains(on_page, same.front().group.name(), &TestGroup::name),
                        std::move(pictures)});
  return result;
}
} // namespace feldspar
