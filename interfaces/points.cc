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
  n_components = rocks.front().dimension() == 2 ? 3 : 6;
}

Points::Point Points::at_rest(const PointName name) const
{
  Point point{.accepted = rocks[mixed(seed ^ mixed(name.number())) % rocks.size()]};
  tell_damage(point);
  return point;
}

void Points::tell_damage(Point& point)
{
  if (point.accepted.is_intact())
    return;
  const Damage damage = point.accepted.damage();
  point.answer.states = {0.0, damage.broken_share, damage.broken_in_shear_share, damage.dissipation,
                         damage.crack_density};
  std::ranges::copy(damage.crack_orientation, point.answer.states.begin() + 5);
}

Points::Point& Points::point_of(const PointName name, const bool is_restarted)
{
  const std::lock_guard lock(of_points);
  if (!log)
    log = std::make_unique<AnswerLog>(log_file, identity_of(input, breaking), is_restarted);
  const auto known = points.find(name.number());
  return known != points.end() ? known->second : points.emplace(name.number(), at_rest(name)).first->second;
}

void Points::attempt(Point& point, const std::span<const double> strain) const
{
  Answer& answer = point.answer;
  Trial trial = breaking == Breaking::lagged ? point.accepted.trial(strain, true) : point.accepted.relax(strain, true);
  answer.in_equilibrium = trial.in_equilibrium();
  std::ranges::copy(answer.in_equilibrium ? trial.stress() : point.accepted.stress(), answer.stress.begin());
  std::ranges::copy(answer.in_equilibrium ? trial.tangent() : point.accepted.stiffness(), answer.tangent.begin());
  answer.states[0] = double(point.accepted_token);
  point.tried.reset();
  if (!answer.in_equilibrium)
    return;
  point.tried = std::move(trial);
  std::ranges::copy(strain, point.tried_strain.begin());
}

void Points::accept_tried(Point& point) const
{
  point.accepted.accept(*point.tried);
  if (breaking == Breaking::lagged)
    if (const Trial broken = point.accepted.relax(std::span(point.tried_strain).first(n_components));
        broken.n_breaks() > 0)
      point.accepted.accept(broken);
  point.accepted_token = point.answer.token();
  point.accepted_strain = point.tried_strain;
  tell_damage(point);
  point.tried.reset();
}

void Points::go(Point& point, const PointName name, const std::vector<std::uint64_t>& way) const
{
  point = at_rest(name);
  for (const std::uint64_t token : way)
    {
      attempt(point, std::span((*log)[token].strain).first(n_components));
      if (!point.tried)
        throw Error(log_file + ": finds no equilibrium at a strain that had one; another processor or build wrote it");
      point.answer.states[0] = double(token);
      accept_tried(point);
    }
}

const Answer& Points::respond(const PointName name, const std::uint64_t parent, const std::span<const double> before,
                              const std::span<const double> strain)
{
  const bool is_restarted = parent == 0 && std::ranges::any_of(before, [](const double x) { return x != 0.0; });
  Point& point = point_of(name, is_restarted);
  if (point.tried && parent == point.answer.token())
    accept_tried(point);
  else if (is_restarted)
    {
      if (!is_same_strain(before, point.accepted_strain))
        go(point, name, log->way_to(name, before));
    }
  else if (parent != point.accepted_token)
    go(point, name, log->way_to(parent));

  if (!point.tried || !std::equal(strain.begin(), strain.end(), point.tried_strain.begin()))
    if (attempt(point, strain); point.tried)
      {
        AnswerRecord record{name, point.accepted_token, {}};
        std::ranges::copy(strain, record.strain);
        point.answer.states[0] = double(log->add(record));
      }
  return point.answer;
}
} // namespace feldspar::interfaces
