#pragma once

#include "base/entries.h"
#include "laboratory/parameters.h"

#include <vector>

/// Entries of the parameters that some protocols alone have.
namespace feldspar
{
/// Entries of one kind of test as they stand in section Tests with those of all tests.
template <typename Own>
std::vector<Entry<TestParameters>> within_tests(const std::vector<Entry<Own>>& entries)
{
  std::vector<Entry<TestParameters>> result;
  result.reserve(entries.size());
  for (const Entry<Own>& one : entries)
    result.push_back(within<TestParameters>(
      one, [](const TestParameters& tests) -> const Own& { return tests.of<Own>(); },
      [](TestParameters& tests) -> Own& { return tests.of<Own>(); }));
  return result;
}

/// Flags of entries of the tests.
namespace tests_flags
{
inline EntryFlags as_basic(EntryFlags flags)
{
  flags.basic = true;
  return flags;
}
inline const EntryFlags of_grains{.varies = true,
                                  .bodies = {Body::plane_box, Body::box, Body::cylinder},
                                  .needs = "is of tests on specimens of grains"};
inline const EntryFlags of_platens{.bodies = {Body::plane_box, Body::box, Body::cylinder, Body::sample},
                                   .needs = "is of tests on bodies between platens"};
inline const EntryFlags of_box{.varies = true,
                               .bodies = {Body::box},
                               .needs = "presses on two sides of a box of grains in space: Shape = box, Dimension = 3"};
inline const EntryFlags in_space{.varies = true,
                                 .bodies = {Body::box, Body::cylinder},
                                 .needs =
                                   "is the length of a disc in space, Dimension = 3; in the plane discs have none"};
} // namespace tests_flags

/// A curve of two rows to the peak tells nothing.
inline constexpr Range range_of_sampling_strain{'(', 0.0, 0.01, ']'};
} // namespace feldspar
