// Units in the headers of tables: the same numbers as in SI.

#include "app/input/maps/traces.h"
#include "app/input/strain_path.h"
#include "base/table/csv.h"
#include "laboratory/loading_stages.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>
#include <variant>

namespace feldspar
{
namespace
{
using tests::has;

class HeaderUnits : public testing::Test
{
protected:
  void refuse(const std::function<void()>& read, const std::string& words) const
  {
    EXPECT_TRUE(has(tests::refusal(read), words));
  }

  std::vector<PathLeg<2>> path(const std::string& text) const
  {
    StrainPathParameters wanted;
    wanted.path_file = folder.write("path.csv", text).string();
    return path_legs<2>(wanted);
  }

  tests::TemporaryFolder folder;
};

TEST_F(HeaderUnits, OfLoadingTables)
{
  const auto stages =
    read_loading_stages(folder.write("s.csv", "Axial strain [%];Axial_Stress (MPa);hold [ms];confining_pressure / MPa;"
                                              "strain_rate [1/s];lateral_strain [µε]\n0,4;;;5;2;\n;60;;;;\n;;0,2;10;;\n"
                                              ";;;;0,25;-2000\n"));
  ASSERT_EQ(stages.size(), 4u);
  EXPECT_DOUBLE_EQ(stages[0].axial_strain.value(), 0.004);
  EXPECT_DOUBLE_EQ(stages[0].confining_pressure, 5e6);
  EXPECT_DOUBLE_EQ(stages[0].strain_rate.value(), 2.0);
  EXPECT_DOUBLE_EQ(stages[1].axial_stress.value(), 60e6);
  EXPECT_DOUBLE_EQ(stages[2].duration.value(), 2e-4);
  EXPECT_DOUBLE_EQ(stages[3].lateral_strain.value(), -2e-3);
  const auto read = [&](const std::string& text) {
    return [&, text] { read_loading_stages(folder.write("s.csv", text)); };
  };
  refuse(read("axial_stress\n60\n"), "s.csv:1: \"axial_stress\": has no unit; write it as in \"axial stress [Pa]\"");
  refuse(read("axial_stress [mm]\n60\n"), "\"mm\" is not the unit of a stress");
  refuse(read("axial_strain,axial_strain [%]\n0.1,1\n"), "is there twice");
}

TEST_F(HeaderUnits, OfStrainPathsInAnyOrder)
{
  const auto legs = path("stress_yy [MPa],strain_xx [1e-6],strain_xy [%]\n-5,100,0.01\n");
  ASSERT_EQ(legs.size(), 1u);
  EXPECT_DOUBLE_EQ(legs[0].target.stress[1], -5e6);
  EXPECT_DOUBLE_EQ(legs[0].target.strain[0], 1e-4);
  EXPECT_DOUBLE_EQ(legs[0].target.strain[2], 2e-4); // γ = 2ε
  EXPECT_TRUE(legs[0].target.stress_given[1]);
  EXPECT_FALSE(legs[0].target.stress_given[0]);
  refuse([&] { path("strain_xx,strain_yy,stress_xy\n0,0,0\n"); }, "\"stress_xy\": has no unit");
}

TEST_F(HeaderUnits, OfOtherTables)
{
  const auto rows =
    read_csv(folder.write("t.csv", "rotation [deg],normal [mm],shear (µm)\n90,1,2\n"), "normal_m,shear_m,rotation_rad");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_DOUBLE_EQ(rows[0][0], 1e-3);
  EXPECT_DOUBLE_EQ(rows[0][1], 2e-6);
  EXPECT_DOUBLE_EQ(rows[0][2], 0.5 * std::numbers::pi);
}

TEST_F(HeaderUnits, OfJointMaps)
{
  const Traces map =
    read_traces(folder.write("map.csv", "layer,to x [mm],to_y [mm],from_x [mm],From y (mm)\nBedding,3,4,1,2\n"));
  ASSERT_EQ(map.shapes.size(), 1u);
  const auto& trace = std::get<ClosedFlaw>(map.shapes[0]);
  EXPECT_EQ(trace.map_layer, "bedding");
  EXPECT_DOUBLE_EQ(trace.points[0][0], 1e-3);
  EXPECT_DOUBLE_EQ(trace.points[0][1], 2e-3);
  EXPECT_DOUBLE_EQ(trace.points[1][0], 3e-3);
  EXPECT_DOUBLE_EQ(trace.points[1][1], 4e-3);
  refuse([&] { read_traces(folder.write("m.csv", "from_x,from_y,to_x,to_y\n0,0,1,1\n")); }, "\"from_x\": has no unit");
}
} // namespace
} // namespace feldspar
