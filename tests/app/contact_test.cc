#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// `feldspar contact` against the closed forms of an intact joint and of its first break.
namespace feldspar::tests
{
namespace
{
// The joint of the input below.
constexpr double radius_1 = 1e-3;
constexpr double radius_2 = 2e-3;
constexpr double k_n = 80e9 / (radius_1 + radius_2); // [Pa/m]
constexpr double k_s = k_n / 1.25;
constexpr double face_length = 2.0 * radius_1; // of the smaller grain, λ = 1; 1 m thick [m]
constexpr int n_segments = 4;

const std::string input = section("Contact path", "File = path.csv") +
                          section("Contact", "Radius 1 = 1 mm", "Radius 2 = 2 mm") +
                          section("Flat joint", "Segments = 4", "Modulus = 80 GPa", "Stiffness ratio = 1.25",
                                  "Bond tensile strength = 22 MPa", "Bond cohesion = 400 MPa", "Friction = 0.5");

using Rows = std::vector<std::vector<double>>;

/// A table without its header.
Rows read_rows(const std::filesystem::path& file)
{
  Rows rows;
  std::istringstream stream(content(file));
  std::string line;
  for (std::getline(stream, line); std::getline(stream, line);)
    {
      rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');)
        rows.back().push_back(std::strtod(cell.c_str(), nullptr));
    }
  return rows;
}

/// In the folder: what an input makes of a path.
Rows run_contact(const TemporaryFolder& folder, const std::string& of_input, const std::string& path,
                 const std::string& environment = "")
{
  folder.write("path.csv", path);
  folder.write("joint.prm", of_input);
  run_to_end(folder, "contact joint.prm --output results --force", environment);
  return read_rows(folder / "results/contact.csv");
}

const std::string header = "normal_m,shear_m,rotation_rad\n";

Rows run_contact(const std::string& path) { return run_contact(TemporaryFolder(), input, header + path); }

double sigma(const std::vector<double>& row, const int segment) { return row.at(3 + 3 * (segment - 1)); }

double tau(const std::vector<double>& row, const int segment) { return row.at(4 + 3 * (segment - 1)); }

double bonded(const std::vector<double>& row, const int segment) { return row.at(5 + 3 * (segment - 1)); }

void expect_near(const double found, const double expected)
{
  EXPECT_NEAR(found, expected, 1e-12 * std::abs(expected)); // a few roundings
}

TEST(Contact, NamesItsColumns)
{
  const TemporaryFolder folder;
  run_contact(folder, input, header + "0,0,0\n");
  EXPECT_TRUE(content(folder / "results/contact.csv")
                .starts_with("normal_force_N,shear_force_N,moment_Nm,sigma_1_Pa,tau_1_Pa,bonded_1,sigma_2_Pa,tau_2_Pa,"
                             "bonded_2,sigma_3_Pa,tau_3_Pa,bonded_3,sigma_4_Pa,tau_4_Pa,bonded_4\n"));
}

TEST(Contact, ABondThatSoftensLosesItsTensionOverItsOpening)
{
  // Strength 22 MPa at an opening of 0.825 µm; half of the fall at 2.825 µm, all of it beyond 4.825 µm.
  const Rows rows = run_contact(TemporaryFolder(),
                                section("Specimen", "Joint law = softening flat joint") +
                                  replaced(input, "Flat joint", "Softening flat joint") +
                                  section("Softening flat joint", "Softening opening = 4 um"),
                                header + "0.825e-6,0,0\n2.825e-6,0,0\n4.9e-6,0,0\n-1e-7,0,0\n");
  ASSERT_EQ(rows.size(), 4u);
  const std::vector<double> stress{22e6, 11e6, 0.0, -k_n * 1e-7};
  for (int i = 1; i <= n_segments; ++i)
    for (std::size_t row = 0; row < stress.size(); ++row)
      {
        EXPECT_NEAR(sigma(rows[row], i), stress[row], 1e-9 * 22e6);
        EXPECT_EQ(bonded(rows[row], i), row < 2);
      }
}

TEST(Contact, RefusesWhatNeedsASpecimenByName)
{
  const TemporaryFolder folder;
  folder.write("path.csv", header + "0,0,0\n");
  folder.write("clumps.prm", input + section("Clumps", "Diameter = 4 mm"));
  folder.write("minerals.prm", input + section("Mineral grains", "Mean size = 5 mm") +
                                 section("Smooth joint", "Tensile strength = 0 MPa"));
  for (const auto& [name, entry] :
       {std::pair("clumps.prm", "Clumps/Diameter = 4 mm"), {"minerals.prm", "Mineral grains/Mean size = 5 mm"}})
    expect_refused(
      folder, fmt::format("contact {} --output results", name),
      fmt::format("feldspar: {}: {}: one contact of two grains has no use for it; leave it out\n", name, entry));
}

TEST(Contact, IntactJointIsLinear)
{
  // Within the strengths: tension 22 MPa at an opening of 0.8 µm, shear 400 MPa at 18 µm.
  constexpr double normal = 1e-7;
  constexpr double shear = 2e-6;
  constexpr double rotation = 2e-4;
  const Rows rows = run_contact("0,0,0\n1e-7,0,0\n-1e-7,0,0\n-1e-7,2e-6,0\n-1e-7,2e-6,2e-4\n0,0,0\n");
  ASSERT_EQ(rows.size(), 6u);
  for (const std::vector<double>& row : rows)
    {
      ASSERT_EQ(row.size(), 3u + 3u * n_segments);
      for (int i = 1; i <= n_segments; ++i)
        EXPECT_EQ(bonded(row, i), 1.0);
    }
  for (const double value : {rows[0][0], rows[0][1], rows[0][2], sigma(rows[0], 1)})
    EXPECT_EQ(value, 0.0);

  // Opening is tension: the normal force, compression positive, is negative and the stress positive.
  expect_near(rows[1][0], -k_n * face_length * normal);
  expect_near(sigma(rows[1], 1), k_n * normal);
  expect_near(rows[2][0], k_n * face_length * normal);
  expect_near(sigma(rows[2], 4), -k_n * normal);

  // Grain 2 moved along t is drawn back.
  expect_near(rows[3][1], -k_s * face_length * shear);
  for (int i = 1; i <= n_segments; ++i)
    expect_near(tau(rows[3], i), -k_s * shear);

  // Turned by θ, the face gives the couple -k_n θ I, I = (2R̄)³/12, whatever N; segment 1 (ρ > 0) is pressed by θρ.
  expect_near(rows[4][2], -k_n * rotation * std::pow(face_length, 3) / 12.0);
  const double rho_1 = 0.5 * face_length * (n_segments - 1.0) / n_segments;
  expect_near(sigma(rows[4], 1), k_n * (-normal - rotation * rho_1));
  expect_near(sigma(rows[4], 4), k_n * (-normal + rotation * rho_1));

  // Back at rest: no more than the round-off of the shear's way there and back.
  EXPECT_EQ(rows[5][0], 0.0);
  EXPECT_EQ(rows[5][1], 0.0);
  EXPECT_EQ(rows[5][2], 0.0);
}

TEST(Contact, BreaksInTensionBeyondItsMeanStrength)
{
  // 22 MPa / k_n = 0.825 µm. The input leaves the standard deviations at their defaults: they must not enter.
  const Rows rows = run_contact("8.24e-7,0,0\n8.26e-7,0,0\n-1e-7,0,0\n");
  for (int i = 1; i <= n_segments; ++i)
    {
      EXPECT_EQ(bonded(rows[0], i), 1.0);
      EXPECT_EQ(bonded(rows[1], i), 0.0);
      EXPECT_EQ(sigma(rows[1], i), 0.0);
    }
  EXPECT_EQ(rows[1][0], 0.0);
  expect_near(rows[2][0], k_n * face_length * 1e-7); // the broken face still closes
}

TEST(Contact, ARowIsOneUpdate)
{
  // Broken and 0.5 µm open, the joint moves by 1 µm towards closing and by 1 µm in shear. It is closed for half of the
  // row: the shear k_s · 0.5 µm = 10.7 MPa is beyond the friction 0.5 · k_n · 0.5 µm = 6.7 MPa, and the faces slide.
  const Rows rows = run_contact("1e-6,0,0\n5e-7,0,0\n-5e-7,1e-6,0\n");
  for (int i = 1; i <= n_segments; ++i)
    expect_near(tau(rows[2], i), -0.5 * k_n * 5e-7);

  // With a tenth of the shear they stick, at half of k_s · 0.1 µm; the whole increment would give twice that.
  const Rows sticking = run_contact("1e-6,0,0\n5e-7,0,0\n-5e-7,1e-7,0\n");
  for (int i = 1; i <= n_segments; ++i)
    expect_near(tau(sticking[2], i), -k_s * 0.5e-7);
}

TEST(Contact, TwistsAndBendsInThreeDimensions)
{
  // The pair of the two-grain verification, as in tests/unit/space_joint_test.cc: R̄ = λR = 5 mm, k_n = E/2R.
  const TemporaryFolder folder;
  const Rows rows =
    run_contact(folder,
                section("Specimen", "Dimension = 3") + section("Contact path", "File = path.csv") +
                  section("Contact", "Radius 1 = 6.25 mm", "Radius 2 = 6.25 mm") +
                  section("Flat joint", "Rings = 2", "Sectors = 8", "Modulus = 29 GPa", "Stiffness ratio = 2.3",
                          "Radius multiplier = 0.8", "Bond tensile strength = 1e9 GPa", "Bond cohesion = 1e9 GPa"),
                "normal_m,shear_1_m,shear_2_m,twist_rad,bend_1_rad,bend_2_rad\n0,0,0,0,0,0\n"
                "1e-3,0,0,0,0,0\n0,1e-6,-2e-6,0,0,0\n0,0,0,0.2,0,0\n0,0,0,0,0.4,0\n0,0,0,0,0,0.4\n");
  EXPECT_TRUE(content(folder / "results/contact.csv")
                .starts_with("normal_force_N,shear_force_1_N,shear_force_2_N,twist_moment_Nm,bend_moment_1_Nm,"
                             "bend_moment_2_Nm,sigma_1_Pa,tau_1_1_Pa,tau_2_1_Pa,bonded_1,"));
  ASSERT_EQ(rows.size(), 6u);
  ASSERT_EQ(rows[0].size(), 6u + 16u * 4u);
  constexpr double pi = std::numbers::pi;
  constexpr double normal_stiffness = 29e9 / 12.5e-3;
  const double area = pi * 25e-6;
  const double chord = std::sin(pi / 8.0) / (pi / 8.0);
  const double polar = pi * (1.0 / 36.0 + 49.0 / 108.0) * chord * chord * std::pow(5e-3, 4); // lumped Σ A r²
  expect_near(rows[1][0], -normal_stiffness * area * 1e-3);
  // The shear stresses of sixteen elements, summed up.
  EXPECT_NEAR(rows[2][1], -normal_stiffness / 2.3 * area * 1e-6, 1e-9 * 1e2);
  EXPECT_NEAR(rows[2][2], normal_stiffness / 2.3 * area * 2e-6, 1e-9 * 1e2);
  EXPECT_NEAR(rows[3][3], -normal_stiffness / 2.3 * polar * 0.2, 1e-9 * 181.0);
  EXPECT_NEAR(rows[4][4], -normal_stiffness * 0.5 * polar * 0.4, 1e-9 * 416.0);
  EXPECT_NEAR(rows[5][5], -normal_stiffness * 0.5 * polar * 0.4, 1e-9 * 416.0);
}

TEST(Contact, RefusesAResponseBeyondTheRangeOfNumbers)
{
  const TemporaryFolder folder;
  folder.write("joint.prm", input);
  for (const char* const row : {"-1e308,0,0", "0,0,-1e308", "-1e300,1e300,1e300"})
    {
      folder.write("path.csv", fmt::format("{}1e-9,0,0\n{}\n", header, row));
      // Bonds that hold, so that the far row meets the joint as it was made.
      expect_refused(folder,
                     "contact joint.prm --output results --set 'Flat joint/Bond tensile strength = 1e29 Pa' "
                     "--set 'Flat joint/Bond cohesion = 1e29 Pa'",
                     "path.csv: row 2 below the header: the response is beyond the range of numbers: a displacement, a "
                     "rotation or a stiffness is far too large\n");
    }
}

TEST(Contact, WritesTheSameWhereTheDecimalSignIsAComma)
{
  const TemporaryFolder folder;
  make_german_locale(folder.path());
  const std::string german = "LOCPATH='" + folder.path().string() + "' LC_ALL=de_DE.UTF-8";
  EXPECT_EQ(run_contact(folder, input, header + "1.5e-7,2.5e-6,1e-4\n", german), run_contact("1.5e-7,2.5e-6,1e-4\n"));
}
} // namespace
} // namespace feldspar::tests
