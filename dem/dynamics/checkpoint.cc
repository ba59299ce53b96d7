// The whole state of a body in motion, into a checkpoint and out of it.

#include "base/byte_archive.h"
#include "base/mapped.h"
#include "base/system/hdf5_archive.h"
#include "dem/dynamics/dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
/// Numbers of the joints on their way into a file, which has those of all processes, and out of it. Those of a shared body come
/// into the order of the joints' own numbers. One column at a time is whole.
template <int dim>
class JointColumns
{
public:
  /// To write.
  JointColumns(const BodyShare<dim>& of_body, const Joints<dim>& joints)
    : share(of_body)
    , places(joints.size())
  {
    std::iota(places.begin(), places.end(), std::size_t(0));
    std::erase_if(places, [&](const std::size_t j) { return !share.counts(joints.grain_1[j]); });
    const std::vector<std::uint32_t> numbers = share.gathered_by_first(chosen<std::uint32_t>(joints.number, 0));
    rank.resize(numbers.size());
    std::vector<std::size_t> by_number(numbers.size());
    std::iota(by_number.begin(), by_number.end(), std::size_t(0));
    if (share.is_shared()) // that of one process stays as it lies
      std::ranges::sort(by_number, {}, [&](const std::size_t k) { return numbers[k]; });
    for (std::size_t k = 0; k < by_number.size(); ++k)
      rank[by_number[k]] = k;
  }

  /// To read these of so many joints in the file.
  JointColumns(const BodyShare<dim>& of_body, std::vector<std::size_t> kept, const std::size_t n_of_file)
    : share(of_body)
    , places(std::move(kept))
    , n_in_file(n_of_file)
  {
  }

  /// Transfers so many numbers of each joint: all first ones, then all second ones.
  template <typename Archive, typename Values>
  void transfer(Archive& archive, const std::string& name, Values& values, const std::size_t n_of_joint = 1) const
  {
    using Value = std::remove_cvref_t<decltype(values[0])>;
    std::vector<Value> all;
    if constexpr (Archive::reads)
      {
        archive.array(name, all);
        if (all.size() != n_of_joint * n_in_file)
          throw InputError("{} holds {} values instead of {}", name, all.size(), n_of_joint * n_in_file);
        for (std::size_t i = 0; i < n_of_joint; ++i)
          for (std::size_t k = 0; k < places.size(); ++k)
            values[i * places.size() + k] = all[i * n_in_file + places[k]];
      }
    else
      {
        all.resize(n_of_joint * rank.size());
        for (std::size_t i = 0; i < n_of_joint; ++i)
          {
            const auto of_all = share.gathered_by_first(chosen<Value>(values, i * (values.size() / n_of_joint)));
            for (std::size_t k = 0; k < of_all.size(); ++k)
              all[i * rank.size() + rank[k]] = of_all[k];
          }
        archive.array(name, all);
      }
  }

private:
  template <typename Value, typename Values>
  std::vector<Value> chosen(const Values& values, const std::size_t first) const
  {
    return mapped<Value>(places, [&](const std::size_t j) { return values[first + j]; });
  }

  const BodyShare<dim>& share;
  std::vector<std::size_t> places; ///< of the joints that go to the file, or in it
  std::vector<std::size_t> rank;   ///< in the file, of those of all processes as they come to the first
  std::size_t n_in_file = 0;
};

/// The columns of a body's joints. Reading divides a shared body anew.
template <int dim, typename Archive>
JointColumns<dim> joint_columns(Archive& archive, BodyShare<dim>& share, Specimen<dim>& body)
{
  auto& joints = body.joints;
  if constexpr (!Archive::reads)
    return {share, joints};
  else
    {
      std::vector<std::uint32_t> grain_1, grain_2;
      archive.array("grain_1", grain_1);
      archive.array("grain_2", grain_2);
      if (grain_2.size() != grain_1.size())
        throw InputError("joints are missing");
      const std::size_t n_grains = body.grains.size();
      if (std::ranges::any_of(grain_1, [&](const std::uint32_t i) { return i >= n_grains; }) ||
          std::ranges::any_of(grain_2, [&](const std::uint32_t i) { return i >= n_grains; }))
        throw InputError("of another specimen");
      if (share.is_shared())
        {
          std::vector<double> bonded;
          archive.array("bonded", bonded);
          if (bonded.size() != joints.n_segments * grain_1.size())
            throw InputError("bonds are missing");
          share = share.divided_by(work_of_joints<dim>(n_grains, joints.law, grain_1, bonded, body.smooth_joints));
        }
      std::vector<std::size_t> kept;
      for (std::size_t j = 0; j < grain_1.size(); ++j)
        if (share.concerns({grain_1[j], grain_2[j]}))
          kept.push_back(j);
      joints.resize_all(kept.size());
      return {share, std::move(kept), grain_1.size()};
    }
}

