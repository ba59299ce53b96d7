#pragma once

#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cstddef>

/// Tests, uniaxial compressions unless said, that must have the same bits, and cracks by which they could differ.
namespace feldspar::tests
{
inline void expect_same_bits(const TestOutcome& one, const TestOutcome& two)
{
  EXPECT_GT(one.record.cracks.size(), 0u);
  EXPECT_EQ(one.record.cracks.size(), two.record.cracks.size());
  const CurveSample& last = one.record.curve.back();
  const CurveSample& other = two.record.curve.back();
  EXPECT_EQ(last.axial_stress, other.axial_stress);
  EXPECT_EQ(last.gauge_lateral_strain, other.gauge_lateral_strain);
  EXPECT_EQ(last.energies.slip, other.energies.slip);
  EXPECT_EQ(last.energies.damping, other.energies.damping);
  EXPECT_EQ(one.appearance.grains_at_end.back().position, two.appearance.grains_at_end.back().position);
}

/// After so many rows, by one thread and by two.
template <int dim>
void expect_same_bits_on_two_threads(const Specimen<dim>& specimen, const TestParameters& wanted, const int n_rows,
                                     const LaboratoryCase& test_case = {uniaxial_compression})
{
  const auto end = [&](const std::size_t n_threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, n_threads);
    LabTest<dim> test(test_case, specimen, wanted, {});
    for (int n = 0; n < n_rows && test.advance(); ++n)
      ;
    return test.finish(true);
  };
  expect_same_bits(end(1), end(2));
}

/// After `n_before` rows a checkpoint, from which a test on the specimen as it was `read_back` goes on for `n_after` rows.
template <int dim>
void expect_same_bits_when_resumed(const Specimen<dim>& specimen, const Specimen<dim>& read_back,
                                   const TestParameters& wanted, const int n_before, const int n_after,
                                   const LaboratoryCase& test_case = {uniaxial_compression})
{
  const TemporaryFolder folder;
  LabTest<dim> whole(test_case, specimen, wanted, {});
  for (int n = 0; n < n_before; ++n)
    whole.advance();
  whole.write_checkpoint(folder.path() / "test.h5", "one");
  LabTest<dim> again(test_case, read_back, wanted, {});
  again.read_checkpoint(folder.path() / "test.h5", "one");
  for (int n = 0; n < n_after; ++n)
    {
      whole.advance();
      again.advance();
    }
  expect_same_bits(whole.finish(true), again.finish(true));
}
} // namespace feldspar::tests
