#pragma once

#include "base/simd.h"
#include "dem/laws/joint_law.h"
#include "dem/laws/joint_laws.h"

#include <type_traits>
#include <variant>

namespace feldspar
{
/// Returns whether the law responds for a face whose bonds all hold as for one element. Such joints take less work than others.
template <int dim>
bool responds_as_one(const AnyJointLaw<dim>& any_law)
{
  return std::visit([](const auto& law) { return RespondsAsOne<std::decay_t<decltype(law)>, dim, simd::Pack>; },
                    any_law);
}
} // namespace feldspar
