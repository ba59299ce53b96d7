#pragma once

#include "base/whole_file.h"
#include "dem/sharing/partners.h"
#include "dem/specimen/specimen.h"
#include "dem/storage/exact_sum.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace feldspar
{
/// Work of the joints that each grain is the first of, in units of a joint whose bonds all hold; [n_grains]. `bonded`: of all
/// segments, as those of Joints.
template <int dim, typename Bonded>
std::vector<std::uint32_t> work_of_joints(std::size_t n_grains, const AnyJointLaw<dim>& law,
                                          std::span<const std::uint32_t> grain_1, const Bonded& bonded,
                                          const std::vector<SmoothJoint<dim>>& smooth_joints);

/// The part of a body that a process computes, of those that compute it together: a range of its grains, which are its own,
/// all joints and contacts of these, and copies of the motion of the grains at their other ends. A joint of two owners is
/// computed by both, from the same motions, so that only motions travel. Every process has all grains by number, and knows of
/// those that are neither its own nor copied what it last heard. Without partners all grains are its own.
template <int dim>
class BodyShare
{
public:
  explicit BodyShare(const std::size_t n_grains)
    : own{0, std::uint32_t(n_grains)}
  {
  }
  /// Divides a body into ranges of equal work; work_of_joints(): of the joints that each grain is the first of, [n_grains].
  BodyShare(Partners& with, const std::vector<std::uint32_t>& work_of_joints);
  /// The same, divided anew.
  BodyShare divided_by(const std::vector<std::uint32_t>& work_of_joints) const { return {*partners, work_of_joints}; }

  bool is_shared() const { return partners != nullptr; }
  /// Returns whether this process speaks for what all know.
  bool is_first() const { return !is_shared() || partners->mine() == 0; }
  GrainRange grains() const { return own; }
  /// Returns whether a joint or a contact is counted by this process: the owner of its first grain.
  bool counts(const std::uint32_t grain_1) const { return own.has(grain_1); }
  bool concerns(const GrainPair& pair) const { return own.has(pair.first) || own.has(pair.second); }
  /// The largest work of a process over the largest after a new division, of the body as it is now.
  double unevenness(const Specimen<dim>& own_part) const;

  /// Agrees with the partners on the grains whose motions each needs of others; own ones may be among them. All know the
  /// positions of all.
  void agree_on_copies(std::vector<std::uint32_t> needed);
  /// The grains of others whose motions this process knows at every step.
  const std::vector<std::uint32_t>& copies() const { return taken; }

  /// Copies the motions of the grains that are copied from their owners. Returns the longest way of any of them and of the own
  /// [m], whose longest is given.
  double copy_motions(Grains<dim>& grains, double farthest_way);
  /// Brings values by grain up to date; [n_grains].
  void bring(LargeVector<double>& values) const;
  template <std::size_t n>
  void bring_all(std::array<LargeVector<double>, n>& components) const
  {
    for (auto& component : components)
      bring(component);
  }

  /// The values of all, one process after another; the own ones without partners. `counts`: of each process, where all know
  /// them; else empty, and becomes them.
  template <typename T>
  std::vector<T> gathered(const std::vector<T>& values, std::vector<std::size_t>& counts) const
  {
    return is_shared() ? feldspar::gathered(*partners, values, counts) : values;
  }
  template <typename T>
  std::vector<T> gathered(const std::vector<T>& values) const
  {
    std::vector<std::size_t> counts;
    return gathered(values, counts);
  }
  /// The same on the first process; nothing on others. Where the first cannot go on, it says any(true) instead, and the others throw
  /// OutputError.
  template <typename T>
  std::vector<T> gathered_by_first(const std::vector<T>& values) const
  {
    if (!is_shared())
      return values;
    if (any(false))
      throw OutputError("the first process could not write the body");
    return values_of<T>(partners->gathered_by_first(std::as_bytes(std::span(values))));
  }
  /// The same of processes that have as many values each.
  template <typename T>
  std::vector<T> gathered_alike(const std::vector<T>& values) const
  {
    std::vector<std::size_t> counts(is_shared() ? partners->number() : 0, values.size());
    return gathered(values, counts);
  }
  /// Gathers several lists at once; `counts` of the numbers in all messages.
  std::vector<std::vector<double>> gathered_lists(const std::vector<std::vector<double>>& lists,
                                                  std::vector<std::size_t>& counts) const;
  /// The largest of the values of all, one by one.
  std::vector<double> largest(const std::vector<double>& values) const;
  bool any(const bool here) const { return is_shared() ? largest({here ? 1.0 : 0.0})[0] > 0.0 : here; }
  /// Sums over the body of what each process has added.
  std::vector<double> totals(std::vector<ExactSum> sums) const;
  void add_up(ExactSum& sum) const;

private:
  Partners* partners = nullptr;
  GrainRange own;
  std::vector<std::uint32_t> first_of; ///< grain of each process; [number + 1]
  std::vector<std::uint32_t> given;    ///< own grains whose motions others need, by process
  std::vector<std::uint32_t> taken;    ///< copied grains, by owner
  std::vector<std::size_t> first_sent, first_received;
  std::vector<double> sent, received;
};
} // namespace feldspar
