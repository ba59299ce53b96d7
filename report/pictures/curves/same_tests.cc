#include "report/pictures/curves/same_tests.h"

#include <algorithm>
#include <cmath>

namespace feldspar
{
bool SeriesGroup::counts_cracks() const
{
  return series->kind != SeriesKind::laboratory_curve &&
         std::none_of(group.tests.begin(), group.tests.end(), [](const FinishedTest* test) {
           const bool is_continuum =
             test->record.body == TestBody::finite_elements && test->record.specimen.n_joints == 0;
           return is_continuum ||
                  (!test->record.curve.empty() && std::isnan(test->record.curve.back().energies.strain));
         });
}

bool any_has_several(const SameTests& same)
{
  return std::any_of(same.begin(), same.end(), [](const SeriesGroup& of) { return of.group.tests.size() > 1; });
}

std::string means_of_several(const SameTests& same, const bool shows_single_tests)
{
  if (!any_has_several(same))
    return "";
  const bool all_have =
    std::all_of(same.begin(), same.end(), [](const SeriesGroup& of) { return of.group.tests.size() > 1; });
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
} // namespace feldspar
