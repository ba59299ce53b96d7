#include "dem/dynamics/force_sum.h"

#include "base/parallel.h"
#include "dem/storage/simd_transpose.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

namespace feldspar
{
namespace
{
using simd::Four;

/// Force and couple on a grain.
template <int dim>
struct Load
{
  std::array<double, dim> force;
  std::array<double, n_rotations<dim>> couple;
};

/// Load on a grain by the responses of those joints of which it is the first grain, and of those of which it is the
/// second. Responses are records that are added four numbers at a time; JointTables::response has their order.
struct LoadInPlane
{
  Four one{}, two{};

  void add_as_one(const double* const response) { one += simd::load_four(response); }
  void add_as_two(const double* const response) { two += simd::load_four(response); }
  Load<2> sum() const { return {{two[0] - one[0], two[1] - one[1]}, {one[2] + two[3]}}; }
};

struct LoadInSpace
{
  Four force_one{}, force_two{}, couple_one{}, couple_two{};

  void add_as_one(const double* const response)
  {
    force_one += simd::load_four(response);
    couple_one += simd::load_four(response + JointTables<3>::first_couple_1);
  }
  void add_as_two(const double* const response)
  {
    force_two += simd::load_four(response);
    couple_two += simd::load_four(response + JointTables<3>::first_couple_2 - 1); // the last four
  }
  Load<3> sum() const
  {
    return {{force_two[0] - force_one[0], force_two[1] - force_one[1], force_two[2] - force_one[2]},
            {couple_one[0] + couple_two[1], couple_one[1] + couple_two[2], couple_one[2] + couple_two[3]}};
  }
};

/// Responses of more numbers than this lie far from each other in memory: they are asked for some grains ahead. In the
/// cache asking takes longer than it spares.
constexpr std::size_t numbers_in_cache = 40000;

/// Load on the grain at a place of the order.
template <int dim, bool asks_ahead>
[[gnu::always_inline]] inline Load<dim> load_from_joints(const Joints<dim>& joints, const SumOrder& order,
                                                         const std::size_t place)
{
  constexpr std::size_t size = JointTables<dim>::n_response_rows, ahead = 32;
  const double* const responses = joints.response.at(0, 0);
  const std::uint32_t* const joint = order.joint.data();
  const std::uint32_t middle = order.first_as_one[place], end = order.first_as_two[place + 1];
  const auto response = [&](const std::uint32_t e) {
    if constexpr (asks_ahead)
      {
        const double* const later = responses + size * joint[std::min<std::size_t>(e + ahead, order.joint.size() - 1)];
        __builtin_prefetch(later);
        __builtin_prefetch(later + size - 1);
      }
    return responses + size * joint[e];
  };
  std::conditional_t<dim == 2, LoadInPlane, LoadInSpace> load;
  for (std::uint32_t e = order.first_as_two[place]; e < middle; ++e)
    load.add_as_two(response(e));
  for (std::uint32_t e = middle; e < end; ++e)
    load.add_as_one(response(e));
  return load.sum();
}

template <int dim>
void add_touch(const Touch<dim>& touch, const bool as_second, const std::uint32_t grain, Grains<dim>& grains)
{
  const double direction = as_second ? 1.0 : -1.0;
  for (int c = 0; c < dim; ++c)
    grains.force[c][grain] += direction * touch.on_grains.force[c];
  for (int c = 0; c < n_rotations<dim>; ++c)
    grains.couple[c][grain] += (as_second ? touch.on_grains.couple_2 : touch.on_grains.couple_1)[c];
}

template <bool asks_ahead, int dim>
void sum_over_joints_of(Specimen<dim>& body, const SumOrder& order, const std::size_t begin, const std::size_t end)
{
  auto& grains = body.grains;
  for (std::size_t place = begin; place < end; ++place)
    {
      const std::uint32_t i = order.grain[place];
      const auto [force, couple] = load_from_joints<dim, asks_ahead>(body.joints, order, place);
      for (int c = 0; c < dim; ++c)
        grains.force[c][i] = force[c];
      for (int c = 0; c < n_rotations<dim>; ++c)
        grains.couple[c][i] = couple[c];
    }
}

/// Sets the grains of these places to the sums over their joints.
template <int dim>
void sum_over_joints(Specimen<dim>& body, const SumOrder& order, const std::size_t begin, const std::size_t end)
{
  if (body.joints.size() * JointTables<dim>::n_response_rows > numbers_in_cache)
    sum_over_joints_of<true>(body, order, begin, end);
  else
    sum_over_joints_of<false>(body, order, begin, end);
}

/// Number of blocks of joints that one thread sweeps in a row: as many as leave some runs for each thread. Sums do not
/// depend on it.
std::size_t blocks_for_one_thread(const std::size_t n_joints)
{
  constexpr std::size_t runs_per_thread = 8;
  const std::size_t n_threads = stays_on_this_thread(n_joints) ? 1 : number_of_threads();
  const std::size_t n = n_blocks(n_joints);
  return n_threads == 1 ? std::max<std::size_t>(n, 1)
                        : std::max(fewest_blocks_in_a_row, n / (runs_per_thread * n_threads));
}
} // namespace

SumOrder::SumOrder(const Incidence& joints_of, const std::size_t n_joints, const GrainRange& these)
  : summed(these)
  , blocks_in_a_row(blocks_for_one_thread(n_joints))
{
  const auto first_grain = summed.first;
  const auto n_grains = std::uint32_t(summed.size());
  const auto is_second = [](const std::uint32_t entry) { return entry % 2 == 1; };
  const auto entries_of = [&](const std::uint32_t i) {
    return std::span(joints_of.entries).subspan(joints_of.first[i], joints_of.first[i + 1] - joints_of.first[i]);
  };

  const std::size_t after_all = n_blocks(n_joints);
  std::vector<std::uint32_t> behind(n_grains, std::uint32_t(after_all)); // which block each grain is summed
  first_behind.assign(after_all + 2, 0);
  for (std::uint32_t i = 0; i < n_grains; ++i)
    {
      if (const auto entries = entries_of(first_grain + i); !entries.empty())
        {
          const auto [least, largest] = std::ranges::minmax_element(entries);
          const std::size_t first = *least / 2 / block_size, last = *largest / 2 / block_size;
          if (first / blocks_in_a_row == last / blocks_in_a_row)
            behind[i] = std::uint32_t(last);
        }
      ++first_behind[behind[i] + 1];
    }
  std::partial_sum(first_behind.begin(), first_behind.end(), first_behind.begin());
  grain.resize(n_grains);
  auto next = first_behind;
  for (std::uint32_t i = 0; i < n_grains; ++i)
    grain[next[behind[i]]++] = first_grain + i;

  // Number of neighbouring grains whose responses stay in the cache while they are summed in this order.
  constexpr std::uint32_t n_neighbours = 64;
  const auto counts = [&](const std::uint32_t i) {
    const auto entries = entries_of(i);
    const auto n_as_two = std::ranges::count_if(entries, is_second);
    return std::pair(std::size_t(n_as_two), entries.size());
  };
  for (std::size_t block = 0; block <= after_all; ++block)
    for (std::uint32_t begin = first_behind[block]; begin < first_behind[block + 1]; begin += n_neighbours)
      std::stable_sort(grain.begin() + begin, grain.begin() + std::min(begin + n_neighbours, first_behind[block + 1]),
                       [&](const std::uint32_t a, const std::uint32_t b) { return counts(a) < counts(b); });
  first_behind.pop_back();

  for (const std::uint32_t i : grain)
    {
      const auto entries = entries_of(i);
      first_as_two.push_back(std::uint32_t(joint.size()));
      for (const std::uint32_t entry : entries)
        if (is_second(entry))
          joint.push_back(entry / 2);
      first_as_one.push_back(std::uint32_t(joint.size()));
      for (const std::uint32_t entry : entries)
        if (!is_second(entry))
          joint.push_back(entry / 2);
    }
  first_as_two.push_back(std::uint32_t(joint.size()));
}

template <int dim>
void sum_forces_behind(const std::size_t block, Specimen<dim>& body, const SumOrder& order)
{
  const std::size_t first = order.first_behind[block], end = order.first_behind[block + 1];
  if constexpr (dim == 2) // responses of these joints are still in the cache
    sum_over_joints_of<false>(body, order, first, end);
  else
    sum_over_joints(body, order, first, end);
}

template <int dim>
void sum_remaining_forces(Specimen<dim>& body, const SumOrder& order, const Touches<dim>& touches)
{
  auto& grains = body.grains;
  const std::size_t n_grains = order.grain.size(), first_left = order.first_behind.back();
  for_each_block(n_grains - first_left, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    sum_over_joints(body, order, first_left + begin, first_left + end);
  });

