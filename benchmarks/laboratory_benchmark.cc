// Whole laboratory tests of a plane specimen by the engine and by plain scalar code in turns, on one thread:
//
//   laboratory_benchmark SPECIMEN.h5 direct_tension|uniaxial_compression TIMES [STOP_STRAIN]
//
// SPECIMEN.h5: of `feldspar specimen`, packed between walls, with flat joints of four segments. The test is that of `feldspar lab`
// with its defaults, to its end or up to a strain; the plain code takes as many steps. The processor time of each is that of the
// test alone: the first search for contacts, steps, rows with their energies. plain.py runs it for the page.

#include "benchmarks/plain_laboratory.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_file.h"
#include "laboratory/compression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <oneapi/tbb/global_control.h>

#include <ctime>
#include <string>
#include <tuple>

namespace
{
using namespace feldspar;

template <typename Work>
double processor_seconds(const Work& work)
{
  const std::clock_t before = std::clock();
  work();
  return double(std::clock() - before) / CLOCKS_PER_SEC;
}

/// Number of the first cracks that are the same: broken segment and kind, in the order of their steps and joints.
std::size_t same_first_cracks(const std::vector<Crack>& one, std::vector<plain::Crack> two)
{
  const auto place = [](const auto& crack) { return std::tuple(crack.step, crack.joint, crack.segment); };
  std::sort(two.begin(), two.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  std::size_t n = 0;
  while (n < std::min(one.size(), two.size()) && one[n].joint == two[n].joint && one[n].segment == two[n].segment &&
         (one[n].kind == CrackKind::tension) == two[n].in_tension)
    ++n;
  return n;
}
} // namespace

int main(const int argc, char** const argv)
{
  if (argc < 4)
    {
      fmt::print(stderr, "laboratory_benchmark SPECIMEN.h5 direct_tension|uniaxial_compression TIMES [STOP_STRAIN]\n");
      return 2;
    }
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const auto specimen = read_specimen<2>(argv[1]);
  const bool pulls = std::string(argv[2]) == "direct_tension";
  TestParameters wanted;
  if (argc > 4)
    wanted.stop_strain = std::stod(argv[4]);
  const DynamicsParameters dynamics;
  const auto& tension = wanted.of<TensionParameters>();
  const auto& compression = wanted.of<CompressionParameters>();
  const double rate = pulls ? tension.strain_rate : compression.strain_rate;
  const double sampling_strain = pulls ? tension.sampling_strain : compression.sampling_strain;

  std::vector<double> seconds, plain_seconds;
  std::string figures;
  for (int k = 0; k < std::stoi(argv[3]); ++k)
    {
      LabTest<2> test({pulls ? direct_tension : uniaxial_compression}, specimen, wanted, dynamics);
      const auto by_engine = [&] {
        while (test.advance())
          ;
      };
      plain::Body body(specimen, pulls ? plain::Loading::tension : plain::Loading::compression, rate, dynamics.damping);
      std::vector<plain::Row> rows;
      seconds.push_back(processor_seconds(by_engine));
      plain_seconds.push_back(processor_seconds([&] { rows = body.run(test.n_steps(), sampling_strain); }));
      const TestRecord record = test.finish(false).record;
      double peak = 0.0, plain_peak = 0.0;
      for (const CurveSample& row : record.curve)
        peak = std::max(peak, std::abs(row.axial_stress));
      for (const plain::Row& row : rows)
        plain_peak = std::max(plain_peak, row.stress);
      figures = fmt::format(
        "\"steps\": {}, \"strain\": {:.4g}, \"rows\": {}, \"peak_MPa\": {:.4f}, \"plain_peak_MPa\": {:.4f}, "
        "\"cracks\": {}, \"plain_cracks\": {}, \"same_first_cracks\": {}",
        test.n_steps(), std::abs(record.curve.back().axial_strain), rows.size(), peak / 1e6, plain_peak / 1e6,
        record.cracks.size(), body.cracks.size(), same_first_cracks(record.cracks, body.cracks));
    }
  fmt::print("{{\"test\": \"{}\", \"grains\": {}, \"joints\": {}, \"gap_over_mean_radius\": {:.3g}, {}, "
             "\"processor_s\": [{:.4g}], \"plain_processor_s\": [{:.4g}]}}\n",
             argv[2], specimen.grains.size(), specimen.joints.size(), specimen.report.installation_gap_ratio, figures,
             fmt::join(seconds, ", "), fmt::join(plain_seconds, ", "));
}
