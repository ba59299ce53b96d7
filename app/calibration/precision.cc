#include "app/calibration/precision.h"

#include "calibration/target_outcomes.h"
#include "results/statistics.h"

#include <fmt/format.h>

#include <cmath>

namespace feldspar::calibration
{
namespace
{
/// The precision of a mean of the most packings, and how many the tolerance needs. `scatter`: of a specimen, as a share.
std::string in_words(const double scatter, const CalibrationParameters& wanted)
{
  const std::size_t most = wanted.most_packings;
  const double half_width = student_factor_95(most - 1) * scatter / std::sqrt(double(most));
  const auto needed = packings_for(wanted_half_width(wanted.tolerance), scatter);
  std::string text = fmt::format("a specimen scatters by {:.1f} %, the mean of {} is known within ± {:.1f} %",
                                 100.0 * scatter, most, 100.0 * half_width);
  if (!needed || *needed > most)
    text += fmt::format("; a tolerance of {:g} % needs {} packings", 100.0 * wanted.tolerance,
                        needed ? fmt::format("some {}", *needed) : "more than 10000");
  return text;
}
} // namespace

std::string usual_precision(const CalibrationParameters& wanted, const unsigned int dimension,
                            const std::size_t n_grains)
{
  // Scatter by the examples: 10 % of 1900 discs (calibrate-beishan), 14 % of 700 (calibrate-hidden-rocks), 5 % of 3000
  // spheres (calibrate-beishan-cylinder). The scatter falls with the square root of the number of grains.
  const double scatter = (dimension == 2 ? 4.0 : 3.0) / std::sqrt(double(n_grains));
  return fmt::format("Usual precision of compressive strengths of so many grains (Calibration/Most packings = {}): {}.",
                     wanted.most_packings, in_words(scatter, wanted));
}

std::string precision_by_design(const CalibrationParameters& wanted, const Problem& problem, const ResponseModel& model)
{
  std::string text =
    fmt::format("Precision by the scatter of the design (Calibration/Most packings = {}):", wanted.most_packings);
  for (const Target& target : problem.targets)
    {
      const Response& response = problem.response_of(target);
      const double scatter = *model.learnt(target.response).scatter_of_design / response.per_share(target.value);
      text += fmt::format("\n- {}: {}", response.title, in_words(scatter, wanted));
    }
  return text;
}
} // namespace feldspar::calibration
