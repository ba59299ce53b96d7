#include "dem/dynamics/sweeps/joint_groups.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
// The width of this processor's packs is not used: the order must be the same on every machine.
constexpr std::size_t pack = 8;
/// Number of joints that follow each other by their numbers, which are those of their places in space. Only these
/// change places among each other, so that their grains and states stay near each other in memory.
constexpr std::size_t window = 256;

/// Kinds of joints in the order in which they are put. An open joint needs no computation, a whole one is computed as one.
enum class Kind : std::uint8_t
{
  whole,
  open,
  in_pieces
};

template <int dim>
std::vector<Kind> kinds(const std::size_t n_joints, const SweepMemory<dim>& memory)
{
  std::vector<Kind> kinds(n_joints, Kind::whole);
  for (std::size_t j = 0; j < n_joints; ++j)
    if (*memory.weakest.at(memory.tensile_strength, j) < 0.0)
      kinds[j] = *memory.weakest.at(memory.cohesion, j) == memory.stands_open ? Kind::open : Kind::in_pieces;
  return kinds;
}

/// Packs with a joint in pieces; kind_at(k) of the joint at place k.
template <typename KindAt>
std::size_t n_packs_in_pieces(const std::size_t n_joints, KindAt&& kind_at)
{
  std::size_t n = 0;
  for (std::size_t begin = 0; begin < n_joints; begin += pack)
    {
      bool some_in_pieces = false;
      for (std::size_t k = begin; k < std::min(begin + pack, n_joints); ++k)
        some_in_pieces = some_in_pieces || kind_at(k) == Kind::in_pieces;
      n += some_in_pieces;
    }
  return n;
}

/// The joints in the order in which they are to stand.
template <int dim>
std::vector<std::size_t> grouped(const Joints<dim>& joints, const std::vector<Kind>& kinds)
{
  std::vector<std::size_t> order = joints.by_number();
  for (auto begin = order.begin(); begin != order.end();)
    {
      const auto end = begin + std::min(std::ptrdiff_t(window), order.end() - begin);
      std::sort(begin, end, [&](const std::size_t a, const std::size_t b) {
        return std::pair(kinds[a], joints.number[a]) < std::pair(kinds[b], joints.number[b]);
      });
      begin = end;
    }
  return order;
}
} // namespace

template <int dim>
bool regroup(Joints<dim>& joints, const SweepMemory<dim>& memory)
{
  const auto kinds_of_joints = kinds(joints.size(), memory);
  const std::size_t n_now = n_packs_in_pieces(joints.size(), [&](const std::size_t j) { return kinds_of_joints[j]; });
  const auto spares_enough = [&](const std::size_t n_then) {
    return 32 * pack * n_now > 32 * pack * n_then + joints.size();
  };
  // No order has fewer than packs full of them: where that is not enough, none needs to be made.
  const auto n_in_pieces = std::size_t(std::ranges::count(kinds_of_joints, Kind::in_pieces));
  if (!spares_enough((n_in_pieces + pack - 1) / pack))
    return false;
  const std::vector<std::size_t> order = grouped(joints, kinds_of_joints);
  if (!spares_enough(n_packs_in_pieces(joints.size(), [&](const std::size_t k) { return kinds_of_joints[order[k]]; })))
    return false;
  joints.reorder(order);
  return true;
}

template bool regroup(Joints<2>&, const SweepMemory<2>&);
template bool regroup(Joints<3>&, const SweepMemory<3>&);
} // namespace feldspar
