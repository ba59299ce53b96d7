#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_file.h"
#include "tests/unit/small_specimen.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace feldspar
{
namespace
{
using tests::has;

namespace fs = std::filesystem;

class SpecimenFile : public testing::Test
{
protected:
  fs::path file = fs::temp_directory_path() /
                  (std::string("specimen_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".h5");
  ~SpecimenFile() override { fs::remove(file); }

  std::string refusal() const
  {
    return tests::refusal([&] { read_specimen<2>(file); });
  }
};

TEST_F(SpecimenFile, ComesBackBitForBit)
{
  const auto specimen = small_specimen();
  write_specimen(specimen, file);
  const auto back = read_specimen<2>(file);
  EXPECT_EQ(back.size, specimen.size);
  EXPECT_EQ(back.seed, specimen.seed);
  EXPECT_EQ(back.grains.position, specimen.grains.position);
  EXPECT_EQ(back.grains.mass, specimen.grains.mass);
  EXPECT_EQ(back.grains.moment_of_inertia, specimen.grains.moment_of_inertia);
  EXPECT_EQ(back.joints.grain_2, specimen.joints.grain_2);
  EXPECT_EQ(back.joints.rest_distance, specimen.joints.rest_distance);
  EXPECT_EQ(back.joints.tensile_strength, specimen.joints.tensile_strength);
  EXPECT_EQ(back.joints.friction_slope, specimen.joints.friction_slope);
  EXPECT_EQ(back.report.installation_gap_ratio, specimen.report.installation_gap_ratio);
  EXPECT_EQ(head_of_specimen(file).dimension, 2u);
  EXPECT_EQ(head_of_specimen(file).n_grains, specimen.grains.size());
}

TEST_F(SpecimenFile, RefusesMissingForeignAndTruncatedFiles)
{
  EXPECT_TRUE(has(refusal(), "No such file"));

  std::ofstream(file) << "not HDF5 at all";
  EXPECT_TRUE(has(refusal(), "not an HDF5 file"));

  write_specimen(small_specimen(), file);
  const auto whole = fs::file_size(file);
  for (const double share : {0.1, 0.5, 0.9, 0.999})
    {
      write_specimen(small_specimen(), file);
      fs::resize_file(file, std::uintmax_t(share * double(whole)));
      EXPECT_NE(refusal(), "") << share;
    }
}

TEST_F(SpecimenFile, CheckpointsGoOnToTheSameBits)
{
  const auto specimen = small_specimen();
  const auto run = [](LabTest<2>& test, const int n_rows) {
    for (int n = 0; n < n_rows && test.advance(); ++n)
      ;
  };
  for (const LaboratoryCase& wanted : {LaboratoryCase{direct_tension}, LaboratoryCase{uniaxial_compression},
                                       LaboratoryCase{triaxial_compression, 20e6}})
    {
      LabTest<2> whole(wanted, specimen, {}, {});
      run(whole, 60);
      whole.write_checkpoint(file, "this one");
      LabTest<2> resumed(wanted, specimen, {}, {});
      resumed.read_checkpoint(file, "this one");
      run(whole, 60);
      run(resumed, 60);
      const auto a = whole.finish(true);
      const auto b = resumed.finish(true);
      ASSERT_EQ(a.record.curve.size(), b.record.curve.size());
      EXPECT_EQ(a.record.cracks.size(), b.record.cracks.size());
      EXPECT_EQ(a.record.curve.back().axial_stress, b.record.curve.back().axial_stress);
      EXPECT_EQ(a.record.curve.back().energies.damping, b.record.curve.back().energies.damping);
      EXPECT_EQ(a.appearance.grains_at_end.back().position, b.appearance.grains_at_end.back().position);

      LabTest<2> other(wanted, specimen, {}, {});
      EXPECT_THROW(other.read_checkpoint(file, "another one"), InputError);
      for (const auto& of_others : {granite_box(0.012, 0.012), granite_box(0.020, 0.040)})
        {
          ASSERT_NE(of_others.grains.size(), specimen.grains.size());
          LabTest<2> of_another(wanted, of_others, {}, {});
          EXPECT_THROW(of_another.read_checkpoint(file, "this one"), InputError);
        }
    }
}
} // namespace
} // namespace feldspar
