// Breaks a specimen of rock in uniaxial compression: an input, a specimen, a test, its curve.
//
//   cmake -B build && cmake --build build && build/uniaxial_compression

#include <feldspar/feldspar.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace
{
double last(const feldspar::Test& test, const char* column)
{
  const auto columns = test.columns();
  return test.last_row()[std::size_t(std::find(columns.begin(), columns.end(), column) - columns.begin())];
}

void compress()
{
  // The rock: what differs from the presets, which are those of Beishan granite.
  feldspar::Input rock;
  rock.set("Specimen/Width", "20 mm");
  rock.set("Specimen/Height", "40 mm");
  rock.set("Flat joint/Bond cohesion", "180 MPa");

  // The specimen: the seed fixes every grain.
  const feldspar::Specimen specimen(rock, 1);
  std::printf("# %s, %zu grains\n", feldspar::version().c_str(), specimen.grains().front().values.size());

  // The test, row by row of its curve; compression positive.
  feldspar::Test test(specimen, rock, "uniaxial_compression");
  double peak = 0.0;
  std::printf("strain,stress_MPa,cracks\n");
  while (test.advance())
    {
      const double stress = last(test, "axial_stress_Pa");
      peak = std::max(peak, stress);
      if (test.n_rows() % 20 == 0)
        std::printf("%.5f,%.3f,%.0f\n", last(test, "axial_strain"), stress / 1e6,
                    last(test, "n_tension_cracks") + last(test, "n_shear_cracks"));
    }
  std::printf("# compressive strength %.2f MPa\n", peak / 1e6);
}
} // namespace

int main()
{
  try
    {
      compress();
    }
  catch (const feldspar::Error& error) // one line for the user
    {
      std::fprintf(stderr, "%s\n", error.what());
      return 2;
    }
  return EXIT_SUCCESS;
}
