#pragma once

#include "coupling/rve/parameters.h"
#include "coupling/sample/continua/parameters.h"
#include "coupling/sample/realisation.h"
#include "coupling/sample/sample_parameters.h"
#include "laboratory/parameters.h"
#include "laboratory/test_outcome.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Progress of a multiscale test, for its observer.
struct SampleStanding
{
  unsigned int n_newton_iterations = 0; ///< of the last row
  unsigned int n_cascades = 0;          ///< of the last row
  std::uint64_t n_points = 0;
  std::uint64_t n_damaged_points = 0;
  std::uint64_t n_segments = 0; ///< of all points
};

/// A laboratory test on a sample of finite elements with a representative volume at every point; docs/theory.md
/// §10. Leaves the same record as a test on a specimen of grains: a row of the curve a step, strains counted from
/// seating.
///
/// All ranks of mpirun make it together: every function is collective, throws on all ranks what it throws on any, and
/// tells the same on all, but for the cracks and events, which only the first rank has.
class SampleTest
{
public:
  /// The RVEs of `realisations`, of dimension_of_rves(sample.geometry), are assigned to the points by the seed, as
  /// make_body_of_grains() does.
  /// Throws InputError for a test that such a sample cannot make.
  template <int dim>
  SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
             const EquilibriumParameters& equilibrium, std::vector<Realisation<dim>> realisations,
             const SpecimenReport& of_rves, std::uint64_t seed);
  /// A sample without grains; sample.material says which. Cracks and energies are not known of it.
  SampleTest(const TestCase& test, const SampleParameters& sample, const TestParameters& wanted,
             const ContinuumParameters& continuum);
  ~SampleTest();
  SampleTest(SampleTest&&) noexcept;

  /// Seats the sample at the first call, then loads it to the next row of the curve. False once the stop rule has ended
  /// the test, or no equilibrium could be found: then the record tells. `watch` is called after every iteration
  /// and may throw, on all ranks, to leave the test as it was at the last of its steps, of which a row may have many;
  /// `step_done` after each of these, at a moment for write_state(). `gives_up` is asked before each point and in its searches, by any thread;
  /// where it says so on any rank, `watch` is called, which is to throw.
  bool advance(const std::function<void(const SampleStanding&)>& watch, const std::function<void()>& step_done,
               const std::function<bool()>& gives_up = {});

  bool has_ended() const;
  const CurveSample& last_row() const;
  SampleStanding standing() const;

  /// RVE at the last step, where there is one rank. Cells and points as in the fields, from 0. Throws InputError where
  /// there is no such point, or no grains.
  template <int dim>
  SampleRve<dim> rve_at(unsigned int cell, unsigned int point) const;
  /// The same of a point by its number, as cracks name it; none where it is another rank's. Not collective; there are
  /// grains.
  template <int dim>
  std::optional<SampleRve<dim>> rve_here(std::uint64_t number) const;
  std::size_t n_points_per_cell() const;

  /// Adds the present fields to a time series for ParaView.
  void write_fields(const std::filesystem::path& folder, const std::string& name);
  std::size_t n_fields_written() const;

  /// The test up to its last row.
  TestOutcome finish(bool interrupted) const;

  /// The whole state at the last step, as a checkpoint in `folder` (coupling/sample/checkpoints.h), so that a test read back on as
  /// many ranks runs on to the same bits. `identity` tells whose state it is. Throws OutputError.
  void write_state(const std::filesystem::path& folder, const std::string& identity) const;
  /// Reads the state, written by any number of ranks. `folder` and `name` of the fields that were written. Throws
  /// InputError where the checkpoint is missing, torn, foreign or of another identity; the test is then unusable.
  void read_state(const std::filesystem::path& checkpoint, const std::string& identity,
                  const std::filesystem::path& folder, const std::string& name);

private:
  struct Parts; ///< deal.II's headers stay out of who includes this one
  std::unique_ptr<Parts> parts;
};
} // namespace feldspar
