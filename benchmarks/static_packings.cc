#include "benchmarks/committed_version.h"
#include "dem/genesis/genesis.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/test_in_progress.h"
#include "results/evaluation.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <cstdint>
#include <string>
#include <vector>

namespace
{
using namespace feldspar;

/// Pulls and presses one specimen of the static solver; a row of the results.
std::string row(const std::uint64_t seed)
{
  SpecimenParameters wanted;
  wanted.packed_by_descent = true;
  FlatJointParameters joint;
  joint.coordination_number = 4.2;
  unsigned int n_iterations = 0;
  const auto specimen = make_specimen<2>(
    wanted, joint, {}, seed, [](std::string_view, double) {}, [&] { ++n_iterations; });
  const auto results_of = [&](const LaboratoryProtocol& protocol) {
    LabTest<2> test({protocol}, specimen, TestParameters{}, DynamicsParameters{});
    while (test.advance())
      ;
    return evaluate(test.finish(false).record);
  };
  const TestResults tension = results_of(direct_tension);
  const TestResults compression = results_of(uniaxial_compression);
  const SpecimenReport& report = specimen.report;
  return fmt::format("  {{\"seed\": {}, \"n_grains\": {}, \"iterations\": {}, \"porosity\": {:.6f}, "
                     "\"radius_multiplier\": {:.6f}, \"coordination_number_core\": {:.4f}, "
                     "\"installation_gap_ratio\": {:.5f}, \"mean_overlap_ratio\": {:.3e},\n   "
                     "\"tensile_strength_Pa\": {:.5g}, \"uniaxial_compressive_strength_Pa\": {:.5g}, "
                     "\"youngs_modulus_tangent_Pa\": {:.5g}, \"youngs_modulus_initial_Pa\": {:.5g}}}",
                     seed, report.n_grains, n_iterations, report.porosity, report.radius_multiplier,
                     report.coordination_number_core, report.installation_gap_ratio, report.mean_overlap_ratio,
                     *tension.peak_stress.value, *compression.peak_stress.value,
                     *compression.youngs_modulus_tangent.value, *compression.youngs_modulus_initial.value);
}
} // namespace

/// The ten specimens of discs of examples/beishan-granite packed by the static solver, pulled and pressed: the same rock as
/// that of damped dynamics? Writes benchmarks/results/static-packings.json to the screen; minutes on two cores.
int main()
{
  const std::string version_of_results = committed_version();
  const oneapi::tbb::global_control two(oneapi::tbb::global_control::max_allowed_parallelism, 2);
  std::vector<std::string> rows(10);
  oneapi::tbb::parallel_for(std::size_t(0), rows.size(), [&](const std::size_t k) { rows[k] = row(k + 1); });
  fmt::print("{{\"feldspar_version\": \"{}\", \"specimens\": [\n{}\n]}}\n", version_of_results, fmt::join(rows, ",\n"));
}
