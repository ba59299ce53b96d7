#include "interfaces/points.h"

#include <algorithm>
#include <utility>

namespace feldspar::interfaces
{
namespace
{
/// Spreads the bits of a number (the finaliser of SplitMix64; Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x)
{
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

std::uint64_t number_of(const PointName name) { return (std::uint64_t(name.element) << 32U) | name.point; }

/// Returns a number of version, input and mode, which a log and its job have in common.
std::uint64_t identity_of(const Input& input, const Breaking breaking)
{
  std::uint64_t identity = breaking == Breaking::lagged ? 1 : 2;
  const auto add = [&](const std::string& text) {
    for (const char c : text)
      identity = mixed(identity ^ static_cast<unsigned char>(c));
  };
  add(version());
  for (const auto& [entry, value] : input.given())
    add(entry + '=' + value + '\n');
  return identity;
}

std::uint64_t first_seed(const Input& input) { return std::stoull(input.get("Seeds/Seeds")); }
} // namespace

Points::Points(const std::string& input_file, std::string its_log, const Breaking when)
  : input(input_file)
  , breaking(when)
  , seed(first_seed(input))
  , log_file(std::move(its_log))
{
  if (input.get("Sample/Orientation") != "fixed")
    throw Error(input_file +
                ": Sample/Orientation = random: a volume at a point of another code keeps the axes of its cell; "
                "set Orientation = fixed");
  const std::uint64_t n = std::stoull(input.get("Sample/Realisations"));
  for (std::uint64_t k = 0; k < n; ++k)
    rocks.emplace_back(Specimen(input, seed * n + k), input);
}

Points::Point Points::at_rest(const PointName name) const
{
  return {.accepted = rocks[mixed(seed ^ mixed(number_of(name))) % rocks.size()]};
}

Points::Point& Points::point_of(const PointName name, const bool is_restarted)
{
  const std::lock_guard lock(of_points);
  if (!log)
    log = std::make_unique<AnswerLog>(log_file, identity_of(input, breaking), is_restarted);
  if (name.element >= points.size())
    points.resize(name.element + 1);
  auto& of_element = points[name.element];
  if (name.point >= of_element.size())
    of_element.resize(name.point + 1);
  if (!of_element[name.point])
    of_element[name.point] = std::make_unique<Point>(at_rest(name));
  return *of_element[name.point];
}

void Points::accept_tried(Point& point) const
{
  point.accepted.accept(*point.tried);
  if (breaking == Breaking::lagged)
    if (const Trial broken = point.accepted.relax(point.tried_strain); broken.n_breaks() > 0)
      point.accepted.accept(broken);
  point.accepted_token = point.tried_token;
  point.accepted_strain = std::move(point.tried_strain);
  point.tried.reset();
}

void Points::go(Point& point, const PointName name, const std::vector<std::uint64_t>& way) const
{
  point = at_rest(name);
  for (const std::uint64_t token : way)
    {
      const AnswerRecord record = (*log)[token];
      point.tried_strain.assign(record.strain, record.strain + (dimension() == 2 ? 3 : 6));
      point.tried = answer(point, point.tried_strain);
      point.tried_token = token;
      accept_tried(point);
    }
}

Answer Points::respond(const PointName name, const std::uint64_t parent, const std::span<const double> before,
                       const std::span<const double> strain)
{
  const bool is_restarted =
    parent == 0 && std::any_of(before.begin(), before.end(), [](const double x) { return x != 0.0; });
  Point& point = point_of(name, is_restarted);
  if (point.tried && parent == point.tried_token)
    accept_tried(point);
  else if (is_restarted)
    {
      if (!is_same_strain(before, point.accepted_strain))
        go(point, name, log->way_to(name, before));
    }
  else if (parent != point.accepted_token)
    go(point, name, log->way_to(parent));

  if (!point.tried || !std::ranges::equal(point.tried_strain, strain))
    {
      Trial trial = answer(point, strain);
      if (!trial.in_equilibrium())
        return {false, parent, point.accepted.stress(), point.accepted.stiffness(), point.accepted.damage()};
      AnswerRecord record{name, point.accepted_token, {}};
      std::copy(strain.begin(), strain.end(), record.strain);
      point.tried_token = log->add(record);
      point.tried_strain.assign(strain.begin(), strain.end());
      point.tried = std::move(trial);
    }
  return {true, point.tried_token, point.tried->stress(), point.tried->tangent(), point.accepted.damage()};
}
} // namespace feldspar::interfaces
