#include "tests/temporary_folder.h"

#include <feldspar/feldspar.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

/// The generic interface of MFront behaviours, called as MGIS calls it.
namespace
{
struct StateView
{
  double* gradients;
  double* thermodynamic_forces;
  double* mass_density;
  double* material_properties;
  double* internal_state_variables;
  double* stored_energy;
  double* dissipated_energy;
  double* external_state_variables;
};

struct BehaviourDataView
{
  char* error_message;
  double dt;
  double* K;
  double* rdt;
  double* speed_of_sound;
  StateView s0;
  StateView s1;
};

extern "C" int Feldspar_Tridimensional(BehaviourDataView*);

/// Data of a point, and one call of its behaviour.
struct Point
{
  std::array<double, 6> strain0{}, strain1{}, stress0{}, stress1{};
  std::array<double, 11> states0{}, states1{};
  std::array<double, 36> tangent{};
  double number = 3e9; // of any size
  std::string error = std::string(512, '\0');

  int integrate()
  {
    double rdt = 1.0;
    tangent[0] = 4.0; // the consistent tangent
    BehaviourDataView data{
      error.data(),
      1.0,
      tangent.data(),
      &rdt,
      nullptr,
      {strain0.data(), stress0.data(), nullptr, &number, states0.data(), nullptr, nullptr, nullptr},
      {strain1.data(), stress1.data(), nullptr, &number, states1.data(), nullptr, nullptr, nullptr}};
    return Feldspar_Tridimensional(&data);
  }

  void accept()
  {
    strain0 = strain1;
    stress0 = stress1;
    states0 = states1;
  }
};

// xx, yy, zz, √2 xy, √2 xz, √2 yz stand for xx, yy, zz, yz, xz, xy with engineering shear: strains times √2 there, stresses
// over √2. Lagged: what an accepted strain breaks is seen by the increment after it.
TEST(Mgis, TakesTheWayOfTheLibrary)
{
  const feldspar::tests::TemporaryFolder folder;
  folder.write(
    "rock.prm",
    "subsection Specimen\n  set Dimension = 3\n  set Shape = periodic\n  set Width = 6 mm\n  set Height = 6 mm\n"
    "end\nsubsection Sample\n  set Realisations = 1\n  set Orientation = fixed\nend\n");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  setenv("FELDSPAR_MATERIAL", "rock", 1);
  const feldspar::Input input("rock.prm");
  feldspar::Rve rve(feldspar::Specimen(input, 1), input);
  Point point;
  const double root = std::sqrt(2.0);
  const std::array<double, 6> end{2e-5, -3e-5, 4e-4, 1e-4, -5e-5, 8e-5}; // Feldspar's
  constexpr std::array<std::size_t, 6> places{0, 1, 2, 5, 4, 3};
  std::size_t n_breaks = 0;
  for (int k = 1; k <= 10; ++k)
    {
      std::array<double, 6> strain = end;
      for (std::size_t c = 0; c < 6; ++c)
        {
          strain[c] *= 0.1 * k;
          point.strain1[places[c]] = strain[c] / (c < 3 ? 1.0 : root);
        }
      ASSERT_EQ(point.integrate(), 1) << point.error;
      const feldspar::Trial expected = rve.trial(strain, true);
      const auto stress = expected.stress();
      const auto tangent = expected.tangent();
      for (std::size_t a = 0; a < 6; ++a)
        {
          const double of_a = a < 3 ? 1.0 : root;
          EXPECT_NEAR(point.stress1[places[a]], of_a * stress[a], 1e-6 * std::abs(stress[2])) << k;
          for (std::size_t b = 0; b < 6; ++b)
            EXPECT_NEAR(point.tangent[6 * places[a] + places[b]], of_a * (b < 3 ? 1.0 : root) * tangent[6 * a + b],
                        1e-4 * tangent[14]); // that of zz
        }
      point.accept();
      rve.accept(expected);
      const feldspar::Trial broken = rve.relax(strain);
      n_breaks += broken.n_breaks();
      rve.accept(broken);
    }
  EXPECT_GT(n_breaks, 0u);
  EXPECT_GT(point.states1[1], 0.0); // the share of broken segments

  Point unknown;
  unknown.strain0[0] = 1e-5; // at token 0: a restarted job, of which there is no log for this point
  unknown.number = 99.0;
  EXPECT_EQ(unknown.integrate(), -1);
  std::filesystem::current_path(before);
  EXPECT_NE(unknown.error.find("has no strain from which element 0, point 99 goes on"), std::string::npos);
}
} // namespace
