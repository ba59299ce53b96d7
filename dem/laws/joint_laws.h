#pragma once

#include "base/simd.h"
#include "dem/laws/flat_joint.h"
#include "dem/laws/joint_law.h"
#include "dem/laws/parallel_bond.h"
#include "dem/laws/softening_flat_joint.h"

#include <optional>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

namespace feldspar
{
/// Joint laws as a list of templates: whatever is made once for each of them is made from here.
template <template <int> class... Laws>
struct JointLawList
{
  static_assert((JointLaw<Laws<2>, 2> && ...) && (JointLaw<Laws<3>, 3> && ...));

  /// One of the laws; a loop over joints asks once which, then runs with the law itself.
  template <int dim>
  using Any = std::variant<Laws<dim>...>;
  /// Parameters of one of the laws.
  using Parameters = std::variant<typename Laws<2>::Parameters...>;
  /// Parameters of each of them.
  using AllParameters = std::tuple<typename Laws<2>::Parameters...>;

  /// Calls f(name, parameters) for each of the laws.
  template <typename All, typename F>
  static void for_each(All& all, F&& f)
  {
    (f(Laws<2>::name, std::get<typename Laws<2>::Parameters>(all)), ...);
  }

  static std::vector<std::string_view> names() { return {Laws<2>::name...}; }

  /// Returns whether representative volumes find equilibria of the law of this name event by event.
  static bool has_equilibria(const std::string_view name)
  {
    return ((Laws<2>::name == name && Laws<2>::has_equilibria) || ...);
  }

  /// The law with these parameters, `contact` being that of pairs without a face.
  template <int dim>
  static Any<dim> make(const Parameters& wanted, const ParticleContactParameters& contact)
  {
    Any<dim> law;
    const auto take = [&]<typename Law>(const Law*) {
      if (const auto* parameters = std::get_if<typename Law::Parameters>(&wanted))
        law = Law(*parameters, contact);
    };
    (take(static_cast<const Laws<dim>*>(nullptr)), ...);
    return law;
  }

  /// A law by its name; none of that name is no law.
  template <int dim>
  static std::optional<Any<dim>> named(const std::string_view name)
  {
    std::optional<Any<dim>> law;
    ((Laws<dim>::name == name ? void(law = Laws<dim>()) : void()), ...);
    return law;
  }
};

/// The laws there are.
using JointLaws = JointLawList<FlatJoint, ParallelBond, SofteningFlatJoint>;

template <int dim>
using AnyJointLaw = JointLaws::Any<dim>;
using JointParameters = JointLaws::Parameters;

/// Returns whether the law responds for a face whose bonds all hold as for one element. Such joints take less work than others.
template <int dim>
bool responds_as_one(const AnyJointLaw<dim>& any_law)
{
  return std::visit([]<typename Law>(const Law&) { return RespondsAsOne<Law, dim, simd::Pack>; }, any_law);
}
} // namespace feldspar
