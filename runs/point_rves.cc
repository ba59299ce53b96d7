#include "base/byte_archive.h"
#include "base/contains.h"
#include "base/ranks/ranks.h"
#include "coupling/rve/state_archive.h"
#include "runs/rve_view.h"
#include "runs/samples.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace feldspar
{
namespace
{
struct ChosenPoint
{
  std::string which;
  std::uint64_t number; ///< of the point
};

/// Chooses points from the cracks, which the first rank has.
std::vector<ChosenPoint> chosen(const TestRecord& record, const std::uint64_t n_points)
{
  std::map<std::uint64_t, std::size_t> n_broken;
  for (const Crack& crack : record.cracks)
    ++n_broken[crack.joint];
  // The least damaged first, of those that are equal the one of the highest number.
  std::vector<std::pair<std::uint64_t, std::size_t>> damaged(n_broken.rbegin(), n_broken.rend());
  std::ranges::stable_sort(damaged, {}, &std::pair<std::uint64_t, std::size_t>::second);

  std::vector<ChosenPoint> choices;
  const auto add = [&](const std::string& which, const std::uint64_t number) {
    if (!contains(choices, number, &ChosenPoint::number))
      choices.push_back({which, number});
  };
  if (!damaged.empty())
    {
      add("most damaged", damaged.back().first);
      add("median of the damaged", damaged[damaged.size() / 2].first);
    }
  std::vector<std::uint64_t> intact;
  for (std::uint64_t number = 0; number < n_points; ++number)
    if (!n_broken.contains(number))
      intact.push_back(number);
  if (!intact.empty())
    add("intact", intact[intact.size() / 2]);
  else
    add("least damaged", damaged.front().first);
  return choices;
}

/// The message about an RVE that ranks exchange.
template <int dim, typename Archive>
void transfer(Archive& archive, SampleRve<dim>& rve, std::uint64_t& realisation, bool& is_at_side)
{
  archive.value("number", rve.number);
  archive.value("realisation", realisation);
  transfer_flag(archive, "is_at_side", is_at_side);
  for (int i = 0; i < dim; ++i)
    {
      archive.value("position", rve.position[i]);
      for (int j = 0; j < dim; ++j)
        archive.value("orientation", rve.orientation(i, j));
    }
  feldspar::transfer(archive, rve.state);
}

/// Brings an RVE from the rank that has it to the first.
template <int dim>
std::optional<SampleRve<dim>> brought(const SampleTest& test, const Packings<dim>& packings, const std::uint64_t number)
{
  BytesWriter writer;
  std::uint64_t realisation = 0;
  bool is_at_side = false;
  if (auto rve = test.rve_here<dim>(number))
    {
      realisation = packings.realisation_of(*rve->network);
      is_at_side = packings.realisations[realisation].at_side.get() == rve->network;
      transfer<dim>(writer, *rve, realisation, is_at_side);
    }
  const std::string bytes = ranks::gathered(writer.all);
  if (!ranks::is_first())
    return std::nullopt;
  BytesReader reader(bytes);
  SampleRve<dim> rve{};
  transfer<dim>(reader, rve, realisation, is_at_side);
  const Realisation<dim>& assigned = packings.realisations.at(realisation);
  rve.network = (is_at_side ? assigned.at_side : assigned.inside).get();
  return rve;
}

template <int dim>
std::vector<PointRve> rves(const Packings<dim>& packings, const SampleTest& test, const TestRecord& record)
{
  if (packings.realisations.empty())
    return {};
  std::vector<ChosenPoint> choices;
  std::vector<std::uint64_t> numbers;
  if (ranks::is_first())
    for (const ChosenPoint& choice : choices = chosen(record, test.standing().n_points))
      numbers.push_back(choice.number);
  numbers = values_of<std::uint64_t>(ranks::of_first(bytes_of(numbers)));

  std::vector<PointRve> all;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    {
      const std::uint64_t number = numbers[k];
      const auto rve = brought<dim>(test, packings, number);
      if (!rve)
        continue;
      RveView seen = as_seen(packings.specimens[packings.realisation_of(*rve->network)], *rve, record);
      const std::size_t n = test.n_points_per_cell();
      PointRve shown;
      shown.which = choices[k].which;
      shown.cell = unsigned(number / n);
      shown.point = unsigned(number % n);
      for (int c = 0; c < dim; ++c)
        shown.position[std::size_t(c)] = rve->position[c];
      shown.n_segments = rve->network->n_segments();
      shown.grains = std::move(seen.appearance.grains_at_end);
      shown.cracks = std::move(seen.cracks);
      all.push_back(std::move(shown));
    }
  return all;
}
} // namespace

std::vector<PointRve> point_rves(const PlannedSample& planned, const SampleTest& test, const TestRecord& record)
{
  return std::visit([&](const auto& packings) { return rves(packings, test, record); }, planned.rock->packings);
}
} // namespace feldspar
