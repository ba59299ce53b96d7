// Times of calls of the library's face from C++, as JSON, for benchmarks/python_calls.py: seconds of one call.

#include <feldspar/feldspar.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace
{
/// The least processor time of a call over several rounds [s].
template <typename Call>
double least(const int rounds, const int calls, const Call& call)
{
  double time = 1e9;
  for (int round = 0; round < rounds; ++round)
    {
      const std::clock_t begin = std::clock();
      for (int k = 0; k < calls; ++k)
        call();
      time = std::min(time, double(std::clock() - begin) / CLOCKS_PER_SEC / calls);
    }
  return time;
}
} // namespace

int main()
{
  feldspar::set_threads(1);
  feldspar::Input cell;
  cell.set("Specimen/Shape", "periodic");
  cell.set("Specimen/Width", "10 mm");
  cell.set("Specimen/Height", "10 mm");
  const feldspar::Specimen specimen(cell, 1);
  const feldspar::Rve rve(specimen, cell);
  const std::vector<double> strain{0.0, 1e-5, 0.0};
  const double scalar = least(20, 2000, [&] { rve.trial(strain).stress(); });

  constexpr std::size_t n = 10000;
  feldspar::Volumes volumes({&specimen, 1}, cell, n);
  std::vector<double> strains;
  for (std::size_t k = 0; k < n; ++k)
    strains.insert(strains.end(), strain.begin(), strain.end());
  std::vector<double> stresses(3 * n), tangents(9 * n);
  const double batch = least(20, 5, [&] { volumes.update(strains, 0, stresses); });
  const double with_tangents = least(20, 5, [&] { volumes.update(strains, 0, stresses, tangents); });

  feldspar::Input rock;
  rock.set("Specimen/Width", "20 mm");
  rock.set("Specimen/Height", "40 mm");
  const feldspar::Specimen body(rock, 1);
  const double test = least(5, 1, [&] {
    feldspar::Test running(body, rock, "uniaxial_compression");
    while (running.advance())
      ;
  });
  std::printf(
    "{\"scalar trial\": %.9g, \"10000 volumes\": %.9g, \"10000 volumes with tangents\": %.9g, \"test\": %.9g}\n",
    scalar, batch, with_tangents, test);
}
