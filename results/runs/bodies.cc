#include "results/runs/bodies.h"

#include "laboratory/named_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
/// Share of the larger gap within which two gaps are alike. From 0.024 to 0.046 mean radii the compressive strength of
/// the plane rock rises by a sixth (docs/multiscale-and-grains.md), so that a difference of this share changes it by a
/// hundredth or two.
constexpr double alike_within = 0.05;

std::string bulk(const BodyFigures& figures)
{
  return figures.coordination_number_core ? fmt::format("{:.2f}", figures.coordination_number_core->mean) : "unknown";
}
} // namespace

std::map<std::uint64_t, SpecimenReport> whole_bodies(const std::vector<FinishedTest>& tests)
{
  std::map<std::uint64_t, SpecimenReport> bodies;
  for (const FinishedTest& test : tests)
    if (SpecimenReport& body = bodies[test.record.seed]; test.record.specimen.n_grains > body.n_grains)
      body = test.record.specimen;
  return bodies;
}

std::optional<BodyFigures> body_figures(const std::string& label, const std::vector<SpecimenReport>& bodies)
{
  std::vector<double> gaps, coordination, porosities;
  for (const SpecimenReport& body : bodies)
    if (body.n_grains > 0)
      {
        gaps.push_back(body.installation_gap_ratio);
        porosities.push_back(body.porosity);
        if (std::isfinite(body.coordination_number_core))
          coordination.push_back(body.coordination_number_core);
      }
  if (gaps.empty())
    return std::nullopt;
  return BodyFigures{label, *statistics(gaps), statistics(coordination), *statistics(porosities)};
}

std::optional<BodyFigures> body_figures(const Series& series)
{
  std::vector<SpecimenReport> bodies;
  if (series.kind != SeriesKind::laboratory_curve)
    for (const auto& [seed, body] : whole_bodies(series.tests))
      bodies.push_back(body);
  return body_figures(series.label, bodies);
}

std::string as_text(const BodyFigures& figures)
{
  return fmt::format("{}: gap {:.4f} mean radii, coordination number {} in the bulk, porosity {:.3f}", figures.label,
                     figures.gap.mean, bulk(figures), figures.porosity.mean);
}

std::string gap_remark(const BodyFigures& one, const BodyFigures& other)
{
  const double gap_1 = one.gap.mean;
  const double gap_2 = other.gap.mean;
  if (std::abs(gap_1 - gap_2) <= alike_within * std::max(std::abs(gap_1), std::abs(gap_2)))
    return "";
  return fmt::format(
    "{} and {} are different rocks: their grains are joined up to gaps of {:.4f} and {:.4f} mean radii "
    "(coordination number in the bulk {} and {}, porosity {:.3f} and {:.3f}); strength rises with the "
    "gap, so give both the same {}",
    one.label, other.label, gap_1, gap_2, bulk(one), bulk(other), one.porosity.mean, other.porosity.mean,
    input_entries::installation_gap.entry);
}

std::vector<std::string> gap_remarks(const std::vector<Series>& all)
{
  std::vector<std::string> remarks;
  std::optional<BodyFigures> first;
  for (const Series& series : all)
    if (const auto figures = body_figures(series))
      {
        if (!first)
          first = figures;
        else if (const std::string remark = gap_remark(*first, *figures); !remark.empty())
          remarks.push_back(remark);
      }
  return remarks;
}
} // namespace feldspar
