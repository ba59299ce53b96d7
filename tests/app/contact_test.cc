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
namespace feldspar
{
namespace
{
using tests::run_feldspar;
using tests::TemporaryFolder;

// The joint of the input below.
constexpr double radius_1 = 1e-3;
constexpr double radius_2 = 2e-3;
constexpr double k_n = 80e9 / (radius_1 + radius_2); // [Pa/m]
constexpr double k_s = k_n / 1.25;
constexpr double face_length = 2.0 * radius_1; // of the smaller grain, λ = 1; 1 m thick [m]
constexpr int n_segments = 4;

constexpr std::string_view input = R"(subsection Contact path
  set File = path.csv
end
subsection Contact
  set Radius 1 = 1 mm
  set Radius 2 = 2 mm
end
subsection Flat joint
  set Segments = 4
  set Modulus = 80 GPa
  set Stiffness ratio = 1.25
  set Bond tensile strength = 22 MPa
  set Bond cohesion = 400 MPa
  set Friction = 0.5
end
)";

struct Table
{
  std::string header;
  std::vector<std::vector<double>> rows;
};

Table read_table(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  Table table;
  std::getline(stream, table.header);
  for (std::string line; std::getline(stream, line);)
    {
      std::vector<double> row;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');)
        {
          double value = std::nan("");
          std::from_chars(cell.data(), cell.data() + cell.size(), value);
          row.push_back(value);
        }
      table.rows.push_back(row);
    }
  return table;
}

Table run_contact(const std::string& path, const std::string& environment = "")
{
  const TemporaryFolder folder;
  folder.write("path.csv", "normal_m,shear_m,rotation_rad\n" + path);
  folder.write("joint.prm", input);
  const auto outcome = run_feldspar(folder.path(), "contact joint.prm --output results", environment);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  return read_table(folder.path() / "results/contact.csv");
}

double sigma(const std::vector<double>& row, const int segment) { return row.at(3 + 3 * (segment - 1)); }

double tau(const std::vector<double>& row, const int segment) { return row.at(4 + 3 * (segment - 1)); }

double bonded(const std::vector<double>& row, const int segment) { return row.at(5 + 3 * (segment - 1)); }

void expect_near(const double found, const double expected)
{
  EXPECT_NEAR(found, expected, 1e-12 * std::abs(expected)); // a few roundings
}

TEST(Contact, NamesItsColumns)
{
  EXPECT_EQ(run_contact("0,0,0\n").header,
            "normal_force_N,shear_force_N,moment_Nm,sigma_1_Pa,tau_1_Pa,bonded_1,sigma_2_Pa,tau_2_Pa,bonded_2,"
            "sigma_3_Pa,tau_3_Pa,bonded_3,sigma_4_Pa,tau_4_Pa,bonded_4");
}

TEST(Contact, ABondThatSoftensLosesItsTensionOverItsOpening)
{
  const TemporaryFolder folder;
  // Strength 22 MPa at an opening of 0.825 µm; half of the fall at 2.825 µm, all of it beyond 4.825 µm.
  folder.write("path.csv", "normal_m,shear_m,rotation_rad\n0.825e-6,0,0\n2.825e-6,0,0\n4.9e-6,0,0\n-1e-7,0,0\n");
  std::string softening(input);
  softening.replace(softening.find("Flat joint"), 10, "Softening flat joint");
  folder.write("joint.prm", "subsection Specimen\n  set Joint law = softening flat joint\nend\n" + softening +
                              "subsection Softening flat joint\n  set Softening opening = 4 um\nend\n");
  const auto outcome = run_feldspar(folder.path(), "contact joint.prm --output results");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const Table table = read_table(folder.path() / "results/contact.csv");
  ASSERT_EQ(table.rows.size(), 4u);
  const std::vector<double> stress{22e6, 11e6, 0.0, -k_n * 1e-7};
  for (int i = 1; i <= n_segments; ++i)
    for (std::size_t row = 0; row < stress.size(); ++row)
      {
        EXPECT_NEAR(sigma(table.rows[row], i), stress[row], 1e-9 * 22e6);
        EXPECT_EQ(bonded(table.rows[row], i), row < 2);
      }
}

TEST(Contact, RefusesWhatNeedsASpecimenByName)
{
  const TemporaryFolder folder;
  folder.write("path.csv", "normal_m,shear_m,rotation_rad\n0,0,0\n");
  folder.write("clumps.prm", std::string(input) + "subsection Clumps\n  set Diameter = 4 mm\nend\n");
  folder.write("minerals.prm", std::string(input) + "subsection Mineral grains\n  set Mean size = 5 mm\nend\n" +
                                 "subsection Smooth joint\n  set Tensile strength = 0 MPa\nend\n");
  for (const auto& [name, entry] : {std::pair("clumps.prm", "Clumps/Diameter = 4 mm"),
                                    std::pair("minerals.prm", "Mineral grains/Mean size = 5 mm")})
    {
      const auto outcome = run_feldspar(folder.path(), std::string("contact ") + name + " --output results");
      EXPECT_EQ(outcome.exit_code, 2);
      EXPECT_EQ(outcome.error, std::string("feldspar: ") + name + ": " + entry +
                                 ": one contact of two grains has no use for it; leave it out\n");
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results"));
    }
}

TEST(Contact, IntactJointIsLinear)
{
  // Within the strengths: tension 22 MPa at an opening of 0.8 µm, shear 400 MPa at 18 µm.
  constexpr double normal = 1e-7;
  constexpr double shear = 2e-6;
  constexpr double rotation = 2e-4;
  const Table table = run_contact("0,0,0\n1e-7,0,0\n-1e-7,0,0\n-1e-7,2e-6,0\n-1e-7,2e-6,2e-4\n0,0,0\n");
  ASSERT_EQ(table.rows.size(), 6u);
  for (const std::vector<double>& row : table.rows)
    {
      ASSERT_EQ(row.size(), 3u + 3u * n_segments);
      for (int i = 1; i <= n_segments; ++i)
        EXPECT_EQ(bonded(row, i), 1.0);
    }
  for (const double value : {table.rows[0][0], table.rows[0][1], table.rows[0][2], sigma(table.rows[0], 1)})
    EXPECT_EQ(value, 0.0);

  // Opening is tension: the normal force, compression positive, is negative and the stress positive.
  expect_near(table.rows[1][0], -k_n * face_length * normal);
  expect_near(sigma(table.rows[1], 1), k_n * normal);
  expect_near(table.rows[2][0], k_n * face_length * normal);
  expect_near(sigma(table.rows[2], 4), -k_n * normal);

  // Grain 2 moved along t is drawn back.
  expect_near(table.rows[3][1], -k_s * face_length * shear);
  for (int i = 1; i <= n_segments; ++i)
    expect_near(tau(table.rows[3], i), -k_s * shear);

  // Turned by θ, the face gives the couple -k_n θ I, I = (2R̄)³/12, whatever N; segment 1 (ρ > 0) is pressed by θρ.
  expect_near(table.rows[4][2], -k_n * rotation * std::pow(face_length, 3) / 12.0);
  const double rho_1 = 0.5 * face_length * (n_segments - 1.0) / n_segments;
  expect_near(sigma(table.rows[4], 1), k_n * (-normal - rotation * rho_1));
  expect_near(sigma(table.rows[4], 4), k_n * (-normal + rotation * rho_1));

  // Back at rest: no more than the round-off of the shear's way there and back.
  EXPECT_EQ(table.rows[5][0], 0.0);
  EXPECT_EQ(table.rows[5][1], 0.0);
  EXPECT_EQ(table.rows[5][2], 0.0);
}

TEST(Contact, BreaksInTensionBeyondItsMeanStrength)
{
  // 22 MPa / k_n = 0.825 µm. The input leaves the standard deviations at their defaults: they must not enter.
  const Table table = run_contact("8.24e-7,0,0\n8.26e-7,0,0\n-1e-7,0,0\n");
  for (int i = 1; i <= n_segments; ++i)
    {
      EXPECT_EQ(bonded(table.rows[0], i), 1.0);
      EXPECT_EQ(bonded(table.rows[1], i), 0.0);
      EXPECT_EQ(sigma(table.rows[1], i), 0.0);
    }
  EXPECT_EQ(table.rows[1][0], 0.0);
  expect_near(table.rows[2][0], k_n * face_length * 1e-7); // the broken face still closes
}

TEST(Contact, ARowIsOneUpdate)
{
  // Broken and 0.5 µm open, the joint moves by 1 µm towards closing and by 1 µm in shear. It is closed for half of the
  // row: the shear k_s · 0.5 µm = 10.7 MPa is beyond the friction 0.5 · k_n · 0.5 µm = 6.7 MPa, and the faces slide.
  const Table table = run_contact("1e-6,0,0\n5e-7,0,0\n-5e-7,1e-6,0\n");
  for (int i = 1; i <= n_segments; ++i)
    expect_near(tau(table.rows[2], i), -0.5 * k_n * 5e-7);

  // With a tenth of the shear they stick, at half of k_s · 0.1 µm; the whole increment would give twice that.
  const Table sticking = run_contact("1e-6,0,0\n5e-7,0,0\n-5e-7,1e-7,0\n");
  for (int i = 1; i <= n_segments; ++i)
    expect_near(tau(sticking.rows[2], i), -k_s * 0.5e-7);
}

TEST(Contact, TwistsAndBendsInThreeDimensions)
{
  // The pair of the two-grain verification, as in tests/unit/space_joint_test.cc: R̄ = λR = 5 mm, k_n = E/2R.
  const TemporaryFolder folder;
  folder.write("path.csv", "normal_m,shear_1_m,shear_2_m,twist_rad,bend_1_rad,bend_2_rad\n0,0,0,0,0,0\n"
                           "1e-3,0,0,0,0,0\n0,1e-6,-2e-6,0,0,0\n0,0,0,0.2,0,0\n0,0,0,0,0.4,0\n0,0,0,0,0,0.4\n");
  folder.write("joint.prm", R"(subsection Specimen
  set Dimension = 3
end
subsection Contact path
  set File = path.csv
end
subsection Contact
  set Radius 1 = 6.25 mm
  set Radius 2 = 6.25 mm
end
subsection Flat joint
  set Rings = 2
  set Sectors = 8
  set Modulus = 29 GPa
  set Stiffness ratio = 2.3
  set Radius multiplier = 0.8
  set Bond tensile strength = 1e9 GPa
  set Bond cohesion = 1e9 GPa
end
)");
  const auto outcome = run_feldspar(folder.path(), "contact joint.prm --output results");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const Table table = read_table(folder.path() / "results/contact.csv");
  EXPECT_TRUE(table.header.starts_with(
    "normal_force_N,shear_force_1_N,shear_force_2_N,twist_moment_Nm,bend_moment_1_Nm,bend_moment_2_Nm,"
    "sigma_1_Pa,tau_1_1_Pa,tau_2_1_Pa,bonded_1,"))
    << table.header;
  ASSERT_EQ(table.rows.size(), 6u);
  ASSERT_EQ(table.rows[0].size(), 6u + 16u * 4u);
  constexpr double pi = std::numbers::pi;
  constexpr double normal_stiffness = 29e9 / 12.5e-3;
  const double area = pi * 25e-6;
  const double chord = std::sin(pi / 8.0) / (pi / 8.0);
  const double polar = pi * (1.0 / 36.0 + 49.0 / 108.0) * chord * chord * std::pow(5e-3, 4); // lumped Σ A r²
  expect_near(table.rows[1][0], -normal_stiffness * area * 1e-3);
  // The shear stresses of sixteen elements, summed up.
  EXPECT_NEAR(table.rows[2][1], -normal_stiffness / 2.3 * area * 1e-6, 1e-9 * 1e2);
  EXPECT_NEAR(table.rows[2][2], normal_stiffness / 2.3 * area * 2e-6, 1e-9 * 1e2);
  EXPECT_NEAR(table.rows[3][3], -normal_stiffness / 2.3 * polar * 0.2, 1e-9 * 181.0);
  EXPECT_NEAR(table.rows[4][4], -normal_stiffness * 0.5 * polar * 0.4, 1e-9 * 416.0);
  EXPECT_NEAR(table.rows[5][5], -normal_stiffness * 0.5 * polar * 0.4, 1e-9 * 416.0);
}

TEST(Contact, RefusesAResponseBeyondTheRangeOfNumbers)
{
  const TemporaryFolder folder;
  folder.write("joint.prm", input);
  for (const char* const row : {"-1e308,0,0", "0,0,-1e308", "-1e300,1e300,1e300"})
    {
      folder.write("path.csv", fmt::format("normal_m,shear_m,rotation_rad\n1e-9,0,0\n{}\n", row));
      // Bonds that hold, so that the far row meets the joint as it was made.
      const auto outcome =
        run_feldspar(folder.path(), "contact joint.prm --output results --set 'Flat joint/Bond tensile "
                                    "strength = 1e29 Pa' --set 'Flat joint/Bond cohesion = 1e29 Pa'");
      EXPECT_EQ(outcome.exit_code, 2) << row;
      EXPECT_TRUE(outcome.error.starts_with("feldspar: ") &&
                  outcome.error.ends_with(
                    "path.csv: row 2 below the header: the response is beyond the range of numbers: a displacement, a "
                    "rotation or a stiffness is far too large\n"))
        << outcome.error;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << row;
    }
}

TEST(Contact, WritesTheSameWhereTheDecimalSignIsAComma)
{
  const TemporaryFolder folder;
  tests::make_german_locale(folder.path());
  const std::string german = "LOCPATH='" + folder.path().string() + "' LC_ALL=de_DE.UTF-8";
  EXPECT_EQ(run_contact("1.5e-7,2.5e-6,1e-4\n", german).rows, run_contact("1.5e-7,2.5e-6,1e-4\n").rows);
}
} // namespace
} // namespace feldspar