/// Transfers what each process of a shared body has some of, which stands by its first grain. What is read is that of all.
template <int dim, typename Archive, typename T, typename FirstGrain>
void transfer_list(Archive& archive, const std::string& name, std::vector<T>& list, const BodyShare<dim>& share,
                   const FirstGrain& first_grain)
{
  if constexpr (Archive::reads)
    archive.array(name, list);
  else
    {
      std::vector<T> counted;
      std::ranges::copy_if(list, std::back_inserter(counted),
                           [&](const T& one) { return share.counts(first_grain(one)); });
      counted = share.gathered_by_first(counted);
      archive.array(name, counted);
    }
}
} // namespace

template <int dim>
template <typename Archive>
void Dynamics<dim>::transfer(Archive& archive)
{
  auto& grains = body.grains;
  transfer_components(archive, "position", grains.position);
  transfer_components(archive, "velocity", grains.velocity);
  transfer_components(archive, "spin", grains.spin);
  transfer_components(archive, "force", grains.force);
  transfer_components(archive, "couple", grains.couple);
  transfer_components(archive, "applied_force", applied_force);
  images.transfer(archive, grains);
  if constexpr (Archive::reads)
    for (const auto* components : {&grains.position, &grains.velocity, &grains.force})
      for (const auto& values : *components)
        if (values.size() != grains.size())
          throw InputError("of another specimen");
  groups.transfer(archive);

  const auto first_grain = [](const auto& of_two) { return of_two.grain_1; };
  transfer_list(archive, "smooth_joints", body.smooth_joints, part, first_grain);
  auto& joints = body.joints;
  const JointColumns<dim> columns = joint_columns(archive, part, body);
  const auto pass = [&](const std::string& name, auto& values) { columns.transfer(archive, name, values); };
  pass("grain_1", joints.grain_1);
  pass("grain_2", joints.grain_2);
  pass("number", joints.number);
  joints.visit_per_joint(pass);
  joints.visit_per_segment(
    [&](const std::string& name, auto& values) { columns.transfer(archive, name, values, joints.n_segments); });
  if (!body.minerals.empty())
    pass("further_friction", joints.further_friction);
  const auto pass_all = [&](const std::string& name, auto& components) {
    for (std::size_t c = 0; c < components.size(); ++c)
      pass(name + "_" + "xyz"[c], components[c]);
  };
  pass_all("joint_force", joints.force);
  pass_all("joint_couple_1", joints.couple_1);
  pass_all("joint_couple_2", joints.couple_2);

  std::vector<NearPair> near = touches.near_pairs();
  transfer_list(archive, "near_pairs", near, part, first_grain);
  std::vector<Touch<dim>> touched = touches.in_order();
  transfer_list(archive, "touches", touched, part, first_grain);
  wall_set.transfer(archive);
  std::vector<std::vector<WallTouch<dim>>> near_walls(wall_set.size());
  for (std::size_t w = 0; w < wall_set.size(); ++w)
    {
      near_walls[w] = wall_set.near(w);
      transfer_list(archive, fmt::format("wall_touches_{}", w), near_walls[w], part,
                    [](const WallTouch<dim>& touch) { return touch.grain; });
    }
  watch.transfer(archive);
  ledger.transfer(archive);

  std::uint32_t flags = std::uint32_t(started) + 2 * std::uint32_t(contact_made) +
                        4 * std::uint32_t(zero_force == ZeroForce::as_placed) + 8 * std::uint32_t(faces_have_gone);
  archive.value("flags", flags);
  started = flags & 1;
  contact_made = flags & 2;
  faces_have_gone = flags & 8;
  zero_force = flags & 4 ? ZeroForce::as_placed : ZeroForce::at_touch;
  archive.value("steps", steps);
  archive.value("dt", dt);
  archive.value("previous_dt", previous_dt);
  archive.value("current_time", current_time);
  if constexpr (Archive::reads)
    {
      const auto concerns_others = [&](const auto& pair) { return !part.concerns(pair.ends()); };
      std::erase_if(near, concerns_others);
      std::erase_if(touched, concerns_others);
      touches.take(near, std::move(touched));
      for (std::size_t w = 0; w < wall_set.size(); ++w)
        wall_set.take(w, std::move(near_walls[w]));
      keep_own();
      index_joints();
      inverse_inertia = InverseInertia(bodies());
    }
  touches.number(images);
}

template void Dynamics<2>::transfer(Hdf5Writer&);
template void Dynamics<2>::transfer(Hdf5Reader&);
template void Dynamics<2>::transfer(NothingWriter&);
template void Dynamics<3>::transfer(NothingWriter&);
template void Dynamics<3>::transfer(Hdf5Writer&);
template void Dynamics<3>::transfer(Hdf5Reader&);
} // namespace feldspar