  // To each grain come its contacts by their numbers, whether it is grains or contacts that are gone through. Only
  // grains can be shared out to threads.
  constexpr std::size_t grains_per_touch = 8;
  if (stays_on_this_thread(n_grains) || grains_per_touch * touches.touching().size() < n_grains)
    {
      for (const std::uint32_t k : touches.touching())
        {
          const Touch<dim>& touch = touches.touch(k);
          if (order.summed.has(touch.grain_1))
            add_touch(touch, false, touch.grain_1, grains);
          if (const std::uint32_t owner = touches.owner_2(k); order.summed.has(owner))
            add_touch(touch, true, owner, grains);
        }
      return;
    }
  const Incidence& touches_of = touches.incidence();
  for_each_block(n_grains, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (std::size_t i = order.summed.first + begin; i < order.summed.first + end; ++i)
      for (auto e = touches_of.first[i]; e < touches_of.first[i + 1]; ++e)
        if (const std::uint32_t entry = touches_of.entries[e]; touches.is_touching(entry / 2))
          add_touch(touches.touch(entry / 2), entry % 2, std::uint32_t(i), grains);
  });
}

template void sum_forces_behind<2>(std::size_t, Specimen<2>&, const SumOrder&);
template void sum_forces_behind<3>(std::size_t, Specimen<3>&, const SumOrder&);
template void sum_remaining_forces<2>(Specimen<2>&, const SumOrder&, const Touches<2>&);
template void sum_remaining_forces<3>(Specimen<3>&, const SumOrder&, const Touches<3>&);
} // namespace feldspar
