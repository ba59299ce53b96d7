#include "dem/sharing/body_share.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace feldspar
{
namespace
{
template <int dim>
constexpr std::size_t n_copied = 2 * dim + n_rotations<dim>; // of a grain: position, velocity, spin
/// In units of a joint whose bonds all hold, for a law that responds for it as for one. A Xeon with AVX-512 took 2.0 times as long
/// for a step of a broken body in the plane and 2.6 times in space, of which grains are a third and a fifth
/// (benchmarks/dynamics_benchmark.cc, space_benchmark.cc).
constexpr std::size_t work_of_broken_joint = 3;

/// visit(values of all grains) for each number of the motion of a grain.
template <int dim, typename Visit>
void for_each_motion(Grains<dim>& grains, const Visit& visit)
{
  for (auto* components : {&grains.position, &grains.velocity})
    for (auto& values : *components)
      visit(values);
  for (auto& values : grains.spin)
    visit(values);
}

/// The work of a step on all grains before each, and on all: a grain is as much as a joint whose bonds all hold.
std::vector<std::size_t> work_before(const std::vector<std::uint32_t>& work_of_joints)
{
  std::vector<std::size_t> work(work_of_joints.size() + 1, 0);
  for (std::size_t i = 0; i < work_of_joints.size(); ++i)
    work[i + 1] = work[i] + work_of_joints[i] + 1;
  return work;
}

/// The first grain of each part, and the number of grains.
std::vector<std::uint32_t> divided(const std::vector<std::size_t>& work, const std::size_t n_parts)
{
  std::vector<std::uint32_t> first_of{0};
  first_of.reserve(n_parts + 1);
  for (std::size_t part = 1; part < n_parts; ++part)
    first_of.push_back(std::uint32_t(std::ranges::lower_bound(work, work.back() * part / n_parts) - work.begin()));
  first_of.push_back(std::uint32_t(work.size() - 1));
  return first_of;
}
} // namespace

/// A smooth joint counts as a broken one; contacts without a face are left out.
template <int dim, typename Bonded>
std::vector<std::uint32_t> work_of_joints(const std::size_t n_grains, const AnyJointLaw<dim>& law,
                                          const std::span<const std::uint32_t> grain_1, const Bonded& bonded,
                                          const std::vector<SmoothJoint<dim>>& smooth_joints)
{
  const std::uint32_t of_broken = responds_as_one<dim>(law) ? work_of_broken_joint : 1;
  std::vector<bool> holds(grain_1.size(), true);
  for (std::size_t segment = 0; segment < bonded.size(); ++segment)
    if (!(bonded[segment] > 0.0))
      holds[segment % grain_1.size()] = false;
  std::vector<std::uint32_t> work(n_grains, 0);
  for (std::size_t j = 0; j < grain_1.size(); ++j)
    work[grain_1[j]] += holds[j] ? 1 : of_broken;
  for (const SmoothJoint<dim>& joint : smooth_joints)
    work[joint.grain_1] += work_of_broken_joint;
  return work;
}

template <int dim>
double BodyShare<dim>::unevenness(const Specimen<dim>& own_part) const
{
  if (!is_shared())
    return 1.0;
  const auto& joints = own_part.joints;
  const std::vector<std::uint32_t> here =
    work_of_joints<dim>(own_part.grains.size(), joints.law, joints.grain_1, joints.bonded, own_part.smooth_joints);
  const std::vector<std::size_t> work =
    work_before(gathered(std::vector<std::uint32_t>(here.begin() + own.first, here.begin() + own.end)));
  const auto most = [&](const std::vector<std::uint32_t>& division) {
    std::size_t largest = 0;
    for (std::size_t part = 0; part + 1 < division.size(); ++part)
      largest = std::max(largest, work[division[part + 1]] - work[division[part]]);
    return double(largest);
  };
  return most(first_of) / most(divided(work, partners->number()));
}

template <int dim>
BodyShare<dim>::BodyShare(Partners& with, const std::vector<std::uint32_t>& of_joints)
  : partners(&with)
  , own{0, 0}
  , first_of(divided(work_before(of_joints), with.number()))
{
  own = {first_of[with.mine()], first_of[with.mine() + 1]};
}

template <int dim>
void BodyShare<dim>::agree_on_copies(std::vector<std::uint32_t> needed)
{
  if (!is_shared())
    return;
  std::erase_if(needed, [&](const std::uint32_t grain) { return own.has(grain); });
  std::ranges::sort(needed);
  needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
  taken = std::move(needed);

  constexpr std::size_t per_grain = n_copied<dim>, per_message = 1; // the longest way of the sender
  const unsigned int n = partners->number();
  const auto room = [&](const std::ptrdiff_t n_grains) {
    return n_grains > 0 ? std::size_t(n_grains) * per_grain + per_message : 0;
  };
  // All hear the grains that each takes: 4 bytes a copied grain.
  std::vector<std::size_t> counts;
  const std::vector<std::uint32_t> wanted = gathered(taken, counts);
  given.clear();
  first_sent.assign(1, 0);
  first_received.assign(1, 0);
  auto begin = wanted.begin();
  for (unsigned int p = 0; p < n; ++p)
    {
      const auto end = begin + std::ptrdiff_t(counts[p]);
      const auto from = std::lower_bound(begin, end, own.first), to = std::lower_bound(begin, end, own.end);
      given.insert(given.end(), from, to);
      first_sent.push_back(first_sent.back() + room(to - from));
      const auto of_p = std::ranges::lower_bound(taken, first_of[p]),
                 behind = std::ranges::lower_bound(taken, first_of[p + 1]);
      first_received.push_back(first_received.back() + room(behind - of_p));
      begin = end;
    }
  sent.resize(first_sent.back());
  received.resize(first_received.back());
}

template <int dim>
double BodyShare<dim>::copy_motions(Grains<dim>& grains, double farthest_way)
{
  if (!is_shared())
    return farthest_way;
  const auto for_each_message = [&](const std::vector<std::size_t>& first, const auto& visit) {
    std::size_t grain = 0; // among those given, or taken
    for (unsigned int p = 0; p < partners->number(); ++p)
      if (const std::size_t size = first[p + 1] - first[p]; size > 0)
        {
          const std::size_t n = (size - 1) / n_copied<dim>;
          visit(first[p], grain, n);
          grain += n;
        }
  };
  for_each_message(first_sent, [&](std::size_t to, const std::size_t first, const std::size_t n) {
    for_each_motion(grains, [&](const LargeVector<double>& values) {
      for (std::size_t k = first; k < first + n; ++k)
        sent[to++] = values[given[k]];
    });
    sent[to] = farthest_way;
  });
  partners->exchange(sent, first_sent, received, first_received);
  for_each_message(first_received, [&](std::size_t from, const std::size_t first, const std::size_t n) {
    for_each_motion(grains, [&](LargeVector<double>& values) {
      for (std::size_t k = first; k < first + n; ++k)
        values[taken[k]] = received[from++];
    });
    farthest_way = std::max(farthest_way, received[from]);
  });
  return farthest_way;
}

template <int dim>
void BodyShare<dim>::bring(LargeVector<double>& values) const
{
  if (!is_shared() || values.empty())
    return;
  const std::vector<double> all = gathered(std::vector<double>(values.begin() + own.first, values.begin() + own.end));
  std::ranges::copy(all, values.begin());
}

template <int dim>
std::vector<std::vector<double>> BodyShare<dim>::gathered_lists(const std::vector<std::vector<double>>& lists,
                                                                std::vector<std::size_t>& counts) const
{
  if (!is_shared())
    return lists;
  std::vector<double> message;
  for (const auto& list : lists)
    {
      message.push_back(double(list.size()));
      message.insert(message.end(), list.begin(), list.end());
    }
  std::vector<std::vector<double>> all(lists.size());
  const std::vector<double> messages = gathered(message, counts);
  for (auto next = messages.begin(); next != messages.end();)
    for (auto& list : all)
      {
        const auto n = std::ptrdiff_t(*next++);
        list.insert(list.end(), next, next + n);
        next += n;
      }
  return all;
}

template <int dim>
std::vector<double> BodyShare<dim>::largest(const std::vector<double>& values) const
{
  const std::vector<double> all = gathered_alike(values);
  std::vector<double> result = values;
  for (std::size_t k = 0; k < all.size(); ++k)
    result[k % values.size()] = std::max(result[k % values.size()], all[k]);
  return result;
}

template <int dim>
void BodyShare<dim>::add_up(ExactSum& sum) const
{
  if (!is_shared())
    return;
  ExactSum total;
  for (const ExactSum& one : gathered_alike(std::vector{sum}))
    total.add(one);
  sum = total;
}

template <int dim>
std::vector<double> BodyShare<dim>::totals(std::vector<ExactSum> sums) const
{
  const std::vector<ExactSum> all = gathered_alike(sums);
  std::vector<ExactSum> total(sums.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    total[k % sums.size()].add(all[k]);
  std::vector<double> values(sums.size());
  std::ranges::transform(total, values.begin(), &ExactSum::value);
  return values;
}

template class BodyShare<2>;
template class BodyShare<3>;
template decltype(work_of_joints<2, PackedRow>) work_of_joints<2, PackedRow>;
template decltype(work_of_joints<3, PackedRow>) work_of_joints<3, PackedRow>;
template decltype(work_of_joints<2, std::vector<double>>) work_of_joints<2, std::vector<double>>;
template decltype(work_of_joints<3, std::vector<double>>) work_of_joints<3, std::vector<double>>;
} // namespace feldspar
